from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.visibility.edges import DOWN_SIDE, UP_SIDE, Edges, Side, edges_of_sides, other_end
from autocolor.visibility.projection import Projection, projection
from tests.autocolor.strategies import meshes, outside_views, rasters, views

SIDES: tuple[Side, ...] = (DOWN_SIDE, UP_SIDE)


def all_edges(projected: Projection, side: Side) -> Edges:
    return edges_of_sides(projected, np.arange(projected.corners.shape[1]))[SIDES.index(side)]


@given(meshes(), views() | outside_views(), rasters)
def test_the_edges_of_both_sides_cut_the_same_lines_of_the_same_polygons(
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
        cut = all_edges(projected, side)
        assert expected == [
            (top % polygons, line)
            for top, first, count in zip(cut.top, cut.first_line, cut.count, strict=True)
            for line in range(first, first + count)
        ]
        assert other_end(projected, cut.top, side).tolist() == cut.bottom.tolist()
        assert len(expected) == projected.first_crossing[-1]


@given(meshes(), views() | outside_views(), rasters)
def test_an_edge_is_cut_where_the_lines_cross_it(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    corners = projected.corners.ravel()
    for cut in (all_edges(projected, side) for side in SIDES):
        for row in range(len(cut.top)):
            a, b = corners[cut.top[row]], corners[cut.bottom[row]]
            assert projected.down[a] <= projected.down[b]
            assert cut.count[row] > 0
            span = abs(projected.across[b] - projected.across[a])
            depths = projected.inverse_depth[[a, b]]
            for step in (0, int(cut.count[row]) - 1):
                center = cut.first_line[row] + step + 0.5
                assert projected.down[a] <= center <= projected.down[b]
                way = (center - projected.down[a]) / (projected.down[b] - projected.down[a])
                place = projected.across[a] + way * (projected.across[b] - projected.across[a])
                depth = depths[0] + way * (depths[1] - depths[0])
                assert cut.across[row] + step * cut.across_step[row] == pytest.approx(
                    place, abs=1e-9 * (1 + span)
                )
                assert cut.inverse_depth[row] + step * cut.inverse_depth_step[row] == pytest.approx(
                    depth, abs=1e-9 * depths.max()
                )


@given(meshes(), outside_views(), rasters)
def test_an_edge_is_cut_alike_whichever_way_its_polygon_runs(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    # Triangles only: a quad that must be cut in two may be cut along its other diagonal.
    mesh = Mesh(mesh.coordinates, mesh.node_numbers[:, :3], mesh.part_numbers, mesh.part_names)
    backward = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], mesh.part_numbers, mesh.part_names)
    cuts = []
    for each in (mesh, backward):
        projected = projection(each, view, *raster)
        cuts.append(
            {
                row
                for side in SIDES
                for cut in [all_edges(projected, side)]
                for row in zip(
                    *(cut.first_line, cut.count, cut.across, cut.across_step, cut.inverse_depth), strict=True
                )
            }
        )
    assert cuts[0] == cuts[1]
