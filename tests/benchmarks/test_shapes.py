from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh
from benchmarks.shapes import CURVED, FLAT, Shape, shapes

OPEN = ("saddle", "waves", "two scales")
"""Those with edges that only one polygon has."""


@pytest.fixture(scope="module")
def every() -> dict[str, Shape]:
    return shapes()


def directed_edges(mesh: Mesh) -> list[tuple[int, int]]:
    start, end = mesh.node_numbers, np.roll(mesh.node_numbers, -1, axis=1)
    return [(a, b) for a, b in zip(start.ravel().tolist(), end.ravel().tolist(), strict=True) if a != b]


def triangles(mesh: Mesh) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    corners = mesh.coordinates[mesh.node_numbers]
    return np.concatenate([corners[:, :3], corners[:, [0, 2, 3]]])


def volume(mesh: Mesh) -> float:
    return float(np.linalg.det(triangles(mesh)).sum() / 6)


def area(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(triangles(mesh), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def test_there_are_flat_and_curved_ones(every: dict[str, Shape]) -> None:
    assert len(every) == len(FLAT) + len(CURVED) >= 14
    assert {name for name, shape in every.items() if shape.is_curved} == set(CURVED)


def test_no_two_polygons_go_along_an_edge_in_the_same_direction(every: dict[str, Shape]) -> None:
    for name, shape in every.items():
        edges = directed_edges(shape.mesh)
        assert len(set(edges)) == len(edges), name
        if name not in OPEN:
            assert {(b, a) for a, b in edges} == set(edges), name


def test_every_closed_one_faces_outward(every: dict[str, Shape]) -> None:
    for name, shape in every.items():
        if name not in OPEN:
            assert volume(shape.mesh) > 0, name


@pytest.mark.parametrize(
    ("name", "volume_", "area_", "size"),
    [
        ("cube", 1, 6, (1, 1, 1)),
        ("bar", 0.16, 3.28, (4, 0.2, 0.2)),
        ("frame", 8 * 0.08**3 + 12 * 0.08**2 * 0.84, 24 * 0.08**2 + 48 * 0.08 * 0.84, (1, 1, 1)),
        ("bracket", (1.44 - 0.95**2) * 0.9, 2 * (1.44 - 0.95**2) + 4.8 * 0.9, (1.2, 0.9, 1.2)),
        ("open box", 0.7 - 0.64 * 0.88**2, 2 + 2.8 + 2.56 * 0.88 + 0.88**2 - 0.88**2, (1, 1, 0.7)),
        ("sphere", 4 / 3 * np.pi, 4 * np.pi, (2, 2, 2)),
        ("torus", 2 * np.pi**2 * 0.16, 4 * np.pi**2 * 0.4, (2.8, 2.8, 0.8)),
        ("tube", np.pi * (0.64 - 0.4225) * 1.5, 2 * np.pi * (1.45 * 1.5 + 0.2175), (1.6, 1.6, 1.5)),
        ("cone", np.pi * 1.8 / 3, np.pi * (1 + np.hypot(1, 1.8)), (2, 2, 1.8)),
        ("icosahedron", 17.4535601, 34.6410162, (3.2360680,) * 3),
    ],
)
def test_volume_area_and_bounds_are_those_of_the_formula(
    every: dict[str, Shape], name: str, volume_: float, area_: float, size: tuple[float, float, float]
) -> None:
    mesh = every[name].mesh
    low, high = mesh.bounds
    assert volume(mesh) == pytest.approx(volume_, rel=0.01)
    assert area(mesh) == pytest.approx(area_, rel=0.01)
    assert (high - low) == pytest.approx(np.array(size), rel=1e-6)


def test_a_box_keeps_its_edges_and_a_round_shape_has_none(every: dict[str, Shape]) -> None:
    assert len(every["cube"].mesh.normals.vectors) == 24
    ball = every["sphere"].mesh
    assert len(ball.normals.vectors) == len(ball.coordinates)
