"""Figure 10: the light cone. A spotlight that tapers off or is cut sharply, and one object of several."""

from __future__ import annotations

from typing import Any

import autocolor
from scenes.figures import Sheet, open_scene

ON_THE_COUPE = (
    ("a", None, "A. Concentration Only, C = 6"),
    ("b", 14.0, "B. Cone Angle A = 14"),
    ("c", 7.0, "C. Cone Angle A = 7"),
)

BOWL = (0.0, 0.0, 0.5)
"""The middle of the object that the cone picks out."""

IN_A_ROW = (
    ("d", None, "D. A Row of Objects, No Cone"),
    ("e", 13.5, "E. Cone Angle A = 13.5"),
    ("f", 5.2, "F. Cone Angle A = 5.2"),
)


def main() -> None:
    """Render each scene once; each panel changes the cone of the one light."""
    sheet = Sheet("10")
    studio = open_scene("coupe")
    spot = autocolor.Light("spot", (-5.0, -4.0, 5.0), aim=(-0.9, -0.3, 0.8), concentration=6)
    shown: dict[str, Any] = {"ambient": 0.12, "scaling": "object", "mapping": "gamma", "contrast": "floor"}
    shown["exposure"] = {"stage": (0.12, 0.7)}
    studio.edit(studio.scene.replace(lights=(spot,), **shown))
    for panel, angle, caption in ON_THE_COUPE:
        studio.light("spot", cone_angle=angle)
        sheet.add(studio, caption, panel)
    studio = open_scene("row")
    studio.light("lamp", aim=BOWL)
    for panel, angle, caption in IN_A_ROW:
        studio.light("lamp", cone_angle=angle)
        sheet.add(studio, caption, panel)
    sheet.write(across=3)


if __name__ == "__main__":
    main()
