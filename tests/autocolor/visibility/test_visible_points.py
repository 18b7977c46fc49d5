from __future__ import annotations

import dataclasses
import math
import pickle
from unittest import mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Mesh, Scene, UsageError, View
from autocolor.checks import Vector
from autocolor.lighting.picking import highlight_placed
from autocolor.rendering import rendering
from autocolor.testing import numbers, outside_views, vectors
from autocolor.visibility.visible_points import (
    NORMAL,
    POINT,
    POINT_SQUARED,
    ROW_COUNT,
    Sight,
    VisibleParts,
    fill_point_products,
    point_chunks,
    seen_at,
    surface_slices,
)
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import first_hit, ray
from tests.autocolor.strategies import soups
from tests.autocolor.twins.point import dot, minus, times, unit
from tests.small import car, cube, grid, sphere, wall_scene
from tests.tables import refused

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
def test_camera_points_and_directions_agree_with_the_rows(view: View, direction: Vector) -> None:
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


def test_the_radius_is_the_distance_of_the_farthest_point_from_the_middle() -> None:
    points = visible_surfaces(cube(2.0), View((4, -5, 6), target=(1, 1, 1)), (1,), 200, 200)
    # The middle of the cube is the middle of its bounding box; a corner is the square root of 3 away.
    assert points.radius * points.unit == pytest.approx(3**0.5, rel=0.02)
    farthest = np.linalg.norm(points.world_points - 1, axis=1).max()
    assert points.radius * points.unit == pytest.approx(farthest, rel=1e-6)


def test_the_points_of_an_ordinary_scene_start_in_the_middle_of_the_object() -> None:
    points = visible_surfaces(sphere(12, 8), View((3, -4, 2), target=(0, 0, 0)), (1,), 9, 12)
    assert not points.starts_nearest
    assert points.world_points + 0.0 == pytest.approx(
        (points.rows[POINT].T * points.unit) @ points.view.axes, abs=1e-6
    )
    assert points.largest_distance.tolist() == [0, 0, 0, points.radius]


@given(outside_views(), numbers(1.0, 8.0), st.booleans())
def test_before_something_large_points_start_at_the_nearest_and_have_a_bound_of_their_distance(
    view: View, power: float, reaches_behind: bool
) -> None:
    size = 10**power
    near = size if reaches_behind else -20.0
    axes = view.axes
    corner = np.array(view.eye) - size * axes[0] + 2 * axes[1] - near * axes[2]
    across, deep = 2 * size * axes[0], (near + 20 + size) * axes[2] + 0.1 * size * axes[1]
    floor = grid(1, 1, tuple(corner.tolist()), tuple(across.tolist()), tuple(deep.tolist()), "floor")
    points = visible_surfaces(Mesh.joined([sphere(12, 8), floor]), view, (1, 1), 24, 32)
    bound = points.largest_distance
    distance = np.sqrt(points.rows[POINT_SQUARED].astype(np.float64))
    assert (distance <= (1 + 1e-6) * (bound[:3] @ points.rows[POINT] + bound[3]) + 1e-12).all()
    assert points.starts_nearest or reaches_behind or power < 4
    if points.starts_nearest:
        depths = (points.world_points - view.eye) @ view.axes[2]
        assert points.origin[2] * points.unit == pytest.approx(depths.min(), rel=1e-4)
        # Every point is exact in proportion to its distance from the eye.
        for pixel, point in zip(points.pixels.tolist(), points.world_points, strict=True):
            direction = np.array(ray(view, 24, 32, *divmod(pixel, 32)))
            depth = float((point - view.eye) @ view.axes[2])
            assert point == pytest.approx(np.array(view.eye) + depth * direction, abs=3e-7 * depth)


RASTER = (9, 12)


def in_parts(mesh: Mesh, count: int) -> Mesh:
    """The mesh with its polygons dealt out to so many parts."""
    numbers = np.arange(len(mesh.node_numbers)) % count
    return Mesh(mesh.coordinates, mesh.node_numbers, numbers, tuple(f"part {each}" for each in range(count)))


@given(soups(), outside_views(), st.integers(1, 4))
def test_the_part_at_a_pixel_belongs_to_the_polygon_that_a_ray_meets_first(
    soup: Mesh, view: View, count: int
) -> None:
    mesh = in_parts(soup, count)
    points = visible_surfaces(mesh, view, (1,) * count, *RASTER)
    numbers = np.zeros(RASTER[0] * RASTER[1], int)
    numbers[points.pixels] = points.parts.numbers
    for pixel, number in enumerate(numbers.tolist()):
        hit = first_hit(mesh, view.eye, ray(view, *RASTER, *divmod(pixel, RASTER[1])))
        if hit.clear > 1e-3 and hit.depth > 1e-3:
            assert number == (0 if hit.polygon < 0 else mesh.part_numbers[hit.polygon] + 1)


