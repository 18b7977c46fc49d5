"""Light a scanned object: the up axis and the creases first, then the lights.

`python -m examples.light_a_scan [FOLDER [SCAN]]` writes scan.png into a folder: four panels of a scan in any
mesh format, or of a carved head that the project makes.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image

import autocolor
from autocolor import Flap, Light
from scenes.modeling import head

SIZE = (320, 240)


def main(folder: Path = Path(), scan: Path | None = None) -> None:
    """Write the four panels."""
    with TemporaryDirectory() as made:
        if scan is None:
            head.main(scan := Path(made, "head.obj"))
        # A. A mesh alone is enough: surface, view and lights are created. But y is up in this file.
        lying = autocolor.read_scene(scan)
        # B. With its own up axis it stands.
        upright = autocolor.read_scene(scan, up="y")

    # C. Noise tilts the polygons. Two of them keep a sharp edge where they meet at more than the crease
    # angle, 40 degrees; at 180, no edge is sharp. A dull surface does not repeat the noise in highlights.
    smooth = upright.replace(mesh=replace(upright.mesh, crease_angle=180))
    for surface in smooth.surfaces:
        smooth = smooth.with_surface(surface.name, object_color="#cdb594", specular=0.2, exponent=6)

    # D. Two lights, placed as the eye sees the object: the key light at the upper left, the rim light at the
    # right, behind it. A flap with a soft edge keeps the rim light off the lower third.
    low, high = smooth.mesh.bounds
    center, size = (low + high) / 2, (high - low).max()
    right, down, ahead = smooth.view.axes
    key, rim = -1.5 * right - 1.2 * down - 1.3 * ahead, 2.0 * right - 0.6 * down + 0.7 * ahead
    lights = [
        Light(name, tuple(center + size * place), intensity, aim=tuple(center), concentration=10)
        for name, place, intensity in (("key", key, 1.0), ("rim", rim, 1.3))
    ]
    flap = Flap(minimum=low[2] + (high - low)[2] / 3, edge_width=0.05 * size)
    lit = smooth.replace(lights=lights, ambient=0.03).with_light("rim", flaps={"z": flap})

    a, b, c, d = (autocolor.image(scene, size=SIZE) for scene in (lying, upright, smooth, lit))
    Image.fromarray(np.vstack([np.hstack([a, b]), np.hstack([c, d])])).save(folder / "scan.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
