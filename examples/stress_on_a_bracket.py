"""Stress on a bracket: 15 bands of color with a legend, the reading at a point, and another color scale.

`python -m examples.stress_on_a_bracket [FOLDER]` writes stress.png and stress-viridis.png into a folder. The
stress is a scalar of the mesh file: a number at each node in MPa, which was computed for a load on the bore.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import autocolor
from ramtek_emu import Ramtek9300

BRACKET = Path(__file__).parents[1] / "scenes" / "bracket"
COLORS = ["#3d6fb4", "#4aa5c9", "#7cc9a2", "#cfe07a", "#f3cd58", "#ec8a3a", "#cc3526"]
"""From no stress to the limit. All are light, so that the shades of each color show the form of the part."""


def main(folder: Path = Path()) -> None:
    """Write both pictures, and print what the scalar is at the most stressed point in sight."""
    bracket = autocolor.read_scene(BRACKET)
    # The shades of a band end with the color of the band, so the light may reach the upper end of each range.
    bracket = bracket.replace(exposure={"cast": (0.4, 1.25), "machined": (0.3, 1.3), "floor": (0.0, 0.6)})
    bracket = bracket.with_scalar(
        name="stress", limits=(0, 150), scale=COLORS, bands=15, shades=20, above="#ff5fd2"
    )
    display = Ramtek9300()
    studio = autocolor.Studio(bracket, display)

    # The reading: `picture.scalar` is the stress at each pixel, and `explain` tells where the number is from.
    stress = studio.picture.scalar
    assert stress is not None
    line, element = np.unravel_index(np.nanargmax(stress), stress.shape)
    pixel = studio.explain(int(line), int(element))
    assert pixel.point is not None
    assert pixel.level is not None
    assert pixel.level.scalar is not None
    nodes = ", ".join(str(corner.node) for corner in pixel.point.corners)
    print(
        f"line {line}, element {element}: {pixel.level.scalar.value:.1f} MPa on the {pixel.point.part_name}"
    )
    print(f"  polygon {pixel.point.polygon}, nodes {nodes}; word {pixel.word}")

    # Another color scale: the words stay, and only entries of the lookup table are sent.
    words, before = display.frame_buffer.written, display.entries.copy()
    studio.scalar(scale="viridis")
    changed = np.any(display.entries != before, axis=1).sum()
    print(f"viridis: {changed} entries changed, {display.frame_buffer.written - words} words written")

    # Both pictures with smooth edges, from one rendering.
    picture = autocolor.render(bracket, smooth=2)
    autocolor.save_image(folder / "stress.png", bracket, picture, overwrite=True)
    autocolor.save_image(folder / "stress-viridis.png", studio.scene, picture, overwrite=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
