"""Strategies of the tests alone; those of `autocolor.testing` are for everybody."""

from __future__ import annotations

import dataclasses

import numpy as np
from hypothesis import strategies as st

from autocolor import Mesh, Reflectance, Scene
from autocolor.testing import numbers


@st.composite
def soups(draw: st.DrawFn) -> Mesh:
    """Triangles of nowhere else used nodes, in general position: they pass through each other."""
    seed = draw(st.integers(0, 1 << 32))
    count = draw(st.integers(1, 10))
    coordinates = np.random.default_rng(seed).uniform(-1, 1, (3 * count, 3))
    return Mesh(coordinates, np.arange(3 * count).reshape(-1, 3), np.zeros(count, np.intp), ("soup",))


interpolations = st.sampled_from(["scan line", "invariant", "linear"])

rasters = st.tuples(st.integers(1, 24), st.integers(1, 24))

reflectances = st.builds(
    Reflectance, numbers(0, 2), numbers(0, 2), st.sampled_from([0.0, 1.0, 5.0, 20.0, 50.0])
)
"""Phong's, as in the paper."""


def of_mesh(scene: Scene, mesh: Mesh) -> Scene:
    """The scene with another mesh, colored by a scalar that any mesh has."""
    row = scene.scalar and dataclasses.replace(scene.scalar, name="z")
    return scene.replace(mesh=mesh, scalar=row)
