from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.edges import DOWN_SIDE, UP_SIDE, Edges, Side, edges_of_sides, edges_on_lines
from autocolor.visibility.projection import Projection, projection
from tests.autocolor.strategies import meshes, outside_views, rasters, views

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
