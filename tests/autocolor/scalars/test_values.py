from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.rendering import rendering
from autocolor.scalars.computed import ScalarValues
from autocolor.scalars.values import scalar_values
from autocolor.scene.scalar import MeshScalar, Scalar
from autocolor.visibility.visible_points import VisiblePoints
from tests.autocolor.meshes import grid, sphere, wall, wall_scene
from tests.autocolor.reference import weights_in
from tests.autocolor.strategies import numbers


def seen(mesh: Mesh, view: View | None = None, lines: int = 24, elements: int = 32) -> VisiblePoints:
    return rendering(wall_scene(mesh, view=view), lines, elements).points


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
def test_values_of_nodes_are_those_of_the_twin(at_nodes: list[float]) -> None:
    mesh = sphere(12, 9).with_scalars(MeshScalar("stress", np.array([*at_nodes, 1.0, 2.0])))
    points = seen(mesh, lines=9, elements=12)
    values, _ = values_of(mesh, "stress", points)
    for value, point, polygon in zip(values, points.world_points, points.polygon_numbers, strict=True):
        nodes = list(dict.fromkeys(mesh.node_numbers[polygon].tolist()))
        weights = weights_in(mesh.coordinates[nodes].tolist(), point.tolist())
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


def test_nodes_that_no_polygon_uses_are_not_in_the_range() -> None:
    one = wall()
    mesh = Mesh(np.vstack([one.coordinates, [(9.0, 9.0, 9.0)]]), one.node_numbers, part_names=("wall",))
    mesh = mesh.with_scalars(MeshScalar("stress", np.array([1.0, 2.0, 3.0, 4.0, 1000.0])))
    assert values_of(mesh, "stress", seen(mesh)).limits == (1, 4)


def test_a_scalar_of_the_mesh_comes_before_a_computed_one() -> None:
    mesh = wall().with_scalars(MeshScalar("z", np.full(4, 7.0)))
    assert set(values_of(mesh, "z", seen(mesh)).values.tolist()) == {7.0}
