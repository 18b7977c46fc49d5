from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.files.formats import MESH_FORMATS
from autocolor.files.meshes.up_axis import seems_to_lie
from tests.small import cube, sphere

PRIORS = sorted({each.prior_of_y for each in MESH_FORMATS if each.prior_of_y is not None})


replaced = dataclasses.replace


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Mesh:
    ranges = np.array([x, y, z])
    unit = cube()
    return replaced(unit, coordinates=ranges[:, 0] + unit.coordinates * np.ptp(ranges, axis=1))


def joined(*boxes: Mesh) -> Mesh:
    named = [replaced(each, part_names=(f"part {number}",)) for number, each in enumerate(boxes)]
    return Mesh.joined(named)


def bottle() -> Mesh:
    """A bottle with a neck, z up on the ground."""
    turn = 2 * math.pi * np.arange(16) / 16
    radii, heights = np.array([0.01, 0.3, 0.3, 0.1, 0.1]), np.array([0, 0, 0.7, 0.8, 1])
    ring = np.stack([np.cos(turn), np.sin(turn)])
    rings = [
        np.stack([r * ring[0], r * ring[1], h + 0 * turn], axis=1)
        for r, h in zip(radii, heights, strict=True)
    ]
    first = np.arange(64)
    right = first // 16 * 16 + (first + 1) % 16
    return Mesh(np.concatenate(rings), np.stack([first, right, right + 16, first + 16], axis=1))


def car() -> Mesh:
    """A body and a cabin on four wheels, along x."""
    wheels = [box((x, x + 0.6), (y, y + 0.2), (0, 0.6)) for x in (-1.6, 1.1) for y in (-0.85, 0.65)]
    return joined(box((-2, 2), (-0.8, 0.8), (0.3, 0.8)), box((-1.2, 1), (-0.7, 0.7), (0.8, 1.4)), *wheels)


def chair() -> Mesh:
    legs = [box((x, x + 0.05), (y, y + 0.05), (0, 0.5)) for x in (-0.25, 0.2) for y in (-0.25, 0.2)]
    return joined(
        box((-0.25, 0.25), (-0.25, 0.25), (0.5, 0.55)), box((-0.25, 0.25), (0.2, 0.25), (0.55, 1)), *legs
    )


def with_y_up(mesh: Mesh) -> Mesh:
    """The mesh as a modeler with y up writes it."""
    x, y, z = mesh.coordinates.T
    return replaced(mesh, coordinates=np.stack([x, z, -y], axis=1))


@pytest.mark.parametrize("standing", [bottle(), car(), chair()], ids=["bottle", "car", "chair"])
@pytest.mark.parametrize("prior", PRIORS)
def test_an_object_that_lies_is_noticed_and_one_that_stands_is_not(standing: Mesh, prior: float) -> None:
    lying = with_y_up(standing)
    assert seems_to_lie(lying, prior)
    assert not seems_to_lie(standing, prior)
    for factor, moved in ((1e-12, 0.0), (1e12, 0.0), (1.0, np.array([3.0, 5.0, 7.0]))):
        assert seems_to_lie(replaced(lying, coordinates=lying.coordinates * factor + moved), max(PRIORS))


@pytest.mark.parametrize("prior", PRIORS)
def test_an_object_without_clues_is_not_hinted(prior: float) -> None:
    for mesh in (sphere(), joined(cube(), cube(2.0)), Mesh(np.eye(3), np.array([[0, 1, 2]]))):
        assert not seems_to_lie(mesh, prior)
