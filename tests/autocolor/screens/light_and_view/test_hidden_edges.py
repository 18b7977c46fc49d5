from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.screens.light_and_view.hidden_edges import depths_toward, visible_depths, without_hidden
from autocolor.screens.light_and_view.mesh_edges import MeshEdges, mesh_edges
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDES, TOP, Side
from autocolor.screens.light_and_view.silhouettes import silhouette_toward
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import cube, grid, sphere
from tests.autocolor.strategies import meshes


def shown(edges: MeshEdges, mesh: Mesh, side: Side) -> set[tuple[int, ...]]:
    depths = depths_toward(mesh, side)
    assert depths is not None
    return {
        tuple(sorted(pair)) for pair in without_hidden(edges.features, edges.coordinates, depths).tolist()
    }


@pytest.mark.parametrize("side", SIDES, ids=[side.name for side in SIDES])
def test_the_far_side_of_a_cube_is_hidden_within_a_ring_around_it(side: Side) -> None:
    # A smaller cube behind a wall of the same shape is hidden; the wall is not.
    toward = np.array(side.toward)
    box = cube()
    behind = Mesh((box.coordinates - 0.5) * 0.5 - 3 * toward, box.node_numbers, box.part_numbers, ("behind",))
    before = Mesh(box.coordinates - 0.5, box.node_numbers, box.part_numbers, ("before",))
    both = Mesh.joined([before, behind])
    edges = mesh_edges(both)
    found = shown(edges, both, side)
    assert all(max(pair) < 8 for pair in found)
    nearest = np.flatnonzero(before.coordinates @ toward > 0).tolist()
    assert {tuple(sorted(pair)) for pair in found if set(pair) <= set(nearest)} == {
        tuple(sorted(pair)) for pair in edges.features.tolist() if set(pair) <= set(nearest)
    }


def test_the_eye_sees_nine_edges_of_a_cube() -> None:
    view = View((4.0, 5.0, 6.0), target=(0.5, 0.5, 0.5))
    edges = mesh_edges(cube())
    depths = visible_depths(visible_surfaces(cube(), view, (1,), 240, 320))
    found = without_hidden(edges.features, edges.coordinates, depths)
    # The three that meet in the far corner are hidden.
    assert len(found) == 9
    assert (edges.coordinates[found] != 0).any(axis=2).all()


def test_an_edge_outside_of_the_picture_counts_as_visible() -> None:
    view = View((4.0, 5.0, 6.0), direction=(-1.0, -1.0, -1.0))
    edges = mesh_edges(cube())
    depths = visible_depths(visible_surfaces(cube(), view, (1,), 240, 320))
    far = np.array([(-900.0, 0, 0), (-900.0, 0, 1), (9, 9, 9), (9, 9, 10)])
    pairs = np.array([(0, 1), (2, 3)])
    assert without_hidden(pairs, far, depths).tolist() == pairs.tolist()
    assert len(without_hidden(edges.features, edges.coordinates, depths)) == 9


def test_the_silhouette_of_a_fine_sphere_is_not_hidden() -> None:
    mesh = sphere(200, 101)
    edges = mesh_edges(mesh)
    for side in SIDES:
        outline = silhouette_toward(edges, side.toward)
        depths = depths_toward(mesh, side)
        assert depths is not None
        assert len(without_hidden(outline, edges.coordinates, depths)) == len(outline)


def test_a_floor_is_a_line_when_it_is_seen_from_the_side() -> None:
    floor = grid(1, 1, (-1, -1, 0), (2, 0, 0), (0, 2, 0))
    assert len(shown(mesh_edges(floor), floor, FRONT)) == 4
    assert len(shown(mesh_edges(floor), floor, TOP)) == 4


def test_a_stage_hides_nothing() -> None:
    lid = grid(1, 1, (-5, -5, 4), (10, 0, 0), (0, 10, 0), "lid")
    mesh = Mesh.joined([cube(), lid])
    edges = mesh_edges(mesh, [0])
    for part_numbers, count in ((None, 0), ([0], 4)):
        depths = depths_toward(mesh, TOP, part_numbers)
        assert depths is not None
        # From straight above, the upper side covers all edges but its own.
        assert len(without_hidden(edges.features, edges.coordinates, depths)) == count


def test_there_are_no_depths_of_nothing() -> None:
    assert depths_toward(Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.intp)), TOP) is None
    assert depths_toward(cube(), TOP, []) is None


@given(meshes())
def test_what_is_not_hidden_is_some_of_the_edges_in_their_order(mesh: Mesh) -> None:
    edges = mesh_edges(mesh)
    for side in SIDES:
        depths = depths_toward(mesh, side)
        assert depths is not None
        rows = iter(edges.features.tolist())
        found = without_hidden(edges.features, edges.coordinates, depths)
        assert all(pair in rows for pair in found.tolist())
