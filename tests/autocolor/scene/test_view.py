from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Part, View, render, scene_of
from autocolor.checks import Vector
from autocolor.scene import defaults
from autocolor.scene.defaults import (
    default_lights,
    default_view,
    framed,
    object_bounds,
    object_coordinates,
    stage_top,
)
from autocolor.testing import directions, meshes, numbers, vectors, views
from tests.small import cube, grid, sphere
from tests.tables import refused


@given(vectors(), directions(), numbers(-720, 720))
def test_the_axes_are_a_rotation_with_the_view_direction_last(
    eye: Vector, direction: Vector, angle: float
) -> None:
    axes = View(eye, direction=direction, angle=angle).axes
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    # Right, down and forward, in this order, are right-handed.
    assert np.linalg.det(axes) == pytest.approx(1)
    assert np.cross(axes[2], direction) == pytest.approx(np.zeros(3), abs=1e-12)
    assert axes[2] @ np.array(direction) > 0


@given(vectors(), directions())
def test_without_an_angle_the_horizon_is_level_and_up_is_up(eye: Vector, direction: Vector) -> None:
    right, down, _ = View(eye, direction=direction).axes
    if direction[0] or direction[1]:
        assert right[2] == pytest.approx(0, abs=1e-12)
        assert down[2] < 0
    else:
        assert down == pytest.approx((0, -1, 0))


def test_looking_down_the_top_of_the_picture_is_y() -> None:
    for direction in ((0, 0, -1), (1e-12, -1e-12, -1)):
        right, down, _ = View((0, 0, 5), direction=direction).axes
        assert right == pytest.approx((1, 0, 0), abs=1e-9)
        assert down == pytest.approx((0, -1, 0), abs=1e-9)


def test_along_y_right_is_x_and_down_is_minus_z_and_an_angle_turns_right_toward_the_top() -> None:
    for angle in (0, 30):
        turn = math.radians(angle)
        axes = View((0, 0, 0), direction=(0, 2, 0), angle=angle).axes
        right, down = (math.cos(turn), 0, math.sin(turn)), (math.sin(turn), 0, -math.cos(turn))
        assert axes == pytest.approx(np.array([right, down, (0, 1, 0)]))


def test_a_picture_narrower_than_4_to_3_shows_more_above_and_below() -> None:
    view = View((0, 0, 0), direction=(0, 1, 0), field_of_view=60)
    heights = [view.half_height(aspect) * math.sqrt(3) for aspect in (2, 4 / 3, 1, 2 / 3)]
    assert heights == pytest.approx([1, 1, 4 / 3, 2])


@pytest.mark.parametrize("size", [1e-300, 1e-20, 1e20, 1e30])
def test_a_direction_of_any_length_will_do(size: float) -> None:
    axes = View((0, 0, 0), direction=(size, size, 0)).axes
    assert axes == pytest.approx(View((0, 0, 0), direction=(1, 1, 0)).axes)


def test_giving_a_direction_drops_the_target_and_the_other_way_round() -> None:
    view = View((0, 0, 0), target=(1, 0, 0))
    directed = view.replace(direction=(0, 1, 0))
    assert (directed.direction, directed.target) == ((0, 1, 0), None)
    assert directed.replace(target=(1, 0, 0)) == view
    assert View((1, 2, 3), target=(4, 6, 3)).axes == pytest.approx(View((1, 2, 3), direction=(3, 4, 0)).axes)


EITHER = "view: it must have either a direction or a target; give one of them"

test_a_view_that_breaks_a_rule_is_refused = refused(
    lambda fields: View((0, 0, 0), **fields),
    [
        ({}, EITHER),
        ({"direction": (1, 0, 0), "target": (1, 1, 1)}, EITHER),
        (
            {"target": (0, 0, 0)},
            "view: the target must differ from the eye, (0.0, 0.0, 0.0); move one of them",
        ),
    ],
)


