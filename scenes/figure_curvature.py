"""The curvature of the coupe's body, and how stripes are mirrored in it; the paper has no figure of either.

Paper: "Introduction": color coded scalar values such as curvature on the surface of an object.
"""

from __future__ import annotations

from typing import Any, Final

from scenes.figures import Sheet, open_studio, read_scene

MEAN: Final[dict[str, Any]] = {
    "name": "mean curvature",
    "surfaces": ("body",),
    "limits": (-2.0, 2.0),
    "scale": "coolwarm",
    "bands": 15,
    "shades": 20,
}
"""In 1/m: what is flat is gray, what bulges red and what is hollow blue."""

EXPOSURE: Final = {"body": (0.0, 0.9), "glass": (0.0, 1.7), "floor": (0.0, 0.55)}
"""As in the scene, and brighter for the body: the shades of a color end with it, without a highlight."""

ZEBRA: Final[dict[str, Any]] = {"name": "zebra", "limits": None, "scale": "zebra", "bands": 2, "stripes": 24}


def main() -> None:
    """Render once; each panel colors the body by another scalar of what is seen."""
    coupe = read_scene("coupe")
    view = coupe.view.replace(eye=(-5.6, -5.6, 2.9), target=(0.0, 0.0, 0.46), field_of_view=28.0)
    studio, display = open_studio(coupe.replace(view=view))
    sheet = Sheet("curvature")
    sheet.add(display.field(), "A. The Coupe", "a")
    studio.edit(studio.scene.replace(exposure=EXPOSURE))
    studio.scalar(**MEAN)
    sheet.add(display.field(), "B. Mean Curvature in 1/m", "b")
    studio.scalar(**ZEBRA)
    sheet.add(display.field(), "C. Zebra Stripes", "c")
    sheet.write(across=3)


if __name__ == "__main__":
    main()
