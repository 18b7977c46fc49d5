"""The curvature of the coupe's body, and how stripes are mirrored in it; the paper has no figure of either.

Paper: "Introduction": color coded scalar values such as curvature on the surface of an object.
"""

from __future__ import annotations

import math
from typing import Any, Final

from autocolor.scene.color_scales import COLOR_SCALES
from scenes.figures import Sheet, open_studio, read_scene

BANDS: Final = 41

COOLWARM: Final = COLOR_SCALES["coolwarm"]

COLORS: Final = tuple(
    COOLWARM[round((len(COOLWARM) - 1) * (1 + math.copysign(math.sqrt(abs(share)), share)) / 2)]
    for share in (2 * band / (BANDS - 1) - 1 for band in range(BANDS))
)
"""The colors of the bands. They follow the root of the curvature: panels differ, and so do fillets."""

MEAN: Final[dict[str, Any]] = {
    "name": "mean curvature",
    "surfaces": ("body",),
    "limits": (-10.0, 10.0),
    "scale": COLORS,
    "bands": BANDS,
    "shades": 10,
}
"""In 1/m: what is flat is gray, what bulges red and what is hollow blue."""

BRIGHTEST: Final = 0.9
"""The end of the body's range: the shades of a color end with that color, without a highlight."""

ZEBRA: Final[dict[str, Any]] = {
    "name": "zebra",
    "limits": None,
    "scale": "zebra",
    "bands": 2,
    "shades": 1,
    "stripes": 16,
    "direction": (1.0, 0.0, 0.0),
    "legend": False,
}
"""Lamps along the car, whose reflections run from the nose to the tail: black and white, without shading."""


def main() -> None:
    """Render once; each panel colors the body by another scalar of what is seen."""
    coupe = read_scene("coupe")
    view = coupe.view.replace(eye=(-5.6, -5.6, 2.9), target=(0.0, 0.0, 0.46), field_of_view=28.0)
    # Along scan lines, the stripes would bend at the edges of the quads.
    studio = open_studio(coupe.replace(view=view, interpolation="invariant"))
    sheet = Sheet("curvature")
    sheet.add(studio, "A. The Coupe", "a")
    studio.hold_exposure()
    held = studio.scene.exposure
    assert not isinstance(held, str)
    studio.edit(studio.scene.replace(exposure={**dict(held), "body": (0.0, BRIGHTEST)}))
    studio.scalar(**MEAN)
    sheet.add(studio, "B. Mean Curvature in 1/m", "b")
    studio.edit(studio.scene.replace(stage="none"))
    studio.scalar(**ZEBRA)
    sheet.add(studio, "C. Zebra Stripes", "c")
    sheet.write(across=3)


if __name__ == "__main__":
    main()