def test_direction_height_and_distance_of_the_eye_from_the_target_change_evenly() -> None:
    # From 2 before the target to 6 beside it, 60 degrees up, while the target moves.
    one = View((2, 0, 0), target=(0, 0, 0))
    other = View((4, 3, 8 + 3 * math.sqrt(3)), target=(4, 0, 8))
    for start, end, share in ((one, other, 1 / 3), (other, one, 2 / 3)):
        between = start.between(end, share)
        assert between.target == pytest.approx((4 / 3, 0, 8 / 3))
        turn, up, far = math.radians(30), math.radians(20), 10 / 3
        away = (math.cos(up) * math.cos(turn), math.cos(up) * math.sin(turn), math.sin(up))
        assert np.array(between.eye) - np.array(between.target) == pytest.approx(far * np.array(away))


def test_a_quarter_of_a_turn_stays_on_its_circle() -> None:
    one, other = View((5, 0, 3), target=(1, 0, 0)), View((1, 4, 3), target=(1, 0, 0))
    root = 4 / math.sqrt(2)
    assert one.between(other, 0.5).eye == pytest.approx((1 + root, root, 3))
    # From 170 to -170 degrees, the shortest way is through 180.
    one, other = (
        View((math.cos(math.radians(a)), math.sin(math.radians(a)), 0), target=(0, 0, 0)) for a in (170, -170)
    )
    assert one.between(other, 0.5).eye == pytest.approx((-1, 0, 0))


def test_an_eye_stays_while_its_target_moves() -> None:
    one = View((5, 0, 3), target=(1, 0, 0))
    between = one.between(one.replace(target=(1, 2, 4)), 0.5)
    assert (between.eye, between.target) == ((5, 0, 3), (1, 1, 2))


def test_a_view_from_above_descends_without_a_swing() -> None:
    # The picture's bottom is -y from above, as from the side of -y.
    above, front = View((0, 0, 5), target=(0, 0, 0)), View((0, -5, 0), target=(0, 0, 0))
    for one, other in ((above, front), (front, above)):
        right, down, _ = one.between(other, 0.5).axes
        assert right == pytest.approx((1, 0, 0))
        assert down == pytest.approx((0, -math.sqrt(0.5), -math.sqrt(0.5)))


def test_a_direction_turns_with_a_level_horizon_while_the_eye_moves_along_a_line() -> None:
    one, other = View((0, 0, 0), direction=(1, 0, 1)), View((2, 4, 0), direction=(0, 3, 3))
    between = one.between(other, 0.5)
    assert (between.eye, between.target) == ((1, 2, 0), None)
    assert between.direction == pytest.approx((0.5, 0.5, math.sqrt(0.5)))
    # A view with a target looks at it at first, and then turns away from it.
    aimed = View((0, 0, 0), target=(7, 0, 7)).between(other, 0.5)
    assert aimed.direction == pytest.approx(between.direction)


@given(views())
def test_the_point_to_orbit_is_on_the_line_of_sight(view: View) -> None:
    target = np.array(view.orbit_target((-1, -1, -1), (1, 1, 1))) - np.array(view.eye)
    _, _, depth = view.axes @ target
    assert view.axes @ target == pytest.approx((0, 0, depth), abs=1e-6 * depth)
    assert depth > 0


def assert_framed(view: View, mesh: Mesh) -> None:
    """Every node that a polygon uses is before the eye and within 0.9 of the picture from its middle."""
    used = mesh.coordinates[np.unique(mesh.node_numbers)]
    places = (used - np.array(view.eye)) @ view.axes.T
    right, down, deep = places.T
    slope = np.tan(np.radians(view.field_of_view) / 2)
    assert (deep > 0).all()
    assert (np.abs(down) <= 0.9 * slope * deep).all()
    assert (np.abs(right) <= 0.9 * slope * 640 / 480 * deep).all()


def resized(mesh: Mesh, size: float, middle: Vector = (0, 0, 0)) -> Mesh:
    return Mesh(
        mesh.coordinates * size + np.array(middle) * size,
        mesh.node_numbers,
        mesh.part_numbers,
        mesh.part_names,
    )


SIZES = st.sampled_from([1e-200, 1e-20, 1e-6, 1.0, 1e6, 1e20, 2e29])


