"""Flaps along any planes, and soft edges: a slanted half-space on the coupe, a soft cone, and barn doors.

Paper: "Light Flaps and Cones" names flaps that are not parallel to the axes as an addition.
"""

from __future__ import annotations

from typing import Any, Final

import autocolor
from scenes.figures import Sheet, open_studio, read_scene

SHOWN: Final[dict[str, Any]] = {"scaling": "object", "mapping": "gamma", "contrast": "floor"}
"""The floor keeps what only the ambient light reaches from going black."""

SLANT: Final = autocolor.HalfSpace.through("slant", (-0.5, -0.9, 0.2), (1.0, -0.9, 1.1), (1.0, 0.9, 1.1))
"""Across the car, from the sill behind the front wheel up to the end of the roof; the front is lit."""

SOFT: Final = 0.6
"""The width of its soft edge in meters."""

DOORS: Final = (
    autocolor.HalfSpace("left", (-0.8, 0.0, 0.0), (1.0, 0.0, 0.0), carried=True),
    autocolor.HalfSpace("right", (0.8, 0.0, 0.0), (-1.0, 0.0, 0.0), carried=True),
    autocolor.HalfSpace("top", (0.0, 0.0, 0.5), (0.0, 0.0, -1.0), carried=True),
    autocolor.HalfSpace("bottom", (0.0, 0.0, -0.5), (0.0, 0.0, 1.0), carried=True),
)
"""Four doors before a light leave a beam with the section of a rectangle, which turns with it."""


def main() -> None:
    """Render each scene once; each panel changes the edges of the one light."""
    sheet = Sheet("half-spaces")
    coupe = read_scene("coupe")
    side = autocolor.Light("side", (-4.0, -6.0, 4.0), aim=(0.0, 0.0, 0.6), concentration=4)
    view = coupe.view.replace(eye=(-4.9, -8.9, 1.8), target=(0.0, 0.0, 0.52))
    coupe = coupe.replace(lights=(side,), view=view, ambient=0.12, exposure={"stage": (0.12, 0.9)}, **SHOWN)
    studio = open_studio(coupe.replace(stage="floor"))
    studio.light("side", half_spaces={"slant": SLANT})
    sheet.add(studio, "A. A Slanted Half-Space, Sharp", "a")
    studio.light("side", half_spaces={"slant": {"edge_width": SOFT}})
    sheet.add(studio, "B. The Same, Soft over 0.6 m", "b")

    pyramid = read_scene("pyramid")
    lamp = autocolor.Light("lamp", (3.0, -5.0, 4.0), aim=(0.3, -0.3, 0.4), cone_angle=15)
    view = pyramid.view.replace(target=(0.3, -0.5, 0.5), field_of_view=24.0)
    studio = open_studio(pyramid.replace(lights=(lamp,), view=view, ambient=0.2, **SHOWN))
    sheet.add(studio, "C. A Cone of 15 Degrees", "c")
    studio.light("lamp", inner_angle=4)
    sheet.add(studio, "D. Soft from 4 to 15 Degrees", "d")
    studio.light("lamp", cone_angle=None, inner_angle=None, half_spaces=DOORS)
    sheet.add(studio, "E. Barn Doors", "e")
    studio.light(
        "lamp", aim=(0.9, -1.3, 0.0), half_spaces={each.name: {"edge_width": 0.25} for each in DOORS}
    )
    sheet.add(studio, "F. They Turn with the Light; Soft", "f")
    sheet.write(across=3)


if __name__ == "__main__":
    main()
