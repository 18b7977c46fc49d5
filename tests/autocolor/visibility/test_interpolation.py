from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.visible_points import NORMAL, POINT, POINT_SQUARED, REFLECTED_VIEW
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor import reference
from tests.autocolor.meshes import grid, sphere
from tests.autocolor.reference import ray
from tests.autocolor.strategies import Vector, meshes, outside_views, rasters, views


@given(meshes(), views(), rasters)
def test_no_row_is_ever_other_than_a_finite_number(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    points = visible_surfaces(mesh, view, (1, 2), *raster)
    assert np.isfinite(points.rows).all()
    assert len(np.unique(points.pixels)) == len(points.pixels)


@given(meshes(), views(), rasters)
def test_points_lie_on_their_rays_and_rows_agree(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    points = visible_surfaces(mesh, view, (1, 2), *raster)
    for pixel, point in zip(points.pixels.tolist(), points.world_points, strict=True):
        direction = np.array(ray(view, *raster, *divmod(pixel, raster[1])))
        depth = float((point - np.array(view.eye)) @ view.axes[2])
        assert point == pytest.approx(np.array(view.eye) + depth * direction, abs=4e-6 * max(depth, 4))
    rows = points.rows.astype(np.float64)
    normal_lengths = np.linalg.norm(rows[NORMAL], axis=0)
    assert ((np.abs(normal_lengths - 1) < 1e-5) | (normal_lengths < 1e-5)).all()
    assert np.linalg.norm(rows[REFLECTED_VIEW], axis=0) == pytest.approx(
        np.ones(len(points.pixels)), abs=1e-5
    )
    size = 1 + np.abs(rows[POINT]).max(initial=0.0)
    assert (rows[POINT] ** 2).sum(axis=0) == pytest.approx(rows[POINT_SQUARED], rel=1e-5, abs=1e-12)
    for vector, product in ((NORMAL, NORMAL.stop), (REFLECTED_VIEW, REFLECTED_VIEW.stop)):
        assert (rows[vector] * rows[POINT]).sum(axis=0) == pytest.approx(rows[product], abs=1e-5 * size)


@pytest.mark.parametrize("columns", [1, 5])
@pytest.mark.parametrize("eye", [(0.3, -4.0, 1.0), (0.3, 4.0, 1.0)])
def test_a_normal_turns_to_the_eye_from_both_sides(columns: int, eye: Vector) -> None:
    mesh = grid(columns, columns, (-1, 0, -1), (2, 0, 0), (0, 0, 2))
    view = View(eye, target=(0.0, 0.0, 0.0))
    toward_eye = math.copysign(1.0, eye[1])
    two_sided = visible_surfaces(mesh, view, (1,), 12, 12)
    assert two_sided.world_normals == pytest.approx(
        np.tile([0, toward_eye, 0], (len(two_sided.pixels), 1)), abs=1e-6
    )
    one_sided = visible_surfaces(mesh, view, (1,), 12, 12, frozenset({1}))
    assert one_sided.world_normals == pytest.approx(np.tile([0, -1, 0], (len(one_sided.pixels), 1)), abs=1e-6)


def test_the_normals_of_a_fine_sphere_point_outward() -> None:
    view = View((3.0, -4.0, 2.0), target=(0.0, 0.0, 0.0))
    points = visible_surfaces(sphere(96, 48), view, (1,), 60, 60)
    along = points.world_points / np.linalg.norm(points.world_points, axis=1)[:, None]
    assert np.abs(points.world_normals - along).max() < 5e-3


def test_normals_are_interpolated_perspective_correctly() -> None:
    # A floor in one polygon with two normals: close to the eye, the middle of the floor is not the middle
    # of its picture, and the normal there is the mean of the two.
    ridge = Mesh(
        np.array(
            [
                (-1, 0, 0),
                (1, 0, 0),
                (1, 8, 0),
                (-1, 8, 0),
                (-1, -1, -1),
                (1, -1, -1),
                (1, 9, -1),
                (-1, 9, -1),
            ],
            np.float64,
        ),
        np.array([(0, 1, 2, 3), (4, 5, 1, 0), (3, 2, 6, 7)]),
        np.zeros(3, np.intp),
        ("ridge",),
        crease_angle=180.0,
    )
    view = View((0.0, -4.0, 4.0), target=(0.0, 4.0, 0.0), field_of_view=60.0)
    points = visible_surfaces(ridge, view, (1,), 80, 80)
    on_floor = points.polygon_numbers == 0
    way = points.world_points[on_floor, 1] / 8
    ends = ridge.normals.vectors[ridge.normals.numbers[0][[0, 2]]]
    expected = (1 - way)[:, None] * ends[0] + way[:, None] * ends[1]
    expected /= np.linalg.norm(expected, axis=1)[:, None]
    assert np.abs(points.world_normals[on_floor] - expected).max() < 1e-5


@pytest.mark.parametrize(("one_sided", "sign"), [(frozenset[int](), -1), (frozenset({1}), 1)])
def test_from_within_a_sphere_the_normals_point_inward_unless_it_is_one_sided(
    one_sided: frozenset[int], sign: int
) -> None:
    view = View((0.3, -0.4, 0.2), direction=(1.0, 2.0, 0.5), field_of_view=90)
    points = visible_surfaces(sphere(24, 16), view, (1,), 30, 30, one_sided)
    along = points.world_points / np.linalg.norm(points.world_points, axis=1)[:, None]
    assert np.abs(points.world_normals - sign * along).max() < 0.02


@given(meshes(), views() | outside_views(), rasters)
def test_the_view_direction_is_reflected_at_the_normal(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    points = visible_surfaces(mesh, view, (1, 2), *raster)
    reflected = points.rows[REFLECTED_VIEW].T.astype(np.float64) @ view.axes
    for number, pixel in enumerate(points.pixels.tolist()):
        to_eye = reference.unit(reference.times(-1, ray(view, *raster, *divmod(pixel, raster[1]))))
        normal = points.world_normals[number].tolist()
        expected = reference.minus(reference.times(2 * reference.dot(normal, to_eye), normal), to_eye)
        assert reflected[number].tolist() == pytest.approx(expected, abs=1e-5)


@given(outside_views(), rasters)
def test_points_of_a_flat_polygon_lie_in_its_plane(view: View, raster: tuple[int, int]) -> None:
    slope = grid(1, 1, (-1, -0.5, -1), (2, 0.3, 0.2), (0, 0.7, 2))
    normal = np.cross((2, 0.3, 0.2), (0, 0.7, 2))
    normal /= np.linalg.norm(normal)
    points = visible_surfaces(slope, view, (1,), *raster)
    assert (points.world_points - slope.coordinates[0]) @ normal == pytest.approx(
        np.zeros(len(points.pixels)), abs=2e-5
    )
