from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.depth import DepthScale, depth_scale, polygons_of_numbers
from autocolor.visibility.extents import extents_of_polygons
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.segments import Segments, segments_of_polygons
from tests.autocolor.strategies import meshes, outside_views, rasters, views
from tests.autocolor.visibility.test_extents import extent_on


def all_segments(mesh: Mesh, view: View, raster: tuple[int, int]) -> tuple[Projection, DepthScale, Segments]:
    projected = projection(mesh, view, *raster)
    scale = depth_scale(projected)
    return projected, scale, segments_of_polygons(projected, scale, np.arange(projected.corners.shape[1]))


def places(projected: Projection, segments: Segments) -> list[tuple[int, int]]:
    """The polygon and the line of each segment."""
    polygons = polygons_of_numbers(projected, segments.number)
    return list(zip(polygons.tolist(), (segments.first_pixel // projected.elements).tolist(), strict=True))


@given(meshes(), views() | outside_views(), rasters)
def test_the_segments_are_the_extents_of_the_polygons(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected, _, segments = all_segments(mesh, view, raster)
    polygons = np.arange(projected.corners.shape[1])
    extents = extents_of_polygons(projected, polygons)
    rows = zip(extents.row.tolist(), extents.line.tolist(), strict=True)
    assert places(projected, segments) == list(rows)
    assert (segments.first_pixel % raster[1]).tolist() == extents.first.tolist()
    assert segments.count.tolist() == extents.count.tolist()


@given(meshes(), outside_views(), rasters)
def test_the_keys_step_along_the_inverse_depth(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected, scale, segments = all_segments(mesh, view, raster)
    for row, (polygon, line) in enumerate(places(projected, segments)):
        element = int(segments.first_pixel[row]) % raster[1]
        (left, left_depth), (right, right_depth) = extent_on(projected, polygon, line)
        if right - left < 1e-3:
            continue
        for k in (0, int(segments.count[row]) - 1):
            fraction = (element + k + 0.5 - left) / (right - left)
            depth = left_depth + fraction * (right_depth - left_depth)
            key = int(segments.start[row]) + k * int(segments.step[row])
            assert key % scale.number_limit == 0
            assert key / scale.number_limit / scale.factor == pytest.approx(depth, rel=1e-6)


@given(meshes(), views(), rasters)
def test_the_segments_of_some_polygons_are_among_those_of_all(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected, scale, segments = all_segments(mesh, view, raster)
    some = np.arange(0, projected.corners.shape[1], 2)
    found = segments_of_polygons(projected, scale, some)
    chosen = polygons_of_numbers(projected, segments.number) % 2 == 0
    for one, other in zip(vars(found).values(), vars(segments).values(), strict=True):
        assert one.tolist() == other[chosen].tolist()


def test_a_rectangle_has_one_segment_on_each_of_its_lines() -> None:
    # The eye is as far as the lens is long: one unit of the plane is one pixel.
    view = View((4.0, -4 / math.tan(math.radians(15)), 4.0), direction=(0.0, 1.0, 0.0), field_of_view=30.0)
    corners = np.array([(1.4, 0, 2.4), (4.6, 0, 2.4), (4.6, 0, 5.6), (1.4, 0, 5.6)])
    panel = Mesh(corners, np.array([[0, 1, 2, 3]]), np.array([0]), ("panel",))
    _, _, segments = all_segments(panel, view, (8, 8))
    # Lines run downward from the top at 8.
    assert segments.first_pixel.tolist() == [8 * line + 1 for line in (2, 3, 4, 5)]
    assert segments.count.tolist() == [4, 4, 4, 4]
    assert segments.number.tolist() == [2] * 4
