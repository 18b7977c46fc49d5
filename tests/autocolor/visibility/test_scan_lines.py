from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.scan_lines import (
    DOWN_SIDE,
    UP_SIDE,
    Edges,
    Side,
    edges_of_sides,
    edges_on_lines,
    extents_of_polygons,
)
from tests.autocolor.strategies import rasters


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
def test_an_extent_covers_the_centers_between_two_crossings(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected = projection(mesh, view, *raster)
    extents = extents_of_polygons(projected, np.arange(projected.corners.shape[1]))
    places = zip(extents.row.tolist(), extents.line.tolist(), strict=True)
    pixels = zip(extents.first.tolist(), extents.count.tolist(), strict=True)
    found = dict(zip(places, pixels, strict=True))
    for polygon in range(projected.corners.shape[1]):
        lines = projected.first_line[projected.corners[:, polygon]]
        for line in range(lines.min(), lines.max()):
            (left, _), (right, _) = extent_on(projected, polygon, line)
            centers = [element for element in range(raster[1]) if left <= element + 0.5 < right]
            clear = min(abs(x - 0.5 - round(x - 0.5)) for x in (left, right)) > 1e-6 * max(
                1, abs(left), abs(right)
            )
            if clear and centers:
                assert found[polygon, line] == (centers[0], len(centers))
            elif clear:
                assert (polygon, line) not in found
    assert len(found) == len(extents.row)


@given(meshes(), outside_views(), rasters)
def test_the_inverse_depth_steps_along_the_extent(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    extents = extents_of_polygons(projected, np.arange(projected.corners.shape[1]))
    for row, polygon in enumerate(extents.row.tolist()):
        (left, left_depth), (right, right_depth) = extent_on(projected, polygon, int(extents.line[row]))
        if right - left < 1e-3:
            continue
        for step in (0, int(extents.count[row]) - 1):
            fraction = (int(extents.first[row]) + step + 0.5 - left) / (right - left)
            expected = left_depth + fraction * (right_depth - left_depth)
            assert extents.start[row] + step * extents.step[row] == pytest.approx(expected, rel=1e-6)


@given(meshes(), outside_views(), rasters)
def test_polygons_of_opposite_winding_have_the_same_extents(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    rows = []
    for numbers in (mesh.node_numbers, mesh.node_numbers[:, ::-1]):
        turned = Mesh(mesh.coordinates, numbers, mesh.part_numbers, mesh.part_names)
        projected = projection(turned, view, *raster)
        extents = extents_of_polygons(projected, np.arange(projected.corners.shape[1]))
        rows.append([table.tolist() for table in vars(extents).values()])
    assert rows[0] == rows[1]


SIDES: tuple[Side, ...] = (DOWN_SIDE, UP_SIDE)


def all_edges(projected: Projection, side: Side) -> Edges:
    return edges_of_sides(projected, np.arange(projected.corners.shape[1]))[SIDES.index(side)]


@given(meshes(), views() | outside_views(), rasters)
def test_the_edges_of_both_sides_cross_the_same_lines_of_the_same_polygons(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected = projection(mesh, view, *raster)
    polygons = projected.corners.shape[1]
    expected = [
        (polygon, line)
        for polygon, lines in enumerate(projected.first_line[projected.corners].T.tolist())
        for line in range(min(lines), max(lines))
    ]
    for side in SIDES:
        found = all_edges(projected, side)
        assert expected == [
            (top % polygons, line)
            for top, first, count in zip(found.top, found.first_line, found.count, strict=True)
            for line in range(first, first + count)
        ]
        # Each line finds its edge again.
        row = np.repeat(np.arange(len(found.top)), found.count)
        numbers, lines = np.array(expected, np.intp).reshape(-1, 2).T
        top, bottom = edges_on_lines(projected, numbers, lines, side)
        assert top.tolist() == found.top[row].tolist()
        assert bottom.tolist() == found.bottom[row].tolist()
    assert len(expected) == projected.line_counts.sum()


@given(meshes(), views() | outside_views(), rasters)
def test_an_edge_steps_along_its_own_line(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    corners = projected.corners.ravel()
    for found in (all_edges(projected, side) for side in SIDES):
        for row in range(len(found.top)):
            a, b = corners[found.top[row]], corners[found.bottom[row]]
            assert projected.y[a] <= projected.y[b]
            assert found.count[row] > 0
            width = abs(projected.x[b] - projected.x[a])
            depths = projected.inverse_depth[[a, b]]
            for step in (0, int(found.count[row]) - 1):
                center = found.first_line[row] + step + 0.5
                assert projected.y[a] <= center <= projected.y[b]
                fraction = (center - projected.y[a]) / (projected.y[b] - projected.y[a])
                x = projected.x[a] + fraction * (projected.x[b] - projected.x[a])
                depth = depths[0] + fraction * (depths[1] - depths[0])
                assert found.x[row] + step * found.x_step[row] == pytest.approx(x, abs=1e-9 * (1 + width))
                assert found.inverse_depth[row] + step * found.inverse_depth_step[row] == pytest.approx(
                    depth, abs=1e-9 * depths.max()
                )


@given(meshes(), outside_views(), rasters)
def test_an_edge_has_the_same_crossings_whichever_way_its_polygon_runs(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    # Triangles only: a quad that must be split may be split along its other diagonal.
    mesh = Mesh(mesh.coordinates, mesh.node_numbers[:, :3], mesh.part_numbers, mesh.part_names)
    backward = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], mesh.part_numbers, mesh.part_names)
    crossings = []
    for each in (mesh, backward):
        projected = projection(each, view, *raster)
        crossings.append(
            {
                row
                for side in SIDES
                for found in [all_edges(projected, side)]
                for row in zip(
                    *(found.first_line, found.count, found.x, found.x_step, found.inverse_depth), strict=True
                )
            }
        )
    assert crossings[0] == crossings[1]
