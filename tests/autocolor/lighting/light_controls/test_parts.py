from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Scene, render
from autocolor.lighting.light_controls.control import controls_of
from autocolor.lighting.light_controls.parts import LinkedParts
from autocolor.scene.lights.links import Links
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.strategies import lights, scenes, some_of

PARTS = ["part 0", "part 1"]


def test_only_a_light_that_is_linked_to_parts_has_the_control() -> None:
    points = wall_points()
    for links in (Links(), Links(only_surfaces=("wall",)), Links(except_surfaces=("wall",))):
        assert controls_of(Light("light", (0, -1, 0), links=links), points) == ()
    assert "numbers" not in vars(points.parts), "part numbers that nobody needs were worked out"
    for links, lit in (
        (Links(only_parts=("wall",)), True),
        (Links(only_parts=()), False),
        (Links(except_parts=("wall",)), False),
        (Links(except_parts=()), True),
    ):
        (control,) = controls_of(Light("light", (0, -1, 0), links=links), points)
        assert isinstance(control, LinkedParts)
        for chunk in points.chunks:
            rows = points.rows[:, chunk.pixels]
            assert set(control.lit_points(rows, chunk.pixels).tolist()) == {lit}


@given(scenes(), lights(), some_of(PARTS), st.booleans())
def test_a_light_linked_to_parts_is_the_light_of_all_where_they_are_and_nothing_elsewhere(
    scene: Scene, light: Light, names: tuple[str, ...], is_only: bool
) -> None:
    links = Links(only_parts=names) if is_only else Links(except_parts=names)
    dark = scene.replace(ambient=0.0)
    free = render(dark.replace(lights=(light,)), 12, 16)
    linked = render(dark.replace(lights=(light.replace(links=links),)), 12, 16)
    numbers = [number for number, name in enumerate(PARTS, 1) if (name in names) == is_only]
    is_lit = np.isin(free.part_number, numbers)
    assert not linked.intensity[~is_lit].any()
    assert linked.intensity[is_lit] == pytest.approx(free.intensity[is_lit], rel=1e-5, abs=1e-30)


def test_the_parts_may_be_asked_of_any_slice_and_the_answer_be_written_to() -> None:
    points = wall_points()
    (control,) = controls_of(Light("light", (0, -1, 0), links=Links(only_parts=("wall",))), points)
    lit = control.lit_points(points.rows[:, 3:9], slice(3, 9))
    assert lit is not None
    lit[:] = False
    again = control.lit_points(points.rows[:, 3:9], slice(3, 9))
    assert again is not None
    assert again.all()
    assert again.shape == (6,)


@given(scenes())
def test_a_light_sees_the_same_parts_as_the_mesh_has(scene: Scene) -> None:
    points = visible_surfaces(scene.mesh, scene.view, scene.surface_number_of_part, 9, 12)
    assert points.parts.names == scene.mesh.part_names
    assert (points.parts.numbers - 1 == scene.mesh.part_numbers[points.polygon_numbers]).all()
