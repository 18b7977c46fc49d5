from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, View, render
from autocolor.lighting.light_controls.control import controls_of
from autocolor.lighting.light_controls.half_spaces import HalfSpaces, half_space_sides
from autocolor.scene.lights.following import light_frame
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.lighting.light_controls.lit_points import wall_points
from tests.autocolor.meshes import sphere, wall, wall_scene
from tests.autocolor.strategies import Vector, directions, numbers, vectors, views

VIEW = View((1.0, -4.0, 1.0), target=(0.0, 0.0, 0.0))


def lit_of(light: Light) -> list[bool]:
    points = wall_points()
    (control,) = controls_of(light, points)
    lit = control.lit_points(points.rows, slice(None))
    assert lit is not None
    return lit.tolist()  # type: ignore[no-any-return]


@given(vectors(), directions)
def test_a_point_is_lit_on_the_side_to_which_the_direction_leads(point: Vector, direction: Vector) -> None:
    lit = np.array(lit_of(Light("light", (0, -1, 0), half_spaces=(HalfSpace("left", point, direction),))))
    distance = (wall_points().world_points - point) @ direction / np.linalg.norm(direction)
    clear = np.abs(distance) > 1e-5
    assert lit[clear].tolist() == (distance[clear] > 0).tolist()


@given(directions, numbers(1e-30, 1e30))
def test_the_length_of_the_direction_does_not_matter(direction: Vector, length: float) -> None:
    x, y, z = direction
    longer = (x * length, y * length, z * length)
    sides = [
        half_space_sides(
            Light("light", (0, 0, 0), half_spaces=(HalfSpace("left", (0.1, 0.2, 0), each),)), wall_points()
        )["left"].row
        for each in (direction, longer)
    ]
    assert sides[1] == pytest.approx(sides[0], rel=1e-12, abs=1e-12)


@given(
    views(), st.sampled_from("xyz"), st.booleans(), numbers(-1, 1), vectors(), st.just(0.0) | numbers(0, 1)
)
def test_a_half_space_along_an_axis_is_a_flap_bit_for_bit(
    view: View, axis: str, is_minimum: bool, limit: float, point: Vector, edge_width: float
) -> None:
    number = "xyz".index(axis)
    flap = Flap(edge_width=edge_width)
    flap = flap.replace(minimum=limit) if is_minimum else flap.replace(maximum=limit)
    with_flap = Light("light", (0.2, -1, 0.1), flaps=Flaps(**{axis: flap}))
    x, y, z = (limit if row == number else other for row, other in enumerate(point))
    direction = [0.0, 0.0, 0.0]
    direction[number] = 3.0 if is_minimum else -3.0
    plane = HalfSpace("end", (x, y, z), direction, edge_width=edge_width)  # type: ignore[arg-type]
    half_space = Light("light", (0.2, -1, 0.1), half_spaces=(plane,))
    one, other = (
        render(wall_scene(sphere(12, 8), view=view, lights=[light]), 12, 16)
        for light in (with_flap, half_space)
    )
    assert one.intensity.tobytes() == other.intensity.tobytes()


@pytest.mark.parametrize("direction", [(0, -1, 0), (0, 1, 0)])
def test_a_wall_that_lies_on_the_plane_is_lit_and_at_a_soft_edge_it_is_dark(direction: Vector) -> None:
    view = View((1.0, -7.0, 2.0), target=(0.0, 0.0, 0.0))
    free = Light("light", (0.3, -2.0, 0.1))
    plane = HalfSpace("wall", (5.0, 0.0, 3.0), direction)
    sharp, soft, whole = (
        render(wall_scene(view=view, lights=[free.replace(half_spaces=planes)]), 30, 40).intensity
        for planes in ([plane], [plane.replace(edge_width=1e-3)], [])
    )
    assert sharp.tobytes() == whole.tobytes()
    assert soft.max() < 1e-5 * whole.max()


def test_of_several_half_spaces_the_common_part_is_lit() -> None:
    triangle = (
        HalfSpace("a", (-0.5, 0, 0), (1, 0, 0.5)),
        HalfSpace("b", (0.5, 0, 0), (-1, 0, 0.5)),
        HalfSpace("c", (0, 0, 0.6), (0, 0, -1)),
    )
    light = Light("light", (0, -1, 0))
    each = [np.array(lit_of(light.replace(half_spaces=(plane,)))) for plane in triangle]
    together = lit_of(light.replace(half_spaces=triangle))
    assert together == (each[0] & each[1] & each[2]).tolist()
    assert 0 < sum(together) < min(some.sum() for some in each)


def test_half_spaces_that_are_off_are_no_control() -> None:
    off = (HalfSpace("left", (0, 0, 0), (1, 0, 0), edge_width=0.2, on=False),)
    assert controls_of(Light("light", (0, -1, 0), half_spaces=off), wall_points()) == ()


@given(vectors(), directions, vectors(numbers(-0.5, 0.5)), directions)
def test_what_a_light_carries_is_in_its_own_frame(
    position: Vector, toward: Vector, point: Vector, direction: Vector
) -> None:
    light = Light("light", position, direction=toward)
    frame = light_frame(light)
    carried = light.replace(half_spaces=(HalfSpace("door", point, direction, carried=True),))
    placed = HalfSpace("door", frame.point_to_world(point), frame.direction_to_world(direction))
    points = wall_points()
    one, other = (
        half_space_sides(each, points)["door"].row for each in (carried, light.replace(half_spaces=(placed,)))
    )
    assert one == pytest.approx(other, abs=1e-6)


def test_barn_doors_turn_and_move_with_the_light() -> None:
    # Two doors to the left and the right of the light leave a strip of the wall.
    doors = (
        HalfSpace("left", (-0.1, 0, 0), (1, 0, 0), carried=True),
        HalfSpace("right", (0.1, 0, 0), (-1, 0, 0), carried=True),
    )
    points = visible_surfaces(wall(half=4.0), VIEW, (1,), 60, 60)
    world = points.world_points
    for across, aim in ((0.0, 0.0), (0.4, 0.4), (0.0, 0.7), (-0.5, 0.2)):
        light = Light("light", (across, -2.0, 0.0), aim=(aim, 0.0, 0.0), half_spaces=doors)
        (control,) = controls_of(light, points)
        assert isinstance(control, HalfSpaces)
        lit = control.lit_points(points.rows, slice(None))
        # To the right of the light's direction is (y, -x) of it.
        along = np.array([aim - across, 2.0]) / np.hypot(aim - across, 2.0)
        to_right = (world[:, 0] - across) * along[1] - (world[:, 1] + 2.0) * along[0]
        clear = np.abs(np.abs(to_right) - 0.1) > 1e-5
        assert lit[clear].tolist() == (np.abs(to_right[clear]) < 0.1).tolist()
        assert 0 < lit.sum() < len(lit) / 4


@given(vectors(numbers(-1e30, 1e30)), directions, numbers(1e-30, 1e30) | st.just(0.0))
def test_planes_however_far_and_edges_of_any_width_leave_finite_light(
    point: Vector, direction: Vector, edge_width: float
) -> None:
    assume(any(point))
    plane = HalfSpace("far", point, direction, edge_width=edge_width)
    light = Light("light", (0.2, -1, 0.1), direction=(0, 1, 0), concentration=2, half_spaces=(plane,))
    picture = render(wall_scene(lights=[light]), 12, 16)
    assert np.isfinite(picture.intensity).all()
    assert picture.intensity.min() >= 0
