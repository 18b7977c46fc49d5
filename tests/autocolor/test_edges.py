from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.edges import edges
from autocolor.projection import projection
from tests.autocolor.strategies import meshes, outside_views, rasters, views


@given(meshes(), views() | outside_views(), rasters)
def test_an_edge_is_cut_where_the_lines_cross_it(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    first_lines = projected.first_line[projected.corners]
    numbers = np.flatnonzero(first_lines != np.roll(first_lines, -1, axis=0))
    cut = edges(projected, numbers)
    corners = projected.corners.ravel()
    for row in range(len(numbers)):
        a, b = corners[cut.top[row]], corners[cut.bottom[row]]
        assert projected.down[a] <= projected.down[b]
        assert cut.count[row] > 0
        for step in (0, int(cut.count[row]) - 1):
            center = cut.first_line[row] + step + 0.5
            assert projected.down[a] <= center <= projected.down[b]
            way = (center - projected.down[a]) / (projected.down[b] - projected.down[a])
            span = abs(projected.across[b] - projected.across[a])
            assert cut.across[row] + step * cut.across_step[row] == pytest.approx(
                projected.across[a] + way * (projected.across[b] - projected.across[a]), abs=1e-9 * (1 + span)
            )
            depths = projected.inverse_depth[[a, b]]
            assert cut.inverse_depth[row] + step * cut.inverse_depth_step[row] == pytest.approx(
                depths[0] + way * (depths[1] - depths[0]), abs=1e-9 * depths.max()
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
        first_lines = projected.first_line[projected.corners]
        cut = edges(projected, np.flatnonzero(first_lines != np.roll(first_lines, -1, axis=0)))
        table = np.stack([cut.first_line, cut.count, cut.across, cut.across_step, cut.inverse_depth], axis=1)
        cuts.append({tuple(row) for row in table.tolist()})
    assert cuts[0] == cuts[1]
