from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.rendering import rendering
from autocolor.scalars.computed import (
    COMPUTING,
    ScalarValues,
    coordinate,
    direction_of,
    distance,
    draft_angle,
    gaussian_curvature,
    largest_curvature,
    mean_curvature,
    range_of,
    scalar_values,
    slope,
    smallest_curvature,
    within,
    zebra,
)
from autocolor.scene.scalar import COMPUTED, MeshScalar, Scalar
from autocolor.testing import numbers
from autocolor.visibility.visible_points import VisiblePoints
from tests.autocolor.twins.level import corner_weights
from tests.small import cube, grid, sphere, wall, wall_scene


def seen(mesh: Mesh, view: View | None = None, lines: int = 30, elements: int = 40) -> VisiblePoints:
    return rendering(wall_scene(mesh, view=view), lines, elements).points


@pytest.mark.parametrize("name", COMPUTED)
def test_every_point_has_a_single_and_the_range_is_two_singles(name: str) -> None:
    scene = wall_scene(sphere(12, 8))
    points = rendering(scene, 12, 16).points
    values, limits = COMPUTING[name](scene.mesh, Scalar(name), points)
    assert values.dtype == np.float32
    assert values.shape == points.pixels.shape
    assert np.isfinite(values).all()
    assert limits == tuple(float(np.float32(limit)) for limit in limits)
    assert limits[0] < limits[1]


@pytest.mark.parametrize("name", COMPUTED)
def test_a_view_that_sees_nothing_has_no_values(name: str) -> None:
    scene = wall_scene(wall()).with_view(target=(0.0, -9.0, 0.0))
    values, (low, high) = COMPUTING[name](scene.mesh, Scalar(name), rendering(scene, 6, 8).points)
    assert len(values) == 0
    assert low < high


@pytest.mark.parametrize("name", COMPUTED)
def test_a_mesh_without_polygons_has_a_range(name: str) -> None:
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.intp), np.zeros(0, np.intp))
    points = rendering(wall_scene(wall()).with_view(target=(0.0, -9.0, 0.0)), 6, 8).points
    values, (low, high) = COMPUTING[name](empty, Scalar(name), points)
    assert len(values) == 0
    assert low < high


def test_missing_values_are_not_in_the_range() -> None:
    assert range_of(np.array([np.nan, 3.0, -1.0, np.nan])) == (-1, 3)
    assert range_of(np.array([np.nan])) == range_of(np.empty(0)) == (0, 1)


@pytest.mark.parametrize(
    ("value", "limits"),
    [
        (8.0, (4, 12)),
        (-8.0, (-12, -4)),
        (0.0, (-0.5, 0.5)),
        (1e-45, (-0.5, 0.5)),
    ],
)
def test_a_constant_is_in_the_middle_of_its_range(value: float, limits: tuple[float, float]) -> None:
    assert range_of(np.array([value, value])) == limits


@given(st.lists(st.floats(-1e30, 1e30), min_size=1))
def test_every_value_is_in_the_range_also_as_a_single(numbers: list[float]) -> None:
    low, high = range_of(np.array(numbers))
    assert low < high
    assert (low, high) == (float(np.float32(low)), float(np.float32(high)))
    singles = np.array(numbers, np.float32)
    assert low <= singles.min() <= singles.max() <= high


def test_a_share_of_the_values_can_be_cut_off() -> None:
    assert range_of(np.linspace(0, 100, 1001), 2) == pytest.approx((2, 98))


def test_values_that_rounding_put_beyond_the_limits_are_clipped() -> None:
    values = np.array([-1e-9, 0.5, np.nan, 1 + 1e-6], np.float32)
    found = within(values, (0, 1))
    assert np.array_equal(found.values, np.array([0, 0.5, np.nan, 1], np.float32), equal_nan=True)


PITCH = 35.0


def roof() -> Mesh:
    """Two sides of a roof along y that face outward, the left one rising to the right by PITCH degrees."""
    rise = math.tan(math.radians(PITCH))
    left = grid(3, 2, (-1.0, -1.0, 0.0), (1.0, 0.0, rise), (0.0, 2.0, 0.0), "left")
    right = grid(3, 2, (0.0, -1.0, rise), (1.0, 0.0, -rise), (0.0, 2.0, 0.0), "right")
    return Mesh.joined([left, right])


