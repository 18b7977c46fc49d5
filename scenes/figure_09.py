"""Figure 9: light flaps. A light along the side of the coupe, and the same between two Z flaps."""

from __future__ import annotations

from typing import Any

import autocolor
from scenes.figures import Sheet, open_studio, read_scene

CREASE = 0.555
"""The height in meters of the line that runs along the side."""

ROOF = 1.0


def main() -> None:
    """Render once; each panel moves flaps of the one light."""
    coupe = read_scene("coupe")
    side = autocolor.Light("flapped", (-4.0, -6.0, 2.0), aim=(0.0, 0.0, 0.6), concentration=4)
    view = coupe.view.replace(eye=(-4.9, -8.9, 1.8), target=(0.0, 0.0, 0.52))
    # The floor keeps what only the ambient light reaches from going black.
    shown: dict[str, Any] = {"ambient": 0.12, "scaling": "object", "mapping": "gamma", "contrast": "floor"}
    shown["exposure"] = {"stage": (0.12, 0.7)}
    studio = open_studio(coupe.replace(lights=(side,), view=view, stage="floor", **shown))
    sheet = Sheet("09")
    sheet.add(studio, "A. No Flaps", "a")
    studio.light("flapped", flaps={"z": {"minimum": CREASE}})
    sheet.add(studio, "B. Minimum Z Flap at the Crease", "b")
    studio.light("flapped", flaps={"z": {"minimum": CREASE, "maximum": ROOF}})
    sheet.add(studio, "C. Minimum and Maximum Z Flap", "c")
    sheet.write(across=3)


if __name__ == "__main__":
    main()
