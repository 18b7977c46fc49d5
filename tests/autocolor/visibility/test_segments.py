from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.depth import DepthScale, depth_scale, polygons_of_numbers
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.segments import Segments, segments_of_polygons
from tests.autocolor.strategies import meshes, outside_views, rasters, views


def all_segments(mesh: Mesh, view: View, raster: tuple[int, int]) -> tuple[Projection, DepthScale, Segments]:
    projected = projection(mesh, view, *raster)
    scale = depth_scale(projected)
    return projected, scale, segments_of_polygons(projected, scale, np.arange(projected.corners.shape[1]))


def places(projected: Projection, segments: Segments) -> list[tuple[int, int]]:
    """The polygon and the line of each segment."""
    polygons = polygons_of_numbers(projected, segments.number)
    return list(zip(polygons.tolist(), (segments.first_pixel // projected.elements).tolist(), strict=True))


def extent_on(projected: Projection, polygon: int, line: int) -> list[tuple[float, float]]:
    """Screen x and inverse depth where a line crosses the polygon's outline, from left to right."""
    crossings = []
    corners = projected.corners[:, polygon].tolist()
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        if (projected.first_line[a] <= line) != (projected.first_line[b] <= line):
            fraction = (line + 0.5 - projected.y[a]) / (projected.y[b] - projected.y[a])
            crossings.append(
                tuple(
                    float(table[a] + fraction * (table[b] - table[a]))
                    for table in (projected.x, projected.inverse_depth)
                )
            )
    return sorted(crossings)  # type: ignore[arg-type]


@given(meshes(), views() | outside_views(), rasters)
def test_a_segment_covers_the_centers_between_two_crossings(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected, _, segments = all_segments(mesh, view, raster)
    found = dict(
        zip(
            places(projected, segments),
            zip(segments.first_pixel.tolist(), segments.count.tolist(), strict=True),
            strict=True,
        )
    )
    for polygon in range(projected.corners.shape[1]):
        lines = projected.first_line[projected.corners[:, polygon]]
        for line in range(lines.min(), lines.max()):
            (left, _), (right, _) = extent_on(projected, polygon, line)
            centers = [element for element in range(raster[1]) if left <= element + 0.5 < right]
            clear = min(abs(x - 0.5 - round(x - 0.5)) for x in (left, right)) > 1e-6 * max(
                1, abs(left), abs(right)
            )
            if clear and centers:
                assert found[polygon, line] == (line * raster[1] + centers[0], len(centers))
            elif clear:
                assert (polygon, line) not in found
    assert len(found) == len(segments.number)


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


@given(meshes(), outside_views(), rasters)
def test_polygons_of_opposite_winding_have_the_same_segments(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    # Triangles only: a quad that must be split may be split along its other diagonal.
    rows = []
    for nodes in (mesh.node_numbers[:, :3], mesh.node_numbers[:, 2::-1]):
        turned = Mesh(mesh.coordinates, nodes, mesh.part_numbers, mesh.part_names)
        _, _, segments = all_segments(turned, view, raster)
        tables = (segments.first_pixel, segments.count, segments.start, segments.step)
        rows.append([table.tolist() for table in tables])
    assert rows[0] == rows[1]


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
