from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh, Scene, View, scene_of
from autocolor.screens.light_and_view.areas import PICTURE_AREA, area_of_picture
from autocolor.screens.light_and_view.hidden_edges import visible_depths
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDES, TOP, fitted_views
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import cube, grid, sphere

AREA = area_of_picture(PICTURE_AREA)
EYE = View((4.0, -5.0, 3.0), target=(0.5, 0.5, 0.5))


def on_a_floor() -> Scene:
    """A cube on a stage."""
    floor = grid(2, 2, (-2.0, -2.0, -0.1), (5.0, 0, 0), (0, 5.0, 0), "floor")
    return scene_of(Mesh.joined([cube(), floor]), view=EYE).with_part("floor", stage=True)


def test_the_lines_of_a_cube_are_its_edges_in_each_view() -> None:
    scene = scene_of(cube(), view=EYE)
    views = fitted_views(scene.object_coordinates)
    lines = ObjectLines()
    for side in SIDES:
        strokes = lines.of_side(scene, views, side)
        # From the side, edges cover each other in pairs, and those toward the viewer are points.
        assert len(strokes.features) == 4
        assert len(strokes.silhouette) == len(strokes.stage) == 0


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


def test_lines_are_kept_until_the_views_the_mesh_or_a_stage_changes() -> None:
    scene = on_a_floor()
    lines, views = ObjectLines(), fitted_views(scene.object_coordinates)
    before = lines.of_side(scene, views, TOP)
    assert lines.of_side(scene.with_view(angle=5.0), views, TOP) is before
    assert lines.of_side(scene, views.zoomed(2.0), TOP) is not before
    without = lines.of_side(scene.with_part("floor", stage=False), views, TOP)
    assert len(without.stage) == 0


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


def test_the_eye_sees_all_edges_of_a_cube_or_those_that_are_not_hidden() -> None:
    scene = scene_of(cube(), view=EYE)
    lines = ObjectLines()
    assert len(lines.of_eye(scene, AREA).features) == 12
    visible = visible_depths(visible_surfaces(scene.mesh, EYE, (1,), 480, 640))
    assert len(lines.of_eye(scene, AREA, visible).features) == 9


def test_a_scene_without_polygons_has_no_lines() -> None:
    scene = scene_of(Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ()), view=EYE)
    lines, views = ObjectLines(), fitted_views(np.zeros((1, 3)))
    while lines.leave_out_hidden(scene):
        pass
    for side in SIDES:
        assert not any(map(len, lines.of_side(scene, views, side)))
    assert not any(map(len, lines.of_eye(scene, AREA)))