def test_a_mesh_may_have_more_parts_than_16_bits_can_count() -> None:
    many = 70_000
    mesh = Mesh(cube().coordinates, cube().node_numbers, np.full(6, many - 1), tuple(map(str, range(many))))
    parts = visible_surfaces(mesh, View((3, -4, 2), target=(0, 0, 0)), (1,) * many, *RASTER).parts
    assert set(parts.numbers.tolist()) == {many}


@given(st.lists(st.integers(1, 3)))
def test_parts_of_points_keep_the_given_numbers(numbers: list[int]) -> None:
    parts = VisibleParts.of_points(("a", "b", "c"), np.array(numbers, np.int32))
    assert parts.numbers.tolist() == numbers


LINES, ELEMENTS = 12, 16


def sight_of(scene: Scene, block: int = 1) -> Sight:
    return Sight(scene, rendering(scene, LINES, ELEMENTS).points, block)


def test_where_the_normals_of_corners_cancel_there_is_a_point_but_no_highlight() -> None:
    sight = sight_of(wall_scene(lights=[Light("key", (1.0, -3.0, 2.0))]))
    rows = sight.points.rows.copy()
    rows[NORMAL] = 0
    canceled = Sight(sight.scene, dataclasses.replace(sight.points, rows=rows))
    seen = seen_at(canceled, LINES // 2, ELEMENTS // 2)
    assert seen is not None
    assert seen.normal == (0.0, 0.0, 0.0)
    assert seen[:4] == (seen_at(sight, LINES // 2, ELEMENTS // 2) or ())[:4]
    with pytest.raises(UsageError, match="a highlight must be placed where the normal faces the eye"):
        highlight_placed(canceled.scene, seen, "key")


def test_all_pixels_of_a_block_see_the_same_and_are_found_in_its_middle() -> None:
    scene = car()
    fine, coarse = sight_of(scene), sight_of(scene, block=4)
    for line, element in ((0, 0), (5, 7), (LINES - 1, ELEMENTS - 1)):
        seen = seen_at(fine, line, element)
        within = [
            seen_at(coarse, 4 * line + down, 4 * element + right) for down in (0, 3) for right in (0, 3)
        ]
        assert within == [seen] * 4
    assert coarse.pixels_of(np.array([0, ELEMENTS + 2])).tolist() == [[2, 2], [6, 10]]
    assert fine.pixels_of(np.array([0, ELEMENTS + 2])).tolist() == [[0, 0], [1, 2]]


def test_every_pixel_has_its_visible_point_polygon_part_and_surface() -> None:
    # Two parts share a surface.
    scene = car().with_part("cube", surface="body")
    sight = sight_of(scene)
    points = sight.points
    tables = (points.polygon_numbers, points.world_points, points.world_normals)
    at_pixel = dict(zip(points.pixels.tolist(), zip(*tables, strict=True), strict=True))
    assert 0 < len(at_pixel) < LINES * ELEMENTS
    surface_of_part = {part.name: part.surface for part in scene.parts}
    for line, element in np.ndindex(LINES, ELEMENTS):
        seen = seen_at(sight, line, element)
        if seen is None:
            assert line * ELEMENTS + element not in at_pixel
            continue
        polygon, point, normal = at_pixel[line * ELEMENTS + element]
        part = scene.mesh.part_names[scene.mesh.part_numbers[polygon]]
        assert (seen.polygon, seen.part, seen.surface) == (polygon, part, surface_of_part[part])
        assert seen.point == pytest.approx(point.tolist(), abs=1e-12)
        assert seen.normal == pytest.approx(normal.tolist(), abs=1e-6)
        assert math.hypot(*seen.normal) == pytest.approx(1.0, abs=1e-12)
        # R = 2 (N.V) N - V.
        to_eye = unit(minus(scene.view.eye, seen.point))
        expected = minus(times(2 * dot(to_eye, seen.normal), seen.normal), to_eye)
        assert seen.reflected_view == pytest.approx(expected, abs=1e-6)


test_a_pixel_outside_is_refused = refused(
    lambda place: seen_at(sight_of(car(), block=2), *place),
    [
        ((-1, 0), "a line must be 0 to 23, not -1; choose another"),
        ((24, 0), "a line must be 0 to 23, not 24; choose another"),
        ((0, 32), "an element must be 0 to 31, not 32; choose another"),
        ((0, True), "an element must be 0 to 31, not true; choose another"),
    ],
    UsageError,
)


def test_part_numbers_are_computed_when_they_are_asked_for_and_read_only_even_if_pickled() -> None:
    view = View((3, -4, 4), target=(0.5, 0.5, 0.5))
    parts = visible_surfaces(in_parts(cube(), 6), view, (1,) * 6, *RASTER).parts
    assert "numbers" not in vars(parts)
    assert set(parts.numbers.tolist()) == {2, 3, 6}
    for each in (parts, pickle.loads(pickle.dumps(parts))):
        arrays = (each.numbers, each.part_of_polygon, each.span_polygons, each.span_lengths)
        assert not any(array.flags.writeable for array in arrays)
        assert each.numbers.tolist() == parts.numbers.tolist()
