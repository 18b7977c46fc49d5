"""Points, normals and no cracks."""

from __future__ import annotations

import math
from unittest import mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.visible_points import (
    NORMAL,
    POINT,
    POINT_SQUARED,
    REFLECTED_VIEW,
    point_chunks,
    surface_slices,
)
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.meshes import cube, grid, sphere
from tests.autocolor.reference import ray
from tests.autocolor.strategies import Vector, directions, meshes, numbers, rasters, vectors, views


@pytest.mark.parametrize("mesh", [cube(4), sphere(12, 8, 2.0), cube(4e-15), sphere(12, 8, 2e15)], ids=repr)
@given(st.data())
def test_a_closed_mesh_has_no_crack_from_within(mesh: Mesh, data: st.DataObject) -> None:
    low, high = mesh.bounds
    middle, size = (low + high) / 2, (high - low)[0]
    place = np.array(data.draw(vectors(numbers(-0.2, 0.2))))
    view = View(
        tuple((middle + place * size).tolist()),
        direction=data.draw(directions),
        field_of_view=data.draw(st.sampled_from([20.0, 60.0, 120.0])),
    )
    lines, elements = data.draw(rasters)
    points = visible_surfaces(mesh, view, (1,), lines, elements)
    assert sorted(points.pixels.tolist()) == list(range(lines * elements))


@given(st.integers(0, 1 << 32), st.integers(1, 30))
def test_a_wall_of_uneven_polygons_has_no_crack(seed: int, lines: int) -> None:
    flat = grid(6, 5, (-3, 0, -3), (6, 0, 0), (0, 0, 6))
    moved = flat.coordinates.copy()
    inner = (np.abs(moved[:, 0]) < 2.9) & (np.abs(moved[:, 2]) < 2.9)
    moved[inner] += np.random.default_rng(seed).uniform(-0.3, 0.3, (inner.sum(), 3))
    uneven = Mesh(moved, flat.node_numbers, flat.part_numbers, flat.part_names)
    view = View((0.1, -4.0, 0.2), target=(0.0, 0.0, 0.0), field_of_view=30.0)
    points = visible_surfaces(uneven, view, (1,), lines, lines)
    assert len(points.pixels) == lines * lines


def test_every_pixel_whose_center_is_inside_is_covered_and_no_other() -> None:
    # The eye is as far as the lens is long: one unit of the plane is one pixel.
    lines = elements = 8
    view = View((4.0, -4 / math.tan(math.radians(15)), 4.0), direction=(0.0, 1.0, 0.0), field_of_view=30.0)
    for left, right, bottom, top in ((1.4, 4.6, 2.4, 5.6), (1.6, 4.4, 2.6, 5.4), (0.0, 8.0, 0.0, 8.0)):
        panel = grid(1, 1, (left, 0, bottom), (right - left, 0, 0), (0, 0, top - bottom))
        points = visible_surfaces(panel, view, (1,), lines, elements)
        inside = [
            line * elements + element
            for line in range(lines)
            for element in range(elements)
            if left < element + 0.5 < right and bottom < lines - line - 0.5 < top
        ]
        assert sorted(points.pixels.tolist()) == inside


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


@given(st.lists(st.integers(1, 40), max_size=6), st.integers(1, 50))
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
