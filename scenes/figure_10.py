"""Figure 10: the light cone. A spotlight on the coupe, tapering off, and sharply cut at two cone angles."""

from __future__ import annotations

from typing import Any

import autocolor
from scenes.figures import Sheet, open_scene

PANELS = (
    ("a", None, "A. Concentration Only, C = 6"),
    ("b", 14.0, "B. Cone Angle A = 14"),
    ("c", 7.0, "C. Cone Angle A = 7"),
)


def main() -> None:
    """Render once; each panel changes the cone of the one light."""
    studio, display = open_scene("coupe")
    spot = autocolor.Light("spot", (-5.0, -4.0, 5.0), aim=(-0.9, -0.3, 0.8), concentration=6)
    shown: dict[str, Any] = {"ambient": 0.12, "scaling": "object", "mapping": "gamma", "contrast": "floor"}
    studio.edit(studio.scene.replace(lights=(spot,), **shown))
    sheet = Sheet("10")
    for panel, angle, caption in PANELS:
        studio.light("spot", cone_angle=angle)
        sheet.add(display.field(), caption, panel)
    sheet.write(across=3)


if __name__ == "__main__":
    main()
