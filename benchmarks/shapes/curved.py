"""Shapes with curved sides."""

from __future__ import annotations

import numpy as np

from autocolor import Mesh
from autocolor.arrays import Floats
from benchmarks.shapes.polygons import mesh_of, sheet, turned, whole_turn

BUMPS = (
    (0.55, 6.0, (0.4, -0.5, 0.8)), (0.45, 9.0, (-0.7, -0.4, 0.5)), (0.35, 12.0, (0.1, -1.0, -0.2)),
    (0.5, 5.0, (0.2, 0.9, 0.1)), (0.3, 16.0, (0.9, -0.2, -0.3)), (-0.25, 10.0, (-0.3, -0.7, 0.0)),
)  # fmt: skip
"""The bumps of the blob: height, sharpness, and the direction that they point to."""


def tube(sides: int = 48) -> Mesh:
    """A pipe with an inner wall."""
    radii, heights = np.array([[0.65], [0.8], [0.8], [0.65], [0.65]]), [0, 0, 1.5, 1.5, 0]
    return mesh_of("tube", turned(radii, heights, whole_turn(sides)))


def cylinder(sides: int = 48) -> Mesh:
    """A cylinder, both ends closed."""
    return mesh_of(
        "cylinder", turned(np.array([[0.0], [0.6], [0.6], [0]]), [0, 0, 1.5, 1.5], whole_turn(sides))
    )


def cone(sides: int = 64, rings: int = 8) -> Mesh:
    """A cone on its base."""
    up = np.arange(rings + 1) / rings
    radii = np.concatenate([[0.0], 1 - up])
    return mesh_of("cone", turned(radii[:, None], np.concatenate([[0.0], 1.8 * up]), whole_turn(sides)))


def sphere(sides: int = 96) -> Mesh:
    """A finely divided sphere."""
    low = np.linspace(-np.pi / 2, np.pi / 2, sides // 2 + 1)
    return mesh_of("sphere", turned(np.cos(low)[:, None], np.sin(low), whole_turn(sides)))


def torus(sides: int = 64, around: int = 32) -> Mesh:
    """A ring that lies on its side."""
    turn = whole_turn(around)
    return mesh_of("torus", turned(1 + 0.4 * np.cos(turn)[:, None], 0.4 * np.sin(turn), whole_turn(sides)))


def blob(sides: int = 120) -> Mesh:
    """A ball with bumps and a dent."""
    low, turn = np.linspace(-np.pi / 2, np.pi / 2, sides // 2 + 1)[:, None], whole_turn(sides)
    round_ = np.stack(
        [np.cos(low) * np.cos(turn), np.cos(low) * np.sin(turn), np.sin(low) + 0 * turn], axis=-1
    )
    radius = np.ones(round_.shape[:2])
    for height, sharpness, direction in BUMPS:
        toward = np.array(direction) / np.linalg.norm(direction)
        radius += height * np.exp(sharpness * (round_ @ toward - 1))
    return mesh_of("blob", sheet(round_ * radius[..., None]))


def saddle(side: int = 48) -> Mesh:
    """A sheet that goes up along one axis and down along the other."""
    x, y = _square(side)
    return mesh_of("saddle", sheet(np.stack([x, y, 0.45 * (x * x - y * y)], axis=-1)))


def waves(side: int = 96) -> Mesh:
    """A waved sheet."""
    x, y = _square(side)
    return mesh_of("waves", sheet(np.stack([x, y, 0.14 * np.sin(5 * x + 1) * np.cos(4 * y)], axis=-1)))


def _square(side: int) -> tuple[Floats, Floats]:
    """The x and y of a square of side x side quads around the origin."""
    along = np.linspace(-1, 1, side + 1)
    x, y = np.meshgrid(along, along)
    return x, y