@given(
    meshes(),
    SIZES,
    vectors(),
    st.one_of(st.none(), directions()),
    numbers(-180, 180),
    st.sampled_from([1.0, 30.0, 120.0]),
)
def test_every_node_is_within_the_picture_with_space_on_all_sides(
    mesh: Mesh, size: float, middle: Vector, direction: Vector | None, angle: float, field_of_view: float
) -> None:
    placed = resized(mesh, size, middle)
    if direction is None:
        assert_framed(default_view(placed.used_coordinates), placed)
    else:
        view = View((0, 0, 0), direction=direction, angle=angle, field_of_view=field_of_view)
        around = framed(view, placed.used_coordinates)
        assert_framed(around, placed)
        assert around.axes == pytest.approx(view.axes, abs=1e-9)


@given(meshes(), st.one_of(st.none(), directions()), st.sampled_from([10.0, 30.0, 90.0]))
def test_a_framed_object_is_in_the_middle_of_the_picture(
    mesh: Mesh, direction: Vector | None, field_of_view: float
) -> None:
    view = View((0, 0, 0), direction=direction or (1, 2, -1), field_of_view=field_of_view)
    placed = framed(view, mesh.used_coordinates)
    used = mesh.coordinates[np.unique(mesh.node_numbers)]
    right, down, deep = ((used - np.array(placed.eye)) @ placed.axes.T).T
    if np.ptp(used, axis=0).max() > 1e-6:
        for across in (right, down):
            assert (across / deep).max() == pytest.approx(-(across / deep).min(), abs=1e-6)


@pytest.mark.parametrize(("lines", "elements"), [(160, 80), (160, 160), (90, 160), (60, 240)])
@pytest.mark.parametrize("mesh", [sphere(), grid(2, 2, (0, 0, 0), (3, 0, 0), (0, 0, 1))], ids=repr)
def test_an_object_is_framed_by_the_shape_of_the_picture(mesh: Mesh, lines: int, elements: int) -> None:
    scene = scene_of(mesh)
    view = framed(scene.view, scene.object_coordinates, elements / lines)
    seen = np.nonzero(render(scene.replace(view=view), (elements, lines)).surface_number)
    assert max(np.ptp(seen[0]) / lines, np.ptp(seen[1]) / elements) == pytest.approx(0.86, abs=0.03)


VIEWS: list[tuple[Vector, Vector, list[tuple[str, float, Vector]]]] = [
    (
        (1, 2, -1),
        (-0.548, -2.596, 1.674),
        [
            ("key", 1.03, (-4.38, -2.318, 3.458)),
            ("fill", 0.77, (1.461, -5.494, 1.739)),
            ("top", 0.67, (0.385, 1.32, 5.864)),
            ("rim", 0.65, (2.691, 4.394, 4.718)),
        ],
    ),
    (
        (0, 0, -1),
        (1.0, 0.5, 3.755),
        [
            ("key", 1.03, (-2.551, 3.708, 5.176)),
            ("fill", 0.77, (4.093, 1.989, 5.405)),
            ("top", 0.67, (0.083, 6.114, -0.208)),
            ("rim", 0.65, (0.771, 4.968, -3.989)),
        ],
    ),
]


@pytest.mark.parametrize(("direction", "eye", "lights"), VIEWS)
def test_the_eye_and_the_lights_stand_where_they_stood(
    direction: Vector, eye: Vector, lights: list[tuple[str, float, Vector]]
) -> None:
    coordinates = cube().coordinates * (2, 1, 0.5)
    view = framed(View((0, 0, 0), direction=direction), coordinates)
    created = default_lights(coordinates, view)
    assert view.eye == pytest.approx(eye, abs=1e-3)
    assert [(light.name, light.intensity) for light in created] == [light[:2] for light in lights]
    for light, (_, _, place) in zip(created, lights, strict=True):
        assert light.position == pytest.approx(place, abs=1e-3)
        assert light.aim == (1.0, 0.5, 0.25)


@given(meshes(), SIZES, vectors())
def test_a_scene_is_created_for_any_mesh_and_rendered(mesh: Mesh, size: float, middle: Vector) -> None:
    scene = scene_of(resized(mesh, size, middle))
    picture = render(scene, (16, 12))
    assert np.isfinite(picture.intensity).all()
    assert len(scene.lights) == 4


