from __future__ import annotations

from hypothesis import given

from autocolor import Light, Mesh, Part, Scene, View, scene_of
from autocolor.screens.light_and_view.orthographic_views import SIDES, fitted_views
from autocolor.screens.light_and_view.shown_points import shown_points
from tests.autocolor.meshes import cube, grid
from tests.autocolor.strategies import scenes

VIEW = View((5.0, -6.0, 7.0), target=(0.5, 0.5, 0.25))


def test_the_object_the_eye_and_its_target_and_the_lights_and_their_aims_are_shown() -> None:
    lights = [
        Light("key", (1.0, 2.0, 3.0), aim=(0.0, 0.5, 0.5)),
        Light("back", (4.0, 5.0, 6.0), on=False, direction=(0.0, 0.0, -1.0)),
    ]
    found = shown_points(scene_of(cube(), view=VIEW, lights=lights))
    assert [tuple(point) for point in found.tolist()] == [
        (0, 0, 0), (1, 1, 1), VIEW.eye, VIEW.target, (1, 2, 3), (0, 0.5, 0.5), (4, 5, 6)
    ]  # fmt: skip


def test_a_stage_is_left_out_of_the_scale() -> None:
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    scene = scene_of(Mesh.joined([cube(), floor]), view=VIEW, lights=[])
    assert shown_points(scene).min() == -50
    parts = [Part(part.name, part.surface, stage=part.name == "floor") for part in scene.parts]
    assert shown_points(scene.replace(parts=tuple(parts))).min() == -6


@given(scenes())
def test_all_that_can_be_grabbed_is_in_each_of_the_fitted_views(scene: Scene) -> None:
    views = fitted_views(shown_points(scene))
    for side in SIDES:
        for light in scene.lights_in_world:
            assert side.area.has(*views.position(side, light.position))
        assert side.area.has(*views.position(side, scene.view.eye))


def test_lights_that_follow_are_shown_where_they_are() -> None:
    lights = [Light("lamp", (0.0, 0.0, 0.0), follows="eye"), Light("key", (1.0, 2.0, 3.0), aim=(0, 0.5, 0.5))]
    lights.append(Light("beside", (0.0, 0.0, 1.0), follows="key"))
    found = [tuple(point) for point in shown_points(scene_of(cube(), view=VIEW, lights=lights)).tolist()]
    assert found[4:] == [VIEW.eye, (1, 2, 3), (0, 0.5, 0.5), (0, 0.5, 1.5)]
