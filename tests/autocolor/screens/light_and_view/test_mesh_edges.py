from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.screens.light_and_view import mesh_edges as module
from autocolor.screens.light_and_view.mesh_edges import MeshEdges, mesh_edges
from tests.autocolor.meshes import CUBE_NODES, CUBE_QUADS, cube, grid, sphere
from tests.autocolor.strategies import meshes

Place = tuple[float, ...]


def lines(edges: MeshEdges) -> set[frozenset[Place]]:
    """The features by the places of their ends."""
    return {frozenset(map(tuple, pair)) for pair in edges.coordinates[edges.features].tolist()}


def repeating_its_nodes(mesh: Mesh) -> Mesh:
    """The mesh with nodes of its own for each polygon, as in a file without sharing."""
    numbers = np.arange(mesh.node_numbers.size).reshape(-1, 4)
    coordinates = mesh.coordinates[mesh.node_numbers.ravel()]
    return Mesh(coordinates, numbers, mesh.part_numbers, mesh.part_names)


def folded(degrees: float) -> Mesh:
    """Two squares that meet along the y axis at an angle; 0 is flat."""
    turn = np.radians(degrees)
    coordinates = [(-1, 0, 0), (0, 0, 0), (0, 1, 0), (-1, 1, 0)]
    bent = [(np.cos(turn), 0, np.sin(turn)), (np.cos(turn), 1, np.sin(turn))]
    return Mesh(np.array([*coordinates, *bent]), np.array([(0, 1, 2, 3), (1, 4, 5, 2)]))


def test_a_cube_has_twelve_creases() -> None:
    edges = mesh_edges(cube())
    assert len(edges.features) == 12
    assert len(edges.smooth) == 0
    assert {len({a != b for a, b in zip(*pair, strict=True)}) for pair in map(tuple, lines(edges))} == {2}
    assert all(sum(a != b for a, b in zip(*pair, strict=True)) == 1 for pair in map(tuple, lines(edges)))


def test_the_diagonals_of_divided_sides_are_no_creases() -> None:
    triangles = [three for a, b, c, d in CUBE_QUADS for three in ((a, b, c), (a, c, d))]
    edges = mesh_edges(Mesh(np.array(CUBE_NODES), np.array(triangles)))
    assert lines(edges) == lines(mesh_edges(cube()))
    assert len(edges.smooth) == 6


def test_a_sphere_has_no_feature() -> None:
    edges = mesh_edges(sphere(32, 16))
    assert len(edges.features) == 0
    assert len(edges.smooth) == sphere(32, 16).edge_count


def test_an_open_grid_has_its_border() -> None:
    edges = mesh_edges(grid(4, 3, (0, 0, 0), (4, 0, 0), (0, 3, 0)))
    assert len(edges.features) == 2 * (4 + 3)
    assert len(edges.smooth) == 3 * 3 + 4 * 2
    for pair in lines(edges):
        (ax, ay, _), (bx, by, _) = pair
        assert (ax == bx and ax in (0, 4)) or (ay == by and ay in (0, 3))


@pytest.mark.parametrize(("fold", "creases"), [(0, 0), (29.9, 0), (30, 0), (30.1, 1), (90, 1), (179, 1)])
def test_a_crease_is_an_angle_above_the_crease_angle(fold: float, creases: int) -> None:
    for sign in (1, -1):
        assert len(mesh_edges(folded(sign * fold), crease_angle=30).features) == 6 + creases


def test_a_cylinder_of_twelve_sides_has_two_rims_and_no_lines_along_it() -> None:
    turns = np.radians(np.arange(0, 360, 30))
    rim = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    coordinates = np.concatenate([rim, rim + np.array([0, 0, 1])])
    quads = [(k, (k + 1) % 12, 12 + (k + 1) % 12, 12 + k) for k in range(12)]
    edges = mesh_edges(Mesh(coordinates, np.array(quads)))
    assert (len(edges.features), len(edges.smooth)) == (24, 12)


