"""The words that screens draw with, by the names of their colors, and the size that screens are laid out for.

| words | used by |
|---|---|
| `SCREENS`, the sixteen highest | every screen: text, bars, lines; their entries never change |
| those of the surfaces | the picture, large or small, and bars of a surface's own colors |
| those of surfaces that are not shown | color mixing: ramps and swatches, whose entries it borrows |

A page tells all 1024 entries, and a sheet loads those that differ from the page before: so whatever a screen
borrows is restored by the page that follows.
"""

from __future__ import annotations

from typing import Final

from autocolor.mapping.level_ranges import SCREENS

WIDTH: Final = 640
HEIGHT: Final = 480
"""The size that the screens are laid out for, in elements and lines."""

BLACK: Final = SCREENS.first
WHITE: Final = SCREENS.first + 1
LIGHT_GRAY: Final = SCREENS.first + 2
GRAY: Final = SCREENS.first + 3
SLATE: Final = SCREENS.first + 4
NIGHT: Final = SCREENS.first + 5
YELLOW: Final = SCREENS.first + 6
ORANGE: Final = SCREENS.first + 7
RED: Final = SCREENS.first + 8
GREEN: Final = SCREENS.first + 9
BLUE: Final = SCREENS.first + 10
"""White is for text, light gray for what is dim, yellow for what is chosen, orange for warnings; red, green
and blue for axes and for components of colors."""
