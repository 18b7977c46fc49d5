from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, InputError, Light, Scene, View, render
from autocolor.arrays import Floats, Singles
from autocolor.checks import Vector
from autocolor.lighting import controls
from autocolor.lighting.controls import (
    FARTHEST,
    Falloff,
    flap_sides,
    flaps_of,
    half_space_sides,
    is_inside,
    lit_points,
    side_of,
    sides_of,
    soft_cone_share,
)
from autocolor.lighting.light import is_within, shares_of
from autocolor.lighting.rays import camera_light, fast_rays
from autocolor.scene.following import light_frame
from autocolor.scene.lights import Links
from autocolor.testing import directions, lights, numbers, scenes, some_of, vectors, views
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.twins.light import edge_share
from tests.small import sphere, wall, wall_scene


def wall_points() -> VisiblePoints:
    return visible_surfaces(wall(), View((1, -4, 1), target=(0, 0, 0)), (1,), 12, 12)


def shares(light: Light, points: VisiblePoints) -> dict[str, list[Singles]]:
    """The shares of the controls by name; a flap has a share for each of its ends."""
    rays, _ = fast_rays(camera_light(light, points), points.rows, points.radius)
    found: dict[str, list[Singles]] = {}
    for name, share in shares_of(camera_light(light, points), rays):
        found.setdefault(name, []).append(share)
    return found


@given(lights())
def test_a_light_has_the_controls_that_its_fields_ask_for(light: Light) -> None:
    expected = {f"flap {axis}" for axis, flap in flaps_of(light).items() if flap is not None and flap.on}
    expected |= {f"half-space {half_space.name}" for half_space in light.half_spaces if half_space.on}
    expected |= {"concentration"} if light.concentration > 0 else set()
    expected |= {"cone"} if light.cone_angle is not None else set()
    expected |= {"falloff"} if light.falloff != "none" else set()
    assert shares(light, wall_points()).keys() == expected


@pytest.mark.parametrize(("least", "inside"), [(1e300, False), (-1e300, True), (1e36, False)])
def test_a_plane_may_be_farther_than_a_single_can_hold(least: float, inside: bool) -> None:
    points = wall_points()
    side = side_of(points, "far", (1.0, 0.0, 0.0), least, 0.0)
    assert abs(side.row[3]) == pytest.approx(FARTHEST)
    assert is_inside(side, points.rows[POINT]).tolist() == [inside] * len(points.pixels)


@given(lights(), st.lists(st.tuples(*[numbers(-1, 1)] * 3), min_size=1, max_size=20))
def test_a_point_is_inside_a_side_of_a_flap_up_to_its_coordinate(
    light: Light, world: list[tuple[float, float, float]]
) -> None:
    points = wall_points()
    rows = np.array([points.camera_point(point) for point in world], np.float32).T
    sides = flap_sides(light, points)
    for number, (axis, flap) in enumerate(flaps_of(light).items()):
        for end in ("minimum", "maximum"):
            assert ((axis, end) in sides) == (flap is not None and flap.on)
            if flap is None or not flap.on:
                continue
            inside = is_inside(sides[axis, end], rows)
            for point, value in zip(world, inside.tolist(), strict=True):
                beyond = point[number] - flap.minimum if end == "minimum" else flap.maximum - point[number]
                assert value == (beyond >= 0) or abs(beyond) < 1e-5


@given(numbers(-1, 1), numbers(0, 1), st.sampled_from("xz"))
def test_a_point_is_within_a_flap_up_to_both_its_ends(least: float, extent: float, axis: str) -> None:
    points = wall_points()
    flap = Flap(least, least + extent)
    lit = np.array(lit_of(Light("light", (0, -1, 0), flaps=Flaps(**{axis: flap}))))
    coordinate = points.world_points[:, "xyz".index(axis)]
    clear = np.minimum(np.abs(coordinate - flap.minimum), np.abs(coordinate - flap.maximum)) > 1e-5
    expected = (flap.minimum <= coordinate) & (coordinate <= flap.maximum)
    assert lit[clear].tolist() == expected[clear].tolist()


def test_flaps_that_are_off_or_without_limits_are_no_control() -> None:
    for flaps in (Flaps(x=Flap(0, 1, on=False)), Flaps(x=Flap(), y=Flap())):
        assert sides_of(Light("light", (0, -1, 0), flaps=flaps), wall_points()) == []


VIEW = View((1.0, -4.0, 1.0), target=(0.0, 0.0, 0.0))


def lit_of(light: Light, points: VisiblePoints | None = None) -> Any:
    """Whether each point is within the sharp sides of a light."""
    points = points or wall_points()
    lit = lit_points(light, tuple(sides_of(light, points)), points, points.rows, slice(None))
    assert lit is not None
    return lit.tolist()