def cone(angle: float, columns: int = 180) -> Mesh:
    """The side of a cut cone about z that narrows upward, its side `angle` degrees off the axis."""
    turns = np.arange(columns) * 2 * np.pi / columns
    lower = np.stack([2 * np.cos(turns), 2 * np.sin(turns), np.zeros(columns)], axis=1)
    narrow = 1 - math.tan(math.radians(angle)) / 2
    upper = lower * (narrow, narrow, 0) + (0.0, 0.0, 1.0)
    column = np.arange(columns)
    after = (column + 1) % columns
    quads = np.stack([column, after, after + columns, column + columns], axis=1)
    return Mesh(np.concatenate([lower, upper]), quads, part_names=("cone",))


def of_roof(eye: tuple[float, float, float], direction: tuple[float, float, float]) -> ScalarValues:
    points = seen(roof(), View(eye, target=(0.0, 0.0, 0.3)))
    return slope(roof(), Scalar("slope", direction=direction), points)


@pytest.mark.parametrize("eye", [(0.5, -2.0, 6.0), (0.5, -1.0, -5.0)])
def test_the_slope_of_a_roof_is_its_pitch_from_above_and_from_below(eye: tuple[float, float, float]) -> None:
    values, limits = of_roof(eye, (0.0, 0.0, 1.0))
    assert len(values) > 100
    assert values == pytest.approx(PITCH, abs=1e-4)
    assert limits == (0, 90)


def test_the_slope_is_counted_from_the_plane_across_the_direction() -> None:
    values, _ = of_roof((0.5, -2.0, 6.0), (1.0, 0.0, 0.0))
    assert values == pytest.approx(90 - PITCH, abs=1e-4)
    along, _ = of_roof((0.5, -2.0, 6.0), (0.0, 5.0, 0.0))
    assert along == pytest.approx(90, abs=1e-4)


@pytest.mark.parametrize("angle", [0.0, 3.0, 20.0])
@pytest.mark.parametrize("pull", [1.0, -1.0])
def test_the_draft_angle_of_a_cone_is_the_angle_of_its_side(angle: float, pull: float) -> None:
    mesh = cone(angle)
    for eye in ((0.0, -9.0, 2.0), (0.0, -9.0, 14.0)):
        # From the second place the inside is seen, too: the outside counts.
        points = seen(mesh, View(eye, target=(0.0, 0.0, 0.5)))
        values, limits = draft_angle(mesh, Scalar("draft angle", direction=(0.0, 0.0, pull)), points)
        assert len(values) > 50
        assert values == pytest.approx(pull * angle, abs=0.01)
        assert limits == (-90, 90)


def test_the_sides_of_a_box_have_the_draft_angles_of_a_mold() -> None:
    mesh = cube()
    points = seen(mesh, View((2.0, -3.0, 2.5), target=(0.5, 0.5, 0.5)))
    values, _ = draft_angle(mesh, Scalar("draft angle"), points)
    of_polygon = {
        polygon: sorted(set(np.round(values[points.polygon_numbers == polygon], 3).tolist()))
        for polygon in np.unique(points.polygon_numbers).tolist()
    }
    assert of_polygon == {1: [90.0], 2: [0.0], 5: [0.0]}


ANY = Scalar("mean curvature")


def test_a_ball_has_one_curvature_at_every_pixel() -> None:
    mesh = sphere(120, 60, radius=2.0)
    points = seen(mesh)
    for found, wanted in (
        (mean_curvature, 0.5),
        (gaussian_curvature, 0.25),
        (largest_curvature, 0.5),
        (smallest_curvature, 0.5),
    ):
        values, limits = found(mesh, ANY, points)
        # The principal curvatures are a root apart, which is not exact where they are equal.
        assert values == pytest.approx(wanted, rel=0.03)
        assert limits[0] <= wanted * 1.001
        assert limits[1] >= wanted * 0.999


def test_a_cylinder_bends_one_way() -> None:
    mesh = cone(0.0)
    points = seen(mesh)
    wanted = {mean_curvature: 0.25, gaussian_curvature: 0.0, largest_curvature: 0.5, smallest_curvature: 0.0}
    for found, number in wanted.items():
        assert found(mesh, ANY, points).values == pytest.approx(number, abs=1e-3)


