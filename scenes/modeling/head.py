"""Write a stand-in for a scan, a carved head: `python -m scenes.modeling.head FILE.obj`.

A turntable scanner turns an object past a beam, and measures the radius at each angle and height. The file
is like those of scanners: the y axis is up, the unit is the millimeter, there are no parts, and the surface
has the noise of the measurement. The beam does not reach the crown: there is a hole.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np

from scenes.modeling.coupe.curves import Array

ANGLES: Final = 300
HEIGHTS: Final = 220
NOISE: Final = 0.4
"""The standard deviation of a measured radius, in millimeters."""


def measured_radius() -> tuple[Array, Array, Array]:
    """The angle in radians, the height, -1 to 1, and the radius in millimeters, (HEIGHTS, ANGLES) each."""
    angle, height = np.meshgrid(
        np.linspace(-np.pi, np.pi, ANGLES, endpoint=False), np.linspace(-1, 0.995, HEIGHTS)
    )

    def bump(size: float, at_angle: float, width: float, at_height: float, tallness: float) -> Array:
        """A rise or a hollow on both sides of the face."""
        aside, above = (np.abs(angle) - at_angle) / width, (height - at_height) / tallness
        return np.asarray(size * np.exp(-(aside**2) - above**2))

    radius = 88 * (1 - np.abs(height) ** 3.5) ** 0.4 * (1 - 0.16 * np.cos(2 * angle))
    radius += bump(-14, 0, 9, -0.8, 0.3)  # The jaw is narrower.
    radius += bump(26, 0, 0.17, -0.02, 0.2)  # The nose,
    radius += bump(12, 0.2, 0.55, 0.38, 0.08)  # the brows,
    radius += bump(16, 1.6, 0.13, 0.05, 0.25)  # the ears,
    radius += bump(11, 0, 0.3, -0.33, 0.05) + bump(11, 0, 0.3, -0.46, 0.05)  # both lips,
    radius += bump(17, 0, 0.45, -0.68, 0.12)  # the chin,
    radius -= bump(15, 0.42, 0.22, 0.2, 0.1)  # the eyes.
    neck = (56 - 14 * np.cos(angle)) * (height < -0.4)
    radius = np.maximum(radius, neck)
    return angle, height, radius + np.random.default_rng(1983).normal(0, NOISE, radius.shape)


def head_obj() -> str:
    """The OBJ text of the scan, whose face looks along +z."""
    angle, height, radius = measured_radius()
    nodes = np.stack([radius * np.sin(angle), 160 * (height + 1), radius * np.cos(angle)], axis=-1)
    here = np.arange(ANGLES * (HEIGHTS - 1)).reshape(-1, ANGLES)
    beside = np.roll(here, -1, axis=1)
    quads = np.stack([here, beside, beside + ANGLES, here + ANGLES], axis=-1).reshape(-1, 4)
    lines = ["# a scanned head"] + [f"v {x:.3f} {y:.3f} {z:.3f}" for x, y, z in nodes.reshape(-1, 3).tolist()]
    lines += [f"f {a} {b} {c} {d}" for a, b, c, d in (quads + 1).tolist()]
    return "\n".join(lines) + "\n"


def main(path: Path) -> None:
    """Write the scan to a file."""
    path.write_text(head_obj(), encoding="ascii", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("head.obj"))