@given(st.floats(0.01, 100))
def test_created_lights_and_view_grow_with_the_object(size: float) -> None:
    one, other = scene_of(cube()), scene_of(cube(size))
    assert np.array(other.view.eye) == pytest.approx(np.array(one.view.eye) * size)
    for light, larger in zip(one.lights, other.lights, strict=True):
        assert np.array(larger.position) == pytest.approx(np.array(light.position) * size, abs=1e-9 * size)
    assert render(one, (32, 24)).intensity == pytest.approx(render(other, (32, 24)).intensity, abs=1e-4)


@given(meshes())
def test_the_view_does_not_depend_on_how_many_nodes_are_looked_at_at_once(mesh: Mesh) -> None:
    whole = default_view(mesh.used_coordinates)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(defaults, "POINTS_AT_ONCE", 2)
        assert default_view(mesh.used_coordinates).eye == pytest.approx(whole.eye, abs=1e-9)


def staged(mesh: Mesh, *names: str) -> list[Part]:
    """The parts of a mesh; those of the names are stage."""
    return [Part(name, "surface", stage=name in names) for name in mesh.part_names]


def on_a_floor(mesh: Mesh) -> Mesh:
    """The mesh with a part "floor" far greater than itself."""
    return Mesh.joined([mesh, grid(1, 1, (-90, -90, 0), (180, 0, 0), (0, 180, 0), "floor")])


@given(meshes(parts=3), st.sets(st.sampled_from(["part 0", "part 1", "part 2"])))
def test_the_coordinates_of_the_object_are_those_of_all_parts_that_are_not_stage(
    mesh: Mesh, stage: set[str]
) -> None:
    parts = staged(mesh, *stage)
    before, behind = set[int](), set[int]()
    for nodes, part in zip(mesh.node_numbers.tolist(), mesh.part_numbers.tolist(), strict=True):
        (behind if mesh.part_names[part] in stage else before).update(nodes)
    # A scene of nothing but its stage is looked at as a whole.
    found = mesh.coordinates[sorted(before or behind)]
    assert object_coordinates(mesh, parts).tolist() == found.tolist()
    low, high = object_bounds(mesh, parts)
    assert (low.tolist(), high.tolist()) == (found.min(axis=0).tolist(), found.max(axis=0).tolist())
    is_beside = before and behind
    assert stage_top(mesh, parts) == (mesh.coordinates[sorted(behind), 2].max() if is_beside else -math.inf)


def test_a_part_without_polygons_is_neither_stage_nor_object() -> None:
    mesh = dataclasses.replace(cube(), part_names=("cube", "none"))
    for stage in ("none", "cube"):
        assert object_bounds(mesh, staged(mesh, stage)) is mesh.bounds
        assert stage_top(mesh, staged(mesh, stage)) == -math.inf


@pytest.mark.parametrize("mesh", [cube(), sphere()], ids=repr)
def test_a_view_and_lights_are_the_same_with_a_floor_that_is_stage_and_without_it(mesh: Mesh) -> None:
    coordinates = object_coordinates(on_a_floor(mesh), staged(on_a_floor(mesh), "floor"))
    view = default_view(coordinates)
    assert view == default_view(mesh.coordinates)
    assert default_lights(coordinates, view) == default_lights(mesh.coordinates, view)
    above = View((0, 0, 5), direction=(0, 0, -1), angle=20)
    assert framed(above, coordinates) == framed(above, mesh.coordinates)


def elevation_above(width: float, depth: float, height: float) -> float:
    """The elevation in degrees of the eye of a new view of a box."""
    box = np.array([(x, y, z) for x in (0, width) for y in (0, depth) for z in (0, height)], np.float64)
    return math.degrees(math.asin(-default_view(box).axes[2][2]))


@pytest.mark.parametrize(
    ("sides", "degrees"),
    [
        ((1, 1, 1), 21),
        ((1, 1, 0.5), 21),
        ((1, 1, 0), 40),
        ((4, 1, 0.5), 30.5),
        ((9, 0, 3), 21),
        ((2, 0, 0), 21),
    ],
)
def test_the_eye_is_higher_above_flat_and_lying_objects(sides: tuple[float, ...], degrees: float) -> None:
    for size in (1e-9, 1.0, 1e9):
        assert elevation_above(*(size * side for side in sides)) == pytest.approx(degrees)