@pytest.mark.parametrize("size", [1e4, 1e-4])
def test_a_ball_of_any_size_is_bent(size: float) -> None:
    mesh = sphere(40, 20, radius=size)
    _, limits = mean_curvature(mesh, ANY, seen(mesh))
    assert limits == pytest.approx((1 / size, 1 / size), rel=0.3)


def test_the_range_leaves_a_few_sharp_bends_out() -> None:
    ball, needle = sphere(120, 60), sphere(12, 8, radius=0.01)
    moved = Mesh(needle.coordinates + np.array([3.0, 0.0, 0.0]), needle.node_numbers, part_names=("needle",))
    mesh = Mesh.joined([ball, moved])
    _, (low, high) = mean_curvature(mesh, ANY, seen(ball))
    assert mesh.curvatures.mean.max() > 50
    assert 0.4 < low < 1 < high < 2


def test_a_surface_that_is_flat_but_for_rounding_has_the_middle_of_the_range() -> None:
    mesh = grid(9, 9, (0.1, 0.2, 0.3), (3.0, 0.7, -0.2), (-0.3, 2.0, 1.1))
    mesh = Mesh(mesh.coordinates.astype(np.float32), mesh.node_numbers, part_names=("wall",))
    points = seen(mesh)
    assert mesh.curvatures.mean.any()
    for found in (mean_curvature, gaussian_curvature, largest_curvature, smallest_curvature):
        values, (low, high) = found(mesh, ANY, points)
        assert len(values) > 10
        assert np.abs((values - low) / (high - low) - 0.5).max() < 0.01


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_coordinates_are_the_world_coordinates_of_the_points(axis: int) -> None:
    scene = wall_scene(sphere())
    points = rendering(scene, 24, 32).points
    values, limits = coordinate(axis, scene.mesh, Scalar("x"), points)
    assert values == pytest.approx(points.world_points[:, axis], abs=1e-6)
    low, high = scene.mesh.bounds
    assert limits == pytest.approx((low[axis], high[axis]))


def test_a_distance_is_measured_along_the_direction_whatever_its_length() -> None:
    scene = wall_scene(sphere(40, 20, radius=2.0))
    points = rendering(scene, 24, 32).points
    direction = np.array([1.0, -2.0, 2.0])
    wanted = points.world_points @ direction / 3
    for length in (1e-30, 1.0, 1e30):
        scalar = Scalar("distance", direction=tuple((direction * length).tolist()))
        assert direction_of(scalar) == pytest.approx(direction / 3)
        values, limits = distance(scene.mesh, scalar, points)
        assert values == pytest.approx(wanted, abs=1e-6)
        assert limits == pytest.approx((-2, 2), abs=0.03)


def test_the_height_of_a_level_plate_is_in_the_middle_of_its_range() -> None:
    mesh = grid(3, 3, (-1.0, -1.0, 1e-9), (2.0, 0.0, 1e-8), (0.0, 2.0, -1e-8))
    points = rendering(wall_scene(mesh, view=View((0.0, 0.1, 4.0), target=(0.0, 0.0, 0.0))), 12, 16).points
    for values, (low, high) in (
        coordinate(2, mesh, Scalar("z"), points),
        distance(mesh, Scalar("distance"), points),
    ):
        assert np.abs((values - low) / (high - low) - 0.5).max() < 0.05


def test_the_range_covers_the_object_and_not_only_its_visible_points() -> None:
    scene = wall_scene(sphere())
    near = rendering(scene.with_view(field_of_view=2), 12, 16).points
    values, limits = coordinate(0, scene.mesh, Scalar("x"), near)
    assert limits == pytest.approx((-1, 1))
    assert np.abs(values).max() < 0.2


def off(one: object, other: object) -> float:
    """The largest difference of two phases, around the turn."""
    difference = np.asarray(one, np.float64) - np.asarray(other, np.float64)
    return float(np.abs(difference - np.round(difference)).max())