def test_polygons_of_different_parts_are_divided_by_a_line_and_of_one_part_by_none() -> None:
    mesh = grid(2, 1, (0, 0, 0), (2, 0, 0), (0, 1, 0))
    two = Mesh(mesh.coordinates, mesh.node_numbers, np.array([0, 1]), ("left", "right"))
    assert len(mesh_edges(mesh).features) == 6
    assert lines(mesh_edges(two)) - lines(mesh_edges(mesh)) == {frozenset({(1, 0, 0), (1, 1, 0)})}


def test_a_part_can_be_left_out() -> None:
    left = grid(1, 1, (0, 0, 0), (1, 0, 0), (0, 1, 0), "left")
    stage = grid(3, 1, (9, 9, 0), (9, 0, 0), (0, 9, 0), "stage")
    both = Mesh.joined([left, stage])
    assert lines(mesh_edges(both, [0])) == lines(mesh_edges(left))
    assert lines(mesh_edges(both, [1])) == lines(mesh_edges(stage))
    assert len(mesh_edges(both, []).features) == 0


@given(st.integers(0, 1 << 32))
def test_the_way_the_polygons_run_does_not_matter(seed: int) -> None:
    mesh = sphere(24, 12)
    turned = np.random.default_rng(seed).integers(0, 2, len(mesh.node_numbers)).astype(bool)
    numbers = mesh.node_numbers.copy()
    numbers[turned] = numbers[turned][:, [1, 0, 3, 2]]
    triangle = turned & (mesh.node_numbers[:, 2] == mesh.node_numbers[:, 3])
    numbers[triangle] = mesh.node_numbers[triangle][:, [1, 0, 2, 2]]
    edges = mesh_edges(Mesh(mesh.coordinates, numbers))
    assert len(edges.features) == 0
    one, other = edges.polygons
    assert edges.same_direction.tolist() == (turned[one] != turned[other]).tolist()


def test_a_sheet_whose_polygons_are_there_for_each_face_has_its_border_alone() -> None:
    sheet = grid(3, 2, (0, 0, 0), (3, 0, 0), (0, 2, 0))
    numbers = np.concatenate([sheet.node_numbers, sheet.node_numbers[:, ::-1]])
    assert lines(mesh_edges(Mesh(sheet.coordinates, numbers))) == lines(mesh_edges(sheet))


def test_three_walls_that_meet_in_a_line_show_it() -> None:
    flat = folded(0)
    wall = [(0, 0, 1), (0, 1, 1)]
    numbers = [*flat.node_numbers.tolist(), [1, 2, 7, 6]]
    edges = mesh_edges(Mesh(np.concatenate([flat.coordinates, wall]), np.array(numbers)))
    assert frozenset({(0, 0, 0), (0, 1, 0)}) in lines(edges)


@given(meshes())
def test_nodes_at_one_place_count_as_one(mesh: Mesh) -> None:
    one, other = mesh_edges(mesh), mesh_edges(repeating_its_nodes(mesh))
    assert lines(one) == lines(other)
    assert len(one.smooth) == len(other.smooth)


@given(meshes())
def test_each_edge_of_polygons_with_an_area_is_a_feature_or_smooth(mesh: Mesh) -> None:
    edges = mesh_edges(mesh)
    has_area = (edges.normals != 0).any(axis=0)
    expected = set()
    for quad in mesh.node_numbers[has_area].tolist():
        corners = [tuple(place) for place in mesh.coordinates[quad].tolist()]
        expected |= {
            frozenset(pair) for pair in itertools.pairwise([*corners, corners[0]]) if len(set(pair)) == 2
        }
    smooth = {frozenset(map(tuple, pair)) for pair in mesh.coordinates[edges.smooth].tolist()}
    assert lines(edges) | smooth == expected
    assert len(edges.features) + len(edges.smooth) == len(expected)


def test_a_mesh_without_polygons_has_no_edges() -> None:
    edges = mesh_edges(Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.intp)))
    assert edges.features.shape == edges.smooth.shape == (0, 2)


def test_of_too_many_features_the_longest_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_FEATURES", 4)
    box = Mesh(cube().coordinates * (1, 2, 3), cube().node_numbers)
    edges = mesh_edges(box)
    assert np.abs(np.diff(box.coordinates[edges.features], axis=1)).reshape(4, 3).tolist() == [[0, 0, 3]] * 4
