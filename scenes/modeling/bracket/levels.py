"""The levels of the solid: how many lie on one another in the plate, the rib and the boss.

Level 0 is the underside of the base and the back of the upright; `PLATE` is the side on which rib and boss
stand. The boss has levels behind the upright, too.
"""

from __future__ import annotations

from typing import Final

BACK: Final = -2
PLATE: Final = 6
RIB_LAYERS: Final = 8
SEAT_LAYERS: Final = 4
BOSS_LAYERS: Final = 11
LEVELS: Final = PLATE + BOSS_LAYERS - BACK + 1
