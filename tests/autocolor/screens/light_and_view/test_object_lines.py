from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Mesh, Scene, View, scene_of
from autocolor.checks import Vector
from autocolor.screens.light_and_view import object_lines as module
from autocolor.screens.light_and_view.object_lines import (
    MeshEdges,
    ObjectLines,
    depths_toward,
    mesh_edges,
    perspective_strokes,
    silhouette_from,
    silhouette_toward,
    visible_depths,
    without_hidden,
)
from autocolor.screens.light_and_view.orthographic_views import (
    FRONT,
    PICTURE_AREA,
    SIDES,
    TOP,
    ViewSide,
    area_of_picture,
    fitted_views,
)
from autocolor.testing import directions, meshes, views
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.widgets.items import Area
from tests.small import CUBE_NODES, CUBE_QUADS, cube, grid, sphere, wall

AREA = area_of_picture(PICTURE_AREA)
EYE = View((4.0, -5.0, 3.0), target=(0.5, 0.5, 0.5))


def on_a_floor() -> Scene:
    """A cube on a stage."""
    floor = grid(2, 2, (-2.0, -2.0, -0.1), (5.0, 0, 0), (0, 5.0, 0), "floor")
    return scene_of(Mesh.joined([cube(), floor]), view=EYE).with_part("floor", stage=True)


def test_a_ball_is_drawn_as_its_outline() -> None:
    scene = scene_of(sphere(32, 16), view=EYE)
    views = fitted_views(scene.object_coordinates)
    strokes = ObjectLines().of_side(scene, views, FRONT)
    assert len(strokes.features) == 0
    ends = strokes.silhouette.reshape(-1, 2)
    assert np.hypot(*(ends - FRONT.area.middle).T) == pytest.approx(views.scale, abs=1.5)


def test_the_features_of_a_stage_are_apart() -> None:
    scene = on_a_floor()
    views = fitted_views(scene.object_coordinates).zoomed(0.1)
    strokes = ObjectLines().of_side(scene, views, TOP)
    # The border of two by two polygons, without the edges between them.
    assert len(strokes.stage) == 8
    assert len(strokes.features) == 4
    assert np.ptp(strokes.stage[:, 0]) > 4 * np.ptp(strokes.features[:, 0])


def test_what_is_hidden_is_left_out_one_view_at_a_time() -> None:
    # The ball within the cube is seen from no side.
    inner = sphere(16, 9)
    ball = Mesh(inner.coordinates * 0.2 + 0.5, inner.node_numbers, inner.part_numbers, ("ball",))
    scene = scene_of(Mesh.joined([ball, cube()]), view=EYE)
    views, lines = fitted_views(scene.object_coordinates), ObjectLines()
    assert all(len(lines.of_side(scene, views, side).silhouette) for side in SIDES)
    for number, side in enumerate(SIDES, start=1):
        assert lines.leave_out_hidden(scene)
        assert len(lines.of_side(scene, views, side).silhouette) == 0
        assert len(lines.of_side(scene, views, side).features) == 4
        left = [each for each in SIDES if len(lines.of_side(scene, views, each).silhouette)]
        assert len(left) == 3 - number
    assert not lines.leave_out_hidden(scene)


def test_the_lines_of_a_cube_are_its_edges_or_those_that_are_not_hidden() -> None:
    scene = scene_of(cube(), view=EYE)
    lines = ObjectLines()
    assert len(lines.of_eye(scene, AREA).features) == 12
    visible = visible_depths(visible_surfaces(scene.mesh, EYE, (1,), 480, 640))
    assert len(lines.of_eye(scene, AREA, visible).features) == 9
    # From the side, edges cover each other in pairs, and those toward the viewer are points.
    views = fitted_views(scene.object_coordinates)
    for side in SIDES:
        strokes = lines.of_side(scene, views, side)
        assert list(map(len, strokes)) == [0, 4, 0]


def test_a_scene_without_polygons_has_no_lines() -> None:
    scene = scene_of(Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ()), view=EYE)
    lines, views = ObjectLines(), fitted_views(np.zeros((1, 3)))
    while lines.leave_out_hidden(scene):
        pass
    for side in SIDES:
        assert not any(map(len, lines.of_side(scene, views, side)))
    assert not any(map(len, lines.of_eye(scene, AREA)))


