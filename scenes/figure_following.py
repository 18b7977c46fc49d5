"""Lights that follow the eye, a light at infinity, and one that falls with the distance.

Paper: Figure 7 has one light at the eye; here it stays there in another view. Departs: the other two rows of
panels show what the paper's lights do not do.
"""

from __future__ import annotations

from typing import Any

import autocolor
from scenes.figure_07 import SHOWN
from scenes.figures import Sheet, open_scene, open_studio, read_scene

OTHER_VIEW: dict[str, Any] = {"eye": (-2.9, -9.2, 3.4), "target": (-0.1, 0.0, 0.45)}

LAMP = (-3.4, -2.4, 1.6)
"""A place before the left head lamp, above the bumper."""

DOWN_TO = (2.2, -0.8, 0.0)
"""A point of the plane beside the pyramid, to which its lamp shines downward."""


def main() -> None:
    """Two scenes; each panel changes the view or one light."""
    sheet = Sheet("following")

    studio = open_scene("coupe")
    lamp = autocolor.Light("lamp", (0, 0, 0), follows="eye")
    studio.edit(studio.scene.replace(lights=(lamp,), **SHOWN))
    sheet.add(studio, "A. Light Fixed to the Eye", "a")
    studio.view(**OTHER_VIEW)
    sheet.add(studio, "B. The Same Light, Another View", "b")

    # Without the floor, the plane would be black in even light, as the darkest that there is.
    studio = open_studio(read_scene("pyramid").replace(ambient=0.2, contrast="floor"))
    studio.light("lamp", aim=DOWN_TO)
    sheet.add(studio, "C. Light beside the Pyramid", "c")
    studio.light("lamp", at_infinity=True)
    sheet.add(studio, "D. The Same Direction, at Infinity", "d")

    coupe = read_scene("coupe").replace(lights=(autocolor.Light("lamp", LAMP),), **SHOWN)
    studio = open_studio(coupe)
    studio.hold_exposure()
    sheet.add(studio, "E. Light beside the Coupe", "e")
    studio.light("lamp", falloff="quadratic", reach=8)
    sheet.add(studio, "F. Quadratic Falloff, Reach 8", "f")
    sheet.write(across=2)


if __name__ == "__main__":
    main()
