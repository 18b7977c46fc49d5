"""S that grows with the angle of incidence; the paper says that it should, and has no figure of it.

Paper: "The Lighting Model". The lamp is at the eye, where nothing changes, and then low behind the coupe,
from where its light glances off hood, roof and floor; at last behind the pyramid, seen from near its plane.
"""

from __future__ import annotations

from typing import Any, Final

import autocolor
from scenes.figures import Sheet, open_studio, read_scene

LACQUER: Final = 1.5
"""The refractive index of clear lacquer, of glass, and nearly that of a wet floor."""

SURFACES: Final[dict[str, dict[str, Any]]] = {
    "body": {"specular": 0.15, "exponent": 40, "blend": 0.65},
    "glass": {"specular": 0.2},
    "stage": {"specular": 0.11, "exponent": 30, "light_color": "#d0d8e0"},
}
"""What is lacquered or wet. Of so small an S little is seen unless it grows."""

BEHIND: Final = (9.0, 7.0, 2.7)

CURVE: Final = ((0.0, 0.0), (0.25, 0.42), (0.5, 0.7), (1.0, 1.0))
"""Brighter in the middle: the highlights of lacquer are several times as bright as the paint."""

BRIGHTEST: Final = 1.05
"""The end of the range, as a multiple of the brightest intensity at the size of the display."""


def lit_coupe() -> autocolor.Scene:
    """The coupe in dimmed studio lights, with a lamp at the eye, exposed alike in all panels."""
    coupe = read_scene("coupe")
    dimmed = [coupe.lights[name].replace(intensity=0.6) for name in ("key", "side")]
    lamp = autocolor.Light("lamp", coupe.view.eye, 0.6, aim=(0.0, 0.0, 0.6), concentration=4)
    coupe = coupe.replace(lights=[*dimmed, lamp], scaling="object", mapping=CURVE)
    for name, changes in SURFACES.items():
        coupe = coupe.with_surface(name, **changes)
    brightest = lacquered(coupe.with_light("lamp", position=BEHIND))
    most = BRIGHTEST * autocolor.render(brightest).ranges.whole.maximum
    return coupe.replace(exposure={"object": (0.0, most)})


def lacquered(coupe: autocolor.Scene) -> autocolor.Scene:
    """The coupe with lacquer or water on its surfaces."""
    for name in SURFACES:
        coupe = coupe.with_surface(name, refractive_index=LACQUER)
    return coupe


def lit_pyramid() -> autocolor.Scene:
    """The pyramid from a low eye, with a lamp behind it and a dim one beside the eye, both panels alike."""
    pyramid = read_scene("pyramid")
    lamps = [autocolor.Light("lamp", (0.6, 5.0, 1.3)), autocolor.Light("dim", (9.0, -3.0, 3.0), 0.4)]
    pyramid = pyramid.replace(lights=lamps, view=pyramid.view.replace(eye=(3.6, -8.5, 2.4)))
    pyramid = pyramid.replace(scaling="object", exposure={"object": (0.0, 0.8)})
    return pyramid.with_surface("plane", diffuse=0.4, specular=0.06, blend=0.5)


def main() -> None:
    """Render once for each row of panels; in a row, the surfaces that change are computed again."""
    studio = open_studio(lit_coupe())
    sheet = Sheet("incidence")
    for where, position, panels in (("at the Eye", studio.scene.view.eye, "ab"), ("Behind", BEHIND, "cd")):
        studio.light("lamp", position=position)
        for panel, index, material in zip(panels, (None, LACQUER), ("Constant", "of Lacquer"), strict=True):
            for name in SURFACES:
                studio.surface(name, refractive_index=index)
            sheet.add(studio, f"{panel.upper()}. Lamp {where}, S {material}", panel)
    studio = open_studio(lit_pyramid())
    for panel, index, material in (("e", None, "Constant"), ("f", LACQUER, "of Lacquer")):
        studio.surface("plane", refractive_index=index)
        sheet.add(studio, f"{panel.upper()}. Lamp behind the Pyramid, S {material}", panel)
    sheet.write(across=2)


if __name__ == "__main__":
    main()
