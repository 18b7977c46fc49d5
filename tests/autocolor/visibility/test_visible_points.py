from __future__ import annotations

from unittest import mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.visible_points import (
    NORMAL,
    POINT,
    ROW_COUNT,
    fill_point_products,
    point_chunks,
    surface_slices,
)
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import cube, sphere
from tests.autocolor.strategies import Vector, meshes, outside_views, vectors

counts_of_surfaces = st.lists(st.integers(0, 40), max_size=6)


@given(counts_of_surfaces, st.integers(1, 50))
def test_chunks_have_every_pixel_of_every_surface_once(counts: list[int], at_once: int) -> None:
    slices = surface_slices(np.array([0, *counts]))
    with mock.patch("autocolor.visibility.visible_points.PIXELS_AT_ONCE", at_once):
        every = point_chunks(slices)
    numbers = np.zeros(sum(counts), int)
    for chunk in every:
        here = numbers[chunk.pixels]
        assert 0 < len(here) <= at_once
        for each in chunk.slices:
            here[each.pixels] += each.surface_number
    assert numbers.tolist() == [number + 1 for number, count in enumerate(counts) for _ in range(count)]


@given(counts_of_surfaces)
def test_each_surface_that_has_pixels_has_one_slice(counts: list[int]) -> None:
    numbers = [number for number, count in enumerate(counts) for _ in range(count)]
    slices = surface_slices(np.array([*counts, 0]))
    assert [each.surface_number for each in slices] == sorted(set(numbers))
    for each in slices:
        assert set(numbers[each.pixels]) == {each.surface_number}
    assert sum(each.stop - each.start for each in slices) == len(numbers)


def test_a_chunk_ends_between_two_surfaces_where_that_fits() -> None:
    slices = surface_slices(np.array([0, 55, 45]))
    with mock.patch("autocolor.visibility.visible_points.PIXELS_AT_ONCE", 60):
        assert [chunk.pixels for chunk in point_chunks(slices)] == [slice(0, 55), slice(55, 100)]
    with mock.patch("autocolor.visibility.visible_points.PIXELS_AT_ONCE", 50):
        assert [chunk.pixels for chunk in point_chunks(slices)] == [slice(0, 50), slice(50, 100)]


@given(st.integers(0, 20), st.integers(0, 1 << 32))
def test_each_vector_is_followed_by_its_dot_product_with_the_point(count: int, seed: int) -> None:
    rows = np.random.default_rng(seed).uniform(-1, 1, (ROW_COUNT, count)).astype(np.float32)
    vectors = rows.copy()
    fill_point_products(rows)
    for first in (0, 4, 8):
        assert rows[first : first + 3].tobytes() == vectors[first : first + 3].tobytes()
        expected = (rows[first : first + 3].astype(np.float64) * rows[POINT]).sum(axis=0)
        assert rows[first + 3] == pytest.approx(expected, abs=1e-6)


@given(outside_views(), vectors())
def test_camera_points_and_directions_are_those_of_the_rows(view: View, direction: Vector) -> None:
    points = visible_surfaces(sphere(12, 8), view, (1,), 9, 12)
    for number, (point, normal) in enumerate(zip(points.world_points, points.world_normals, strict=True)):
        assert points.camera_point(tuple(point.tolist())) == pytest.approx(
            points.rows[POINT, number], abs=1e-6
        )
        in_camera = points.camera_direction(tuple(normal.tolist()))
        assert in_camera == pytest.approx(points.rows[NORMAL, number], abs=1e-6)
    assert np.linalg.norm(points.camera_direction(direction)) == pytest.approx(np.linalg.norm(direction))


@given(outside_views())
def test_a_world_coordinate_is_a_product_with_the_point_and_1(view: View) -> None:
    points = visible_surfaces(sphere(12, 8), view, (1,), 9, 12)
    for axis in range(3):
        factors = points.world_coordinate(axis)
        in_units = factors[:3] @ points.rows[POINT] + factors[3]
        assert in_units * points.unit == pytest.approx(points.world_points[:, axis], abs=1e-5)


@given(meshes(), outside_views())
def test_every_pixel_has_a_polygon_of_the_surface_of_its_slice(mesh: Mesh, view: View) -> None:
    points = visible_surfaces(mesh, view, (2, 1), 9, 12)
    assert len(points.polygon_numbers) == len(points.pixels)
    for surface in points.slices:
        parts = mesh.part_numbers[points.polygon_numbers[surface.pixels]]
        assert {(2, 1)[part] for part in parts.tolist()} == {surface.surface_number}


def test_the_radius_is_the_distance_of_the_farthest_point_from_the_middle() -> None:
    points = visible_surfaces(cube(2.0), View((4, -5, 6), target=(1, 1, 1)), (1,), 200, 200)
    # The middle of the cube is the middle of its bounding box; a corner is the square root of 3 away.
    assert points.radius * points.unit == pytest.approx(3**0.5, rel=0.02)
    farthest = np.linalg.norm(points.world_points - 1, axis=1).max()
    assert points.radius * points.unit == pytest.approx(farthest, rel=1e-6)