@given(vectors(), directions())
def test_a_point_is_lit_on_the_side_to_which_the_direction_leads(point: Vector, direction: Vector) -> None:
    lit = np.array(lit_of(Light("light", (0, -1, 0), half_spaces=(HalfSpace("left", point, direction),))))
    distance = (wall_points().world_points - point) @ direction / np.linalg.norm(direction)
    clear = np.abs(distance) > 1e-5
    assert lit[clear].tolist() == (distance[clear] > 0).tolist()


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
        render(wall_scene(sphere(12, 8), view=view, lights=[light]), (16, 12))
        for light in (with_flap, half_space)
    )
    assert one.intensity.tobytes() == other.intensity.tobytes()


@pytest.mark.parametrize("direction", [(0, -1, 0), (0, 1, 0)])
def test_a_wall_that_lies_on_the_plane_is_lit_and_at_a_soft_edge_it_is_dark(direction: Vector) -> None:
    view = View((1.0, -7.0, 2.0), target=(0.0, 0.0, 0.0))
    free = Light("light", (0.3, -2.0, 0.1))
    plane = HalfSpace("wall", (5.0, 0.0, 3.0), direction)
    sharp, soft, whole = (
        render(wall_scene(view=view, lights=[free.replace(half_spaces=planes)]), (40, 30)).intensity
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
    assert sides_of(Light("light", (0, -1, 0), half_spaces=off), wall_points()) == []


@given(vectors(), directions(), vectors(numbers(-0.5, 0.5)), directions())
def test_a_carried_half_space_is_in_the_frame_of_its_light(
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
        lit = np.array(lit_of(light, points))
        # To the right of the light's direction is (y, -x) of it.
        along = np.array([aim - across, 2.0]) / np.hypot(aim - across, 2.0)
        to_right = (world[:, 0] - across) * along[1] - (world[:, 1] + 2.0) * along[0]
        clear = np.abs(np.abs(to_right) - 0.1) > 1e-5
        assert lit[clear].tolist() == (np.abs(to_right[clear]) < 0.1).tolist()
        assert 0 < lit.sum() < len(lit) / 4


@given(vectors(numbers(-1e30, 1e30)), directions(), numbers(1e-30, 1e30) | st.just(0.0))
def test_planes_however_far_and_edges_of_any_width_leave_finite_light(
    point: Vector, direction: Vector, edge_width: float
) -> None:
    assume(any(point))
    plane = HalfSpace("far", point, direction, edge_width=edge_width)
    light = Light("light", (0.2, -1, 0.1), direction=(0, 1, 0), concentration=2, half_spaces=(plane,))
    picture = render(wall_scene(lights=[light]), (16, 12))
    assert np.isfinite(picture.intensity).all()
    assert picture.intensity.min() >= 0


def left_at(light: Light, points: VisiblePoints) -> Any:
    """The share that all controls leave at the points."""
    return np.prod([share for found in shares(light, points).values() for share in found], axis=0)


def ratio(light: Light) -> tuple[Floats, VisiblePoints]:
    """What all controls leave of a light on a wall, and the points there."""
    scene = wall_scene(wall(half=2.0), view=VIEW, lights=[light])
    free = wall_scene(wall(half=2.0), view=VIEW, lights=[Light("light", light.position)])
    points = visible_surfaces(scene.mesh, VIEW, (1,), 60, 80)
    lit, whole = (render(each, (80, 60)).intensity.ravel()[points.pixels] for each in (scene, free))
    assert whole.min() > 0
    return lit.astype(np.float64) / whole, points


@given(vectors(numbers(-1, 1)), directions(), numbers(0.05, 2))
def test_a_soft_half_space_on_a_wall_is_the_closed_form(
    point: Vector, direction: Vector, width: float
) -> None:
    light = Light("light", (0.3, -2.0, 0.2), half_spaces=(HalfSpace("left", point, direction, width),))
    left, points = ratio(light)
    distance = (points.world_points - point) @ direction / np.linalg.norm(direction)
    assert left == pytest.approx([edge_share(each, width) for each in distance.tolist()], abs=1e-4)


@given(numbers(-1, 0.5), numbers(0.1, 1.5), numbers(0.05, 2), st.sampled_from("xz"))
def test_a_soft_flap_goes_from_nothing_at_its_ends_to_all_of_it_inside(
    least: float, extent: float, width: float, axis: str
) -> None:
    flap = Flap(least, least + extent, edge_width=width)
    left, points = ratio(Light("light", (0.3, -2.0, 0.2), flaps=Flaps(**{axis: flap})))
    coordinates = points.world_points[:, "xyz".index(axis)].tolist()
    expected = [
        edge_share(each - least, width) * edge_share(least + extent - each, width) for each in coordinates
    ]
    assert left == pytest.approx(expected, abs=1e-4)


@pytest.mark.thorough
def test_a_soft_edge_is_smooth_at_both_ends_and_grows_between_them() -> None:
    width, step = 0.5, 1e-3
    light = Light("light", (0, -1, 0), half_spaces=(HalfSpace("left", (0, 0, 0), (1, 0, 0), width),))
    at = np.arange(-0.2, 0.8, step)
    rows = np.array([wall_points().camera_point((x, 0.0, 0.0)) for x in at.tolist()], np.float32).T
    (side,) = sides_of(light, wall_points())
    left = controls.edge_share(side, rows)
    slope = np.diff(left.astype(np.float64)) / step
    assert left[0] == 0
    assert left[-1] == 1
    assert slope.min() > -1e-3
    # Its slope is largest in the middle, and changes by no more than its second derivative, 6 / width^2.
    assert slope.max() == pytest.approx(1.5 / width, rel=1e-3)
    assert at[np.argmax(slope)] == pytest.approx(width / 2, abs=0.02)
    assert np.abs(np.diff(slope)).max() <= 6 / width**2 * step + 2e-3
    for end in (0.0, width):
        assert abs(slope[np.argmin(np.abs(at - end))]) < 0.05


def test_the_shares_of_several_soft_edges_are_multiplied() -> None:
    planes = (
        HalfSpace("a", (-0.3, 0, 0), (1, 0, 0.4), 0.7),
        HalfSpace("b", (0.4, 0, 0), (-1, 0, 0.2), 0.9),
    )
    flaps = Flaps(z=Flap(-0.6, 0.7, edge_width=0.5))
    light, points = Light("light", (0, -1, 0)), wall_points()
    each: list[Light] = [light.replace(half_spaces=(plane,)) for plane in planes]
    expected = np.prod([left_at(one, points) for one in (*each, light.replace(flaps=flaps))], axis=0)
    assert left_at(light.replace(half_spaces=planes, flaps=flaps), points) == pytest.approx(expected)
    assert np.ptp(expected) > 0


@pytest.mark.parametrize(
    ("cosine", "cone_angle", "lit"),
    [
        (0.5, 60.0, True),
        (0.49999, 60.0, False),
        (-0.5, 121.0, True),
        (0.0, 90.0, True),
        (-1.0, 180.0, True),
        (1.0, 0.001, True),
    ],
)
def test_a_point_is_in_the_cone_up_to_its_rim(cosine: float, cone_angle: float, lit: bool) -> None:
    points = wall_points()
    rays, _ = fast_rays(camera_light(spot(30.0, None), points), points.rows, points.radius)
    for kind in (np.float32, np.float64):
        assert is_within(dataclasses.replace(rays, light=np.array([cosine], kind)), cone_angle) == [lit]


def cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


def spot(cone_angle: float, inner_angle: float | None, **given: float) -> Light:
    return Light(
        "light",
        (0.3, -2, 0.2),
        aim=(0.1, 0, 0),
        cone_angle=cone_angle,
        inner_angle=inner_angle,
        **given,  # type: ignore[arg-type]
    )


@given(numbers(4, 60), numbers(0, 1), st.sampled_from([0.0, 3.0]))
def test_a_soft_cone_on_a_wall_is_the_closed_form(
    cone_angle: float, fraction: float, concentration: float
) -> None:
    inner = fraction * (cone_angle - 2)
    light = spot(cone_angle, inner, concentration=concentration)
    scene = wall_scene(wall(half=2.0), view=VIEW, lights=[light])
    free = scene.with_light("light", cone_angle=None, inner_angle=None, concentration=0)
    points = visible_surfaces(scene.mesh, VIEW, (1,), 60, 80)
    lit, whole = (render(each, (80, 60)).intensity.ravel()[points.pixels] for each in (scene, free))
    rays = points.world_points - light.position
    assert light.axis is not None
    cosines = rays @ light.axis / np.linalg.norm(rays, axis=1)
    rim, width = cosine(cone_angle), cosine(inner) - cosine(cone_angle)
    # Each rounding of a cosine counts as many times as the edge is steep.
    rounding = 1e-4 + 1e-6 / width
    expected = [edge_share(each - rim, width) * each**concentration for each in cosines.tolist()]
    assert lit.astype(np.float64) / whole == pytest.approx(expected, abs=rounding)


@given(numbers(1, 180), numbers(0, 1))
def test_all_is_left_up_to_the_inner_angle_and_nothing_at_the_rim(cone_angle: float, share: float) -> None:
    inner = share * (cone_angle - 1)
    cosines = np.array(
        [1.0, cosine(inner / 2), cosine(inner) + 1e-6, cosine(cone_angle) - 1e-6, -1], np.float32
    )
    left = soft_cone_share(cosines, inner, cone_angle)
    assert left[:3] == pytest.approx(1, abs=1e-6)
    assert left[3:].tolist() == [0, 0]


def test_a_soft_cone_is_smooth_at_both_angles_and_on_the_axis() -> None:
    degrees = np.arange(0, 50, 0.05)
    cosines = np.cos(np.radians(degrees)).astype(np.float32)
    left = soft_cone_share(cosines, 0, 40).astype(np.float64)
    slope = np.diff(left) / 0.05
    assert slope.max() < 1e-4
    assert np.abs(slope[:10]).max() < 1e-3
    assert np.abs(slope[np.abs(degrees[:-1] - 40) < 0.06]).max() < 1e-3
    assert np.abs(np.diff(slope)).max() < 1e-3


@pytest.mark.parametrize(("outer", "inner"), [(1e-6, 0.0), (180.0, math.nextafter(180.0, 0.0)), (30.0, 0.0)])
def test_the_share_stays_within_0_and_1_however_narrow_the_edge(outer: float, inner: float) -> None:
    cosines = np.linspace(-1.0000002, 1.0000002, 1001).astype(np.float32)
    left = soft_cone_share(cosines, inner, outer)
    assert ((left >= 0) & (left <= 1)).all()


FALLING = st.sampled_from(["linear", "quadratic"])


@pytest.mark.parametrize("falloff", ["linear", "quadratic"])
@pytest.mark.parametrize("reach", [1.2, 1.7, 9.0])
def test_on_a_wall_the_light_falls_with_the_distance_to_nothing_at_its_reach(
    falloff: Any, reach: float
) -> None:
    light = Light("light", (0.25, -1.0, 0.125))
    free = wall_scene(lights=[light])
    falling = wall_scene(lights=[light.replace(falloff=falloff, reach=reach)])
    points = visible_surfaces(wall(), free.view, (1,), 40, 40)
    x, _, z = points.world_points.T
    left = np.maximum(1 - np.sqrt(1 + (x - 0.25) ** 2 + (z - 0.125) ** 2) / reach, 0)
    left = left if falloff == "linear" else left**2
    intensities = [render(each, (40, 40)).intensity.ravel()[points.pixels] for each in (free, falling)]
    assert intensities[1] == pytest.approx(left * intensities[0], abs=1e-5)
    assert (left.min() == 0) == (reach < 1.8)
    assert left.max() > 0.02


def test_a_light_falls_to_a_half_and_to_a_quarter_at_half_its_reach() -> None:
    distances = np.array([0, 0.5, 1, 2, 4], np.float32)
    for exponent, expected in ((1, [1, 0.75, 0.5, 0, 0]), (2, [1, 0.5625, 0.25, 0, 0])):
        assert Falloff(2, exponent).share(distances).tolist() == pytest.approx(expected, abs=1e-6)


@given(FALLING, st.sampled_from([1e12, 1e20, 1e36]))
def test_a_light_beyond_all_that_falls_gives_nothing_here(falloff: str, distance: float) -> None:
    light = Light("light", (0, -distance, 0), falloff=falloff, reach=3)
    assert not render(wall_scene(lights=[light]), (4, 4)).intensity.any()


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        (
            {"falloff": "linear"},
            "light 'light': falloff must come with a reach, not 'linear' alone; add a reach",
        ),
        (
            {"falloff": "linear", "reach": 2, "direction": (0, 1, 0), "at_infinity": True},
            "light 'light': falloff must be 'none' for a light at infinity, not 'linear'; change one of them",
        ),
        ({"reach": 0}, "light 'light': reach must be a number above 0, not 0"),
    ],
)
def test_a_falloff_without_a_reach_or_at_infinity_is_refused(
    fields: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InputError) as refusal:
        Light("light", (0, -1, 0), **fields)  # type: ignore[arg-type]
    assert str(refusal.value) == sentence


PARTS = ["part 0", "part 1"]


@given(scenes(), lights(), some_of(PARTS), st.booleans())
def test_a_light_linked_to_parts_is_the_light_of_all_where_they_are_and_nothing_elsewhere(
    scene: Scene, light: Light, names: tuple[str, ...], is_only: bool
) -> None:
    links = Links(only_parts=names) if is_only else Links(except_parts=names)
    dark = scene.replace(ambient=0.0)
    free = render(dark.replace(lights=(light,)), (16, 12))
    linked = render(dark.replace(lights=(light.replace(links=links),)), (16, 12))
    numbers = [number for number, name in enumerate(PARTS, 1) if (name in names) == is_only]
    is_lit = np.isin(free.part_number, numbers)
    assert not linked.intensity[~is_lit].any()
    assert linked.intensity[is_lit] == pytest.approx(free.intensity[is_lit], rel=1e-5, abs=1e-30)