def shown(edges: MeshEdges, mesh: Mesh, side: ViewSide) -> set[tuple[int, ...]]:
    depths = depths_toward(mesh, side)
    assert depths is not None
    return {
        tuple(sorted(pair)) for pair in without_hidden(edges.features, edges.coordinates, depths).tolist()
    }


@pytest.mark.parametrize("side", SIDES, ids=[side.name for side in SIDES])
def test_the_far_side_of_a_cube_is_hidden_within_a_ring_around_it(side: ViewSide) -> None:
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


def test_an_edge_outside_of_the_picture_counts_as_visible() -> None:
    view = View((4.0, 5.0, 6.0), direction=(-1.0, -1.0, -1.0))
    edges = mesh_edges(cube())
    depths = visible_depths(visible_surfaces(cube(), view, (1,), 240, 320))
    far = np.array([(-900.0, 0, 0), (-900.0, 0, 1), (9, 9, 9), (9, 9, 10)])
    pairs = np.array([(0, 1), (2, 3)])
    assert without_hidden(pairs, far, depths).tolist() == pairs.tolist()
    assert len(without_hidden(edges.features, edges.coordinates, depths)) == 9


def test_the_silhouette_of_a_fine_sphere_is_not_hidden() -> None:
    mesh = sphere(120, 61)
    edges = mesh_edges(mesh)
    for side in SIDES:
        outline = silhouette_toward(edges, side.toward)
        depths = depths_toward(mesh, side)
        assert depths is not None
        assert len(without_hidden(outline, edges.coordinates, depths)) == len(outline)


def test_a_stage_hides_nothing() -> None:
    lid = grid(1, 1, (-5, -5, 4), (10, 0, 0), (0, 10, 0), "lid")
    mesh = Mesh.joined([cube(), lid])
    edges = mesh_edges(mesh, [0])
    for part_numbers, count in ((None, 0), ([0], 4)):
        depths = depths_toward(mesh, TOP, part_numbers)
        assert depths is not None
        # From straight above, the upper side covers all edges but its own.
        assert len(without_hidden(edges.features, edges.coordinates, depths)) == count


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


def test_the_diagonals_of_divided_sides_are_no_creases() -> None:
    triangles = [three for a, b, c, d in CUBE_QUADS for three in ((a, b, c), (a, c, d))]
    edges = mesh_edges(Mesh(np.array(CUBE_NODES), np.array(triangles)))
    assert lines(edges) == lines(mesh_edges(cube()))
    assert (len(edges.features), len(edges.smooth)) == (12, 6)


@pytest.mark.parametrize(("fold", "creases"), [(0, 0), (29.9, 0), (30, 0), (30.1, 1), (90, 1), (179, 1)])
def test_a_crease_is_an_angle_above_the_crease_angle(fold: float, creases: int) -> None:
    for sign in (1, -1):
        assert len(mesh_edges(folded(sign * fold), crease_angle=30).features) == 6 + creases


def test_polygons_of_different_parts_are_divided_by_a_line_and_of_one_part_by_none() -> None:
    mesh = grid(2, 1, (0, 0, 0), (2, 0, 0), (0, 1, 0))
    two = Mesh(mesh.coordinates, mesh.node_numbers, np.array([0, 1]), ("left", "right"))
    assert len(mesh_edges(mesh).features) == 6
    assert lines(mesh_edges(two)) - lines(mesh_edges(mesh)) == {frozenset({(1, 0, 0), (1, 1, 0)})}


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


def test_of_too_many_features_the_longest_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_FEATURES", 4)
    box = Mesh(cube().coordinates * (1, 2, 3), cube().node_numbers)
    edges = mesh_edges(box)
    assert np.abs(np.diff(box.coordinates[edges.features], axis=1)).reshape(4, 3).tolist() == [[0, 0, 3]] * 4