def test_stripes_on_a_sphere_are_where_its_rays_are_reflected_to() -> None:
    scene = wall_scene(
        sphere(400, 200), view=View((0.0, -50.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=2)
    )
    points = rendering(scene, 60, 80).points
    scalar = Scalar("zebra", direction=(0.0, 0.0, 1.0), stripes=7)
    values, limits = zebra(scene.mesh, scalar, points)
    # The true sphere: the ray, where it meets it, and the mirrored ray.
    normals = points.world_points / np.linalg.norm(points.world_points, axis=1)[:, None]
    rays = points.world_points - (0.0, -50.0, 0.0)
    mirrored = rays - 2 * (rays * normals).sum(axis=1)[:, None] * normals
    wanted = np.arctan2(mirrored[:, 1], mirrored[:, 0]) * 7 / math.pi
    inside = np.abs(points.world_points[:, 1]) > 0.3
    # The axis that angles are counted from is free.
    assert off(values[inside], wanted[inside] + (values - wanted)[inside][0]) < 0.02
    assert limits == (0, 1)
    assert 0 <= values.min() < 0.05
    assert 0.95 < values.max() < 1


def test_a_mirror_turned_by_an_angle_moves_the_stripes_by_twice_as_much() -> None:
    phases = []
    for turn in (0.0, 10.0):
        angle = math.radians(turn)
        eye = (-200 * math.sin(angle), -200 * math.cos(angle), 0.0)
        scene = wall_scene(wall(), view=View(eye, target=(0.0, 0.0, 0.0), field_of_view=0.01))
        points = rendering(scene, 4, 4).points
        phases.append(float(zebra(scene.mesh, Scalar("zebra", stripes=9), points).values[0]))
    # Seen from another side the mirrored ray goes to the other by the same angle: 10 degrees of 180, times 9.
    assert off(phases[1] - phases[0], 0.5) < 1e-3


def test_the_sides_of_a_surface_have_the_same_stripes() -> None:
    scene = wall_scene(sphere(60, 30), two_sided=False)
    two_sided = scene.with_surface("sphere", two_sided=True)
    inside = View((0.0, 0.2, 0.1), target=(0.0, 1.0, 0.0), field_of_view=70)
    one, two = (
        zebra(
            each.mesh,
            Scalar("zebra"),
            rendering(each.with_view(eye=inside.eye, target=inside.target), 12, 16).points,
        )
        for each in (scene, two_sided)
    )
    assert one.values == pytest.approx(two.values, abs=1e-4)
    assert len(one.values) == 12 * 16


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, -2.0, 3.0)])
def test_a_ray_along_the_lamps_has_a_phase(direction: tuple[float, float, float]) -> None:
    scene = wall_scene(sphere(30, 20))
    values, _ = zebra(scene.mesh, Scalar("zebra", direction=direction), rendering(scene, 31, 41).points)
    assert np.isfinite(values).all()
    assert values.min() >= 0
    assert values.max() < 1


def values_of(mesh: Mesh, name: str, points: VisiblePoints) -> ScalarValues:
    return scalar_values(mesh, Scalar(name), points)


def linear(mesh: Mesh) -> npt.NDArray[np.float64]:
    """A linear field at the nodes of a mesh."""
    field: npt.NDArray[np.float64] = mesh.coordinates @ (3.0, -2.0, 0.5) + 100
    return field


@pytest.mark.parametrize("as_triangles", [False, True])
def test_a_linear_field_on_a_plane_in_perspective_is_right_at_every_pixel(as_triangles: bool) -> None:
    flat = grid(7, 5, (-1.0, -2.0, 0.0), (3.0, 1.0, 0.5), (-0.5, 2.0, 1.0))
    quads = flat.node_numbers
    # Nodes within the plane, moved so that no quad is a parallelogram.
    random = np.random.default_rng(1)
    moves = random.uniform(-0.05, 0.05, (len(flat.coordinates), 2))
    coordinates = flat.coordinates + moves @ np.array([(3.0, 1.0, 0.5), (-0.5, 2.0, 1.0)])
    if as_triangles:
        quads = np.concatenate([quads[:, [0, 1, 2, 2]], quads[:, [0, 2, 3, 3]]])
    mesh = Mesh(coordinates, quads, part_names=("wall",))
    field = linear(mesh)
    mesh = mesh.with_scalars(MeshScalar("field", field))
    view = View((2.0, -4.0, 3.0), target=(0.5, -0.5, 0.7), field_of_view=50)
    points = seen(mesh, view, 120, 160)
    values, limits = values_of(mesh, "field", points)
    assert len(values) > 2000
    assert values.dtype == np.float32
    # The point where the ray through the pixel meets the plane, from the view alone.
    lines, elements = np.divmod(points.pixels, 160)
    focal = 60 / np.tan(np.radians(25))
    rays = np.stack([(elements + 0.5 - 80) / focal, (lines + 0.5 - 60) / focal, np.ones(len(lines))])
    directions = rays.T @ view.axes
    normal = np.cross((3.0, 1.0, 0.5), (-0.5, 2.0, 1.0))
    eye = np.array(view.eye)
    depth = ((-1.0, -2.0, 0.0) - eye) @ normal / (directions @ normal)
    exact = (eye + depth[:, None] * directions) @ (3.0, -2.0, 0.5) + 100
    assert np.abs(values - exact).max() < 1e-5 * (limits[1] - limits[0])
    assert limits == pytest.approx((field.min(), field.max()))


