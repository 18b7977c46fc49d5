"""Light links: a light on named surfaces or parts of the coupe only, and on all but those of the pyramid."""

from __future__ import annotations

from typing import Any

import autocolor
from scenes.figures import Sheet, open_studio, read_scene

SHOWN: Any = {"scaling": "object", "mapping": "gamma", "contrast": "floor"}

ON_THE_COUPE: Any = (
    ("a", {}, "A. One More Light on Everything"),
    ("b", {"only_surfaces": ["glass"]}, "B. On the Glass Only"),
    ("c", {"only_surfaces": None, "only_parts": ["door_left", "handles"]}, "C. On the Door Only"),
)

ON_THE_PYRAMID: Any = (
    ("d", {}, "D. A Lamp on Everything"),
    ("e", {"except_surfaces": ["plane"]}, "E. On All But the Plane"),
    ("f", {"except_surfaces": ["pyramid"]}, "F. On All But the Pyramid"),
)


def main() -> None:
    """Render each scene once; each panel links one light to something else."""
    sheet = Sheet("links")
    studio = open_studio(coupe())
    held(studio)
    for panel, links, caption in ON_THE_COUPE:
        studio.light("more", **links)
        sheet.add(studio, caption, panel)

    pyramid = read_scene("pyramid")
    sky = autocolor.Light("sky", (-4.0, -6.0, 8.0), aim=(0.0, 0.0, 0.0), intensity=0.35)
    studio = open_studio(pyramid.replace(lights=(*pyramid.lights, sky), **SHOWN))
    held(studio)
    for panel, links, caption in ON_THE_PYRAMID:
        studio.light("lamp", **links)
        sheet.add(studio, caption, panel)
    sheet.write(across=3)


def coupe() -> autocolor.Scene:
    """The coupe in dim light, and one more light before it."""
    scene = read_scene("coupe")
    more = autocolor.Light("more", (-5.0, -6.5, 5.0), aim=(0.0, -0.2, 0.8), intensity=0.8)
    dim = [light.replace(intensity=0.3 * light.intensity) for light in scene.lights]
    # Only highlights take the color of the light: the paint stays red where it is brighter.
    return scene.with_surface("body", blend=0.85).replace(lights=(*dim, more), exposure="auto", **SHOWN)


def held(studio: autocolor.Studio) -> None:
    """Hold the exposure of the light on everything, so that the panels differ by the links alone."""
    exposure = {"object": (studio.scene.ambient, studio.picture.ranges.whole.maximum)}
    studio.edit(studio.scene.replace(exposure=exposure))


if __name__ == "__main__":
    main()
