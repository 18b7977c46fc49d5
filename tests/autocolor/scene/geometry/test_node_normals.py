from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.arrays import Singles
from autocolor.scene.geometry.node_normals import node_normals, polygon_normals
from tests.autocolor.meshes import cube, grid, sphere
from tests.autocolor.strategies import meshes

EPSILON = float(np.finfo(np.float32).eps)
"""Normals are computed in float64 and rounded once."""


def corner_normals(mesh: Mesh) -> Singles:
    """The normal at each corner of each polygon, (polygons, 4, 3)."""
    return mesh.normals.vectors[mesh.normals.numbers]


def with_polygons(mesh: Mesh, quads: object, crease_angle: float = 40.0) -> Mesh:
    quads = np.array(quads)
    return Mesh(mesh.coordinates, quads, np.zeros(len(quads), np.intp), ("all",), crease_angle)


def test_a_box_keeps_its_edges_sharp() -> None:
    mesh = cube()
    flat = polygon_normals(mesh.coordinates.T[:, mesh.node_numbers.T]).T
    assert corner_normals(mesh) == pytest.approx(np.repeat(flat[:, None], 4, axis=1))
    outward = mesh.coordinates[mesh.node_numbers].mean(axis=1) - 0.5
    assert (outward * flat).sum(axis=1) == pytest.approx(np.full(6, 0.5))


def test_a_box_is_smooth_where_the_crease_angle_allows_it() -> None:
    mesh = with_polygons(cube(), cube().node_numbers, crease_angle=90.0)
    corners = mesh.coordinates[mesh.node_numbers] - 0.5
    assert corner_normals(mesh) == pytest.approx(corners / np.linalg.norm(corners, axis=2)[..., None])


def test_a_sphere_is_smooth() -> None:
    mesh = sphere(24, 12)
    assert len(mesh.normals.vectors) == len(mesh.coordinates)
    assert np.abs(corner_normals(mesh) - mesh.coordinates[mesh.node_numbers]).max() < 0.02


