"""The words that screens draw with, by the names of their colors, and the size that screens are laid out for.

| words | their entries |
|---|---|
| 0, the background, and those of the surfaces | the scene's |
| `SCREENS`, the sixteen highest | constant: the colors below |

| screen | words | borrowed entries |
|---|---|---|
| picture, lights, reflectance, mapping, scalar | all, `SCREENS` over the picture | none |
| light and view | `SCREENS`; all in its small picture | none |
| color mixing | `SCREENS`; the chosen surface's, in a small picture and a bar | ramps and swatches |
| light blending | all, and the chosen surface's again in a bar, and `SCREENS` | none |
| kept | `SCREENS` | small pictures, in the words of all surfaces |
| entries | all, each in its cell | none |
| file, help | `SCREENS` | none |

A screen borrows words by `Screen.loads` alone. Color mixing borrows those of surfaces that it does not show;
where these are too few, it borrows some of the chosen surface's, too, spread over its levels, each of which
is then shown by its neighbor. `mixing_palette` tells which ones.

A page tells its base and all 1024 entries, and a sheet loads the entries that differ from those of the page
before, and writes the words of another base whole: so whatever a screen borrows or covers is restored by the
page that follows, and none has to clean up.
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
