"""Highlights where they are wanted: on the hood of the coupe, and beside and on the pyramid.

Each panel picks a pixel, and the light moves so that its highlight is there; a cross is drawn around it.
"""

from __future__ import annotations

from typing import Final

from scenes import figures
from scenes.figures import Field, Sheet, open_studio, read_scene

ON_THE_COUPE: Final = {
    "A. On the Front of the Hood": (240, 110),
    "B. Below the Windshield": (200, 255),
    "C. At the Edge of the Hood": (258, 245),
}
"""Lines and elements of the pixels."""

ON_THE_PYRAMID: Final = {
    "D. Left on the Plane": (330, 150),
    "E. Right on the Plane": (360, 520),
    "F. On the Side of the Pyramid": (205, 345),
}

CROSS: Final = (255, 230, 60)
SHADOW: Final = (20, 20, 20)
INNER, OUTER = 9, 18
"""Pixels from the middle at which the arms of the cross begin and end."""


def marked(field: Field, line: int, element: int) -> Field:
    """A field with a cross around a pixel, which leaves the pixel itself to be seen."""
    field = field.copy()
    for color, margin in ((SHADOW, 1), (CROSS, 0)):
        for step in range(INNER - margin, OUTER + margin):
            for down, right in ((step, 0), (-step, 0), (0, step), (0, -step)):
                top, left = line + down - margin, element + right - margin
                field[top : line + down + margin + 1, left : element + right + margin + 1] = color
    return field


def main() -> None:
    """Render once for each object; each panel places the highlight of the one light."""
    sheet = Sheet("highlight")
    # The light from behind, beside the three others.
    coupe = read_scene("coupe").with_light("back", name="lamp")
    pyramid = read_scene("pyramid").replace(ambient=0.2, contrast="floor")
    pyramid = pyramid.with_light("lamp", aim=(0.5, 0.0, 0.9), concentration=4)
    pyramid = pyramid.with_surface("pyramid", specular=0.8, exponent=40)
    for scene, places in ((coupe, ON_THE_COUPE), (pyramid, ON_THE_PYRAMID)):
        studio = open_studio(scene)
        for caption, (line, element) in places.items():
            studio.place_highlight("lamp", line * figures.SMOOTH, element * figures.SMOOTH)
            sheet.add(marked(sheet.panel_of(studio), line, element), caption, caption[0].lower())
    sheet.write(across=3)


if __name__ == "__main__":
    main()
