from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.scan_lines import (
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