def test_a_wall_has_one_normal_all_over() -> None:
    mesh = grid(4, 3, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    assert corner_normals(mesh) == pytest.approx(np.broadcast_to((0, -1, 0), (12, 4, 3)))


@given(st.integers(0, 1 << 32))
def test_polygons_of_opposite_winding_are_as_smooth_each_with_its_own_sign(seed: int) -> None:
    turned = np.random.default_rng(seed).integers(0, 2, 24 * 12).astype(bool).tolist()
    whole = sphere(24, 12)
    quads = [
        (quad[1], quad[0], quad[2], quad[2]) if turn and quad[2] == quad[3]
        else quad[::-1] if turn else quad
        for quad, turn in zip(whole.node_numbers.tolist(), turned, strict=True)
    ]  # fmt: skip
    mixed = with_polygons(whole, quads)
    outward = mixed.coordinates[mixed.node_numbers]
    sign = np.where(turned, -1.0, 1.0)[:, None, None]
    assert np.abs(corner_normals(mixed) * sign - outward).max() < 0.02


@pytest.mark.parametrize(("fold", "smooth"), [(39.0, True), (40.0, True), (41.0, False), (120.0, False)])
def test_an_edge_is_sharp_beyond_the_crease_angle(fold: float, smooth: bool) -> None:
    turn = math.radians(fold)
    roof = Mesh(
        np.array(
            [
                (-1, 0, 0),
                (-1, 1, 0),
                (0, 0, 0),
                (0, 1, 0),
                (math.cos(turn), 0, -math.sin(turn)),
                (math.cos(turn), 1, -math.sin(turn)),
            ]
        ),
        np.array([(0, 2, 3, 1), (2, 4, 5, 3)]),
        np.zeros(2, np.intp),
        ("roof",),
    )
    at_ridge = corner_normals(roof)[0, 1]
    expected = np.array((math.sin(turn / 2), 0, math.cos(turn / 2))) if smooth else np.array((0, 0, 1))
    assert at_ridge == pytest.approx(expected, abs=EPSILON)


def test_normals_are_not_shared_across_parts() -> None:
    whole = sphere(24, 12)
    halves = Mesh(
        whole.coordinates, whole.node_numbers, np.arange(len(whole.node_numbers)) // 24 % 2, ("a", "b")
    )
    assert len(halves.normals.vectors) > len(whole.normals.vectors)


def test_nodes_at_the_same_place_count_as_one() -> None:
    whole = sphere(24, 12)
    nodes = whole.node_numbers
    torn = Mesh(
        whole.coordinates[nodes.ravel()], np.arange(nodes.size).reshape(-1, 4), whole.part_numbers, ("all",)
    )
    # The triangles of the poles have two nodes in one place here.
    assert corner_normals(torn)[24:-24] == pytest.approx(corner_normals(whole)[24:-24], abs=EPSILON)
    assert np.abs(corner_normals(torn)[:, :3] - corner_normals(whole)[:, :3]).max() <= EPSILON


def test_how_a_face_is_cut_to_polygons_does_not_turn_the_normals() -> None:
    quads = with_polygons(cube(), cube().node_numbers, crease_angle=180.0)
    triangles = with_polygons(
        cube(),
        [half for a, b, c, d in cube().node_numbers.tolist() for half in ((a, b, c, c), (a, c, d, d))],
        crease_angle=180.0,
    )
    assert corner_normals(triangles)[0, 0] == pytest.approx(corner_normals(quads)[0, 0])


def test_normals_that_cancel_leave_each_polygon_its_own() -> None:
    # Three panels around one edge, 120 degrees apart: their sum is nothing.
    panels = Mesh(
        np.array(
            [(0, 0, 0), (0, 0, 1)]
            + [
                (math.cos(turn), math.sin(turn), z)
                for turn in (0, 2 * math.pi / 3, 4 * math.pi / 3)
                for z in (0, 1)
            ]
        ),
        np.array([(0, 2, 3, 1), (0, 4, 5, 1), (0, 6, 7, 1)]),
        np.zeros(3, np.intp),
        ("panels",),
        crease_angle=180.0,
    )
    assert np.linalg.norm(panels.normals.vectors, axis=1) == pytest.approx(
        np.ones(len(panels.normals.vectors))
    )


@given(meshes(), st.sampled_from([1e-200, 1e-20, 1.0, 1e20]))
def test_every_normal_is_a_unit_vector_whatever_the_mesh(mesh: Mesh, size: float) -> None:
    normals = node_normals(mesh.coordinates * size, mesh.node_numbers, mesh.part_numbers, mesh.crease_angle)
    assert normals.numbers.shape == (len(mesh.node_numbers), 4)
    assert normals.numbers.max(initial=-1) < len(normals.vectors)
    assert np.linalg.norm(normals.vectors, axis=1) == pytest.approx(np.ones(len(normals.vectors)))


@given(meshes())
def test_a_flat_polygon_alone_has_its_own_normal(mesh: Mesh) -> None:
    alone = mesh.coordinates[mesh.node_numbers[:1]]
    own = polygon_normals(alone.transpose(2, 1, 0))[:, 0]
    normals = node_normals(mesh.coordinates, mesh.node_numbers[:1], mesh.part_numbers[:1])
    if own.any() and len({tuple(corner) for corner in alone[0].tolist()}) == 4:
        assert normals.vectors[normals.numbers[0]] == pytest.approx(np.tile(own, (4, 1)), abs=EPSILON)


def test_a_polygon_without_area_adds_nothing() -> None:
    mesh = grid(1, 1, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    sliver = with_polygons(mesh, [*mesh.node_numbers.tolist(), (0, 1, 1, 0), (2, 2, 2, 2)])
    assert corner_normals(sliver)[0] == pytest.approx(corner_normals(mesh)[0])