def test_scalars_of_polygons_are_exact() -> None:
    mesh = wall(5, 3)
    numbers_of = np.linspace(-1, 1, 15) / 3
    numbers_of[4] = np.nan
    mesh = mesh.with_scalars(MeshScalar("load", numbers_of, "polygon"))
    points = seen(mesh)
    values, limits = values_of(mesh, "load", points)
    wanted = numbers_of.astype(np.float32)[points.polygon_numbers]
    assert np.array_equal(values, wanted, equal_nan=True)
    assert np.isnan(values).any()
    assert limits == (np.float32(-1 / 3).item(), np.float32(1 / 3).item())


@given(st.lists(numbers(-5, 5), min_size=96, max_size=96))
def test_values_of_nodes_agree_with_the_slow_twin(at_nodes: list[float]) -> None:
    mesh = sphere(12, 9).with_scalars(MeshScalar("stress", np.array([*at_nodes, 1.0, 2.0])))
    points = seen(mesh, lines=9, elements=12)
    values, _ = values_of(mesh, "stress", points)
    for value, point, polygon in zip(values, points.world_points, points.polygon_numbers, strict=True):
        nodes = list(dict.fromkeys(mesh.node_numbers[polygon].tolist()))
        weights = corner_weights(mesh.coordinates[nodes].tolist(), point.tolist())
        expected = np.dot(weights, mesh.scalars[0].values[nodes])
        assert value == pytest.approx(expected, abs=2e-4)


def test_values_never_leave_the_range() -> None:
    random = np.random.default_rng(3)
    mesh = sphere(20, 12)
    mesh = mesh.with_scalars(MeshScalar("steps", random.choice([0.1, 0.7], len(mesh.coordinates))))
    values, limits = values_of(mesh, "steps", seen(mesh, None, 60, 80))
    assert limits == (np.float32(0.1).item(), np.float32(0.7).item())
    assert values.min() == limits[0]
    assert values.max() == limits[1]


def test_a_polygon_with_a_missing_corner_is_missing_and_no_other() -> None:
    mesh = wall(4, 4)
    at_nodes = np.arange(25.0)
    at_nodes[0] = np.nan
    mesh = mesh.with_scalars(MeshScalar("stress", at_nodes))
    points = seen(mesh)
    values, limits = values_of(mesh, "stress", points)
    assert np.array_equal(np.isnan(values), points.polygon_numbers == 0)
    assert limits == (1, 24)


def test_a_scalar_of_the_mesh_comes_before_a_computed_one() -> None:
    mesh = wall().with_scalars(MeshScalar("z", np.full(4, 7.0)))
    assert set(values_of(mesh, "z", seen(mesh)).values.tolist()) == {7.0}


def test_nodes_that_no_polygon_uses_are_not_in_the_range() -> None:
    one = wall()
    mesh = Mesh(np.vstack([one.coordinates, [(9.0, 9.0, 9.0)]]), one.node_numbers, part_names=("wall",))
    mesh = mesh.with_scalars(MeshScalar("stress", np.array([1.0, 2.0, 3.0, 4.0, 1000.0])))
    assert values_of(mesh, "stress", seen(mesh)).limits == (1, 4)