def test_edges_are_where_the_renderer_has_their_pixels() -> None:
    view = View((4.0, 5.0, 6.0), target=(0.5, 0.5, 0.5), angle=20.0)
    edges = mesh_edges(cube())
    projected = projection(cube(), view, AREA.height, AREA.width)
    # The renderer has the centers of pixels at halves.
    places = np.stack([projected.x - 0.5 + AREA.left, projected.y - 0.5 + AREA.top], axis=1)
    found = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    assert found == pytest.approx(places[edges.features].reshape(-1, 4))


@pytest.mark.parametrize(("width", "half"), [(200, 50), (134, 50), (80, 30), (40, 15)])
def test_the_height_of_a_wide_area_is_the_field_of_view(width: int, half: float) -> None:
    view = View((0.0, -1.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=90.0)
    edges = mesh_edges(wall(half=0.98))
    found = perspective_strokes(edges.coordinates, edges.features, view, Area(0, 0, width - 1, 99))
    # At 45 degrees a unit is half the height of a picture of 4:3, unless the area is cropped.
    assert (found[:, 1::2].min(), found[:, 1::2].max()) == pytest.approx(
        (49.5 - 0.98 * half, 49.5 + 0.98 * half)
    )
    assert len(found) == 4


def test_what_is_behind_the_eye_is_left_out_and_what_passes_it_is_cut_off() -> None:
    view = View((0.0, 0.0, 0.0), direction=(0.0, 1.0, 0.0), field_of_view=90.0)
    points = np.array([(0.5, 1, 0), (0.5, -1, 0), (0, -1, 0), (0, -2, 0)], np.float64)
    middle = AREA.middle[0]
    found = perspective_strokes(points, np.array([(0, 1), (1, 0), (2, 3)]), view, AREA)
    one = [middle + AREA.height / 4, AREA.middle[1]]
    end = [AREA.right, AREA.middle[1]]
    assert found.tolist() == [[*one, *end], [*end, *one]]


@given(meshes(), views())
def test_all_strokes_are_within_the_area(mesh: Mesh, view: View) -> None:
    edges = mesh_edges(mesh)
    found = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    assert (found >= [AREA.left, AREA.top] * 2).all()
    assert (found <= [AREA.right, AREA.bottom] * 2).all()


def turned_at_random(mesh: Mesh, seed: int) -> Mesh:
    """The mesh with some of its quads running the other way."""
    numbers = mesh.node_numbers.copy()
    turned = np.random.default_rng(seed).integers(0, 2, len(numbers)).astype(bool)
    turned &= numbers[:, 2] != numbers[:, 3]
    numbers[turned] = numbers[turned][:, ::-1]
    return Mesh(mesh.coordinates, numbers)


@given(directions(), st.integers(0, 1 << 32))
def test_a_silhouette_is_closed_whichever_way_the_polygons_run(direction: Vector, seed: int) -> None:
    toward = np.array(direction) / np.linalg.norm(direction)
    edges = mesh_edges(turned_at_random(sphere(24, 13), seed))
    found = silhouette_toward(edges, toward.tolist())
    assert len(found) >= 3
    assert (np.bincount(found.ravel()) % 2 == 0).all()
    plain = silhouette_toward(mesh_edges(sphere(24, 13)), toward.tolist())
    if np.abs(toward @ edges.normals).min() > 1e-6:
        assert sorted(map(sorted, found.tolist())) == sorted(map(sorted, plain.tolist()))


@given(directions())
def test_a_distant_eye_sees_the_silhouette_of_its_direction(direction: Vector) -> None:
    toward = np.array(direction) / np.linalg.norm(direction)
    edges = mesh_edges(sphere(24, 13))
    assume(np.abs(toward @ edges.normals).min() > 1e-6)
    expected = silhouette_toward(edges, toward.tolist())
    assert silhouette_from(edges, (1e9 * toward).tolist()).tolist() == expected.tolist()
    # The horizon as seen from the distance 2 is at half of the radius, and from within there is none.
    ball = mesh_edges(sphere(48, 25))
    found = silhouette_from(ball, (2 * toward).tolist())
    assert ball.coordinates[found].reshape(-1, 3) @ toward == pytest.approx(0.5, abs=0.15)
    assert len(silhouette_from(ball, (0.2 * toward).tolist())) == 0
