"""The measures of the bracket in millimeters.

The base lies on z = 0 and is bolted down; the upright stands at its back, x = 0, and carries a bearing in its
boss, whose axis runs along x. The plane y = 0 is one of symmetry. A rib stiffens the upright.

Assumed: the paper shows no machined part; this is a common one, with what is hard to read in a drawing.
"""

from __future__ import annotations

from typing import Final

BASE: Final = 16.0
"""The thickness of the base; that of the upright follows."""
UPRIGHT: Final = 14.0
LENGTH: Final = 120.0
"""From the back to the front of the base, along x."""
HALF_WIDTH: Final = 45.0
CORNER: Final = 12.0
"""The radius of the front corners of the base."""
FILLET: Final = 12.0
"""The radius of the inner corner between base and upright."""

EDGE: Final = 2.5
"""The radius of the cast edges."""
CHAMFER: Final = 1.0
"""Of the machined edges."""

HOLE: Final = 5.5
"""The radius of the bolt holes; then that of their counterbores."""
COUNTERBORE: Final = 9.5

AXIS: Final = 92.0
"""The height of the bearing's axis."""
BORE: Final = 12.0
"""The radius of the bore, of the seat of the bearing, of the boss, of the round top of the upright."""
SEAT: Final = 17.0
BOSS: Final = 26.0
TOP: Final = 42.0
PROJECTION: Final = 18.0
"""How far the boss stands out in front of the upright, and behind it."""
PROJECTION_BACK: Final = 4.0
TAPER: Final = 34.0
"""The height from which the sides of the upright lean to its round top."""

RIB: Final = 6.0
"""Half the thickness of the rib."""
NOSE: Final = 108.0
"""Where the rib ends in front, and how high it is there above the base."""
NOSE_HEIGHT: Final = 4.0
RIB_AT_BOSS: Final = 10.0
"""How far the rib stands out of the upright where it meets the boss."""
ROOT: Final = 5.0
"""The radius of the fillets at the foot of rib and boss."""
CREST: Final = 2.5
"""The radius of the upper edges of the rib."""
