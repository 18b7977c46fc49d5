"""Interpolation along visible spans, where a polygon is edge-on or reaches far outside the picture."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.depth import depth_scale, polygons_of_numbers
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_spans import DEPTH, POINTS, RAY, along_spans, visible_spans
from autocolor.visibility.visible_surfaces import depth_test, visible_surfaces
from autocolor.visibility.watkins import watkins
from tests.autocolor.strategies import meshes, numbers, outside_views, rasters, views

tenths = st.integers(-20, 20).map(lambda number: number / 10)


def panel(*corners: tuple[float, float, float]) -> Mesh:
    return Mesh(np.array(corners), np.array([[0, 1, 2, 3]]), np.array([0]), ("panel",))


@given(tenths, tenths, tenths, st.integers(1, 30).map(lambda number: number / 10))
def test_the_points_of_an_edge_on_board_are_on_the_board(
    x: float, first: float, low: float, size: float
) -> None:
    mesh = panel(
        (x, first, low),
        (x, first + size, low),
        (x, first + size, low + size),
        (x, first, low + size),
    )
    for eye in ((x, first - 3.0, low + 0.3), (x + 1e-9, first - 3.0, low + 0.3)):
        points = visible_surfaces(mesh, View(eye, direction=(0, 1, 0), field_of_view=40), (1,), 24, 33)
        assert np.isfinite(points.rows).all()
        on_board = points.world_points
        assert (np.abs(on_board[:, 0] - x) < 1e-3 * size).all()
        assert ((on_board[:, 1] > first - 0.01 * size) & (on_board[:, 1] < first + 1.01 * size)).all()


@pytest.mark.parametrize("beside", [1e-4, 1e-3, 0.1])
@pytest.mark.parametrize("turn", [0.0, 0.3, -0.7])
def test_a_flat_wall_close_beside_the_eye_keeps_its_normal(beside: float, turn: float) -> None:
    wall = panel((beside, -50, -20), (beside, 70, -20), (beside, 70, 20), (beside, -50, 20))
    view = View((0.0, 0.0, 0.0), direction=(turn, 1.0, 0.1), field_of_view=60)
    normals = visible_surfaces(wall, view, (1,), 48, 64).world_normals
    assert len(normals)
    assert normals == pytest.approx(np.tile([-1.0, 0.0, 0.0], (len(normals), 1)), abs=1e-5)


@given(numbers(-1, 1), numbers(0.1, 1), numbers(-1, 1), numbers(-0.5, 0.5), st.integers(0, 3))
def test_of_coincident_polygons_of_opposite_winding_the_one_that_faces_the_eye_is_visible(
    left: float, width: float, slope: float, twist: float, first: int
) -> None:
    corners = [
        (left, slope, -0.7),
        (left + width, -slope, -0.6),
        (left + width, -slope + twist, 0.5),
        (left, slope, 0.8),
    ]
    backward = np.roll([3, 2, 1, 0], first)
    view = View((0.3, -4.0, 0.2), target=(0.1, 0.0, 0.0), field_of_view=40)
    for quads in ([[0, 1, 2, 3], backward], [backward, [0, 1, 2, 3]]):
        mesh = Mesh(np.array(corners), np.array(quads), np.array([0, 1]), ("one", "other"))
        projected = projection(mesh, view, 40, 53)
        facing = set(projected.polygon_numbers[~projected.from_behind].tolist())
        for algorithm in (visible_surfaces, watkins):
            assert set(algorithm(mesh, view, (1, 2), 40, 53).polygon_numbers.tolist()) <= facing


@given(meshes(), views() | outside_views(), rasters)
def test_spans_are_the_runs_of_pixels_of_a_line_at_which_one_polygon_is_visible(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected = projection(mesh, view, *raster)
    scale = depth_scale(projected)
    number_at_pixel = np.zeros(raster[0] * raster[1], np.int64)
    depth_test(number_at_pixel, projected, scale, np.arange(projected.corners.shape[1]))
    number_at_pixel &= scale.number_limit - 1
    spans = visible_spans(projected, number_at_pixel, (2, 1))

    expected = []
    pixel = 0
    on_lines = ((number, place // raster[1]) for place, number in enumerate(number_at_pixel.tolist()))
    for (number, _), run in itertools.groupby(on_lines):
        count = len(list(run))
        if number:
            (polygon,) = polygons_of_numbers(projected, np.array([number])).tolist()
            row = int(projected.polygon_numbers[polygon])
            surface = (2, 1)[mesh.part_numbers[row]]
            expected.append((pixel, count, polygon, row, surface))
        pixel += count
    found = list(zip(*(table.tolist() for table in vars(spans).values()), strict=True))
    assert sorted(found) == expected
    assert (np.diff(spans.surface.astype(int)) >= 0).all()
    # Within a surface the spans of a polygon follow each other.
    pairs = list(itertools.groupby(zip(spans.surface.tolist(), spans.polygon.tolist(), strict=True)))
    assert len(pairs) == len({pair for pair, _ in pairs})

    # At the first pixel of a span the point is the ray over the inverse depth.
    start, step = along_spans(projected, spans)
    assert start.dtype == step.dtype == np.float32
    depth = 1 / start[DEPTH].astype(np.float64)
    in_camera = start[POINTS] + projected.middle[:, None]
    assert in_camera == pytest.approx(start[RAY] * depth, rel=1e-5, abs=1e-6)


def test_a_segment_that_another_divides_is_visible_in_two_spans() -> None:
    far = [(-2.0, 1.0, -1.0), (2.0, 1.0, -1.0), (2.0, 1.0, 1.0), (-2.0, 1.0, 1.0)]
    near = [(-0.2, 0.0, -1.0), (0.2, 0.0, -1.0), (0.2, 0.0, 1.0), (-0.2, 0.0, 1.0)]
    mesh = Mesh(np.array(far + near), np.arange(8).reshape(2, 4), np.array([0, 1]), ("far", "near"))
    view = View((0.0, -4.0, 0.0), direction=(0, 1, 0), field_of_view=20)
    points = visible_surfaces(mesh, view, (1, 2), 10, 20)
    # Twenty spans of the far wall, two on each line, and ten of the near one.
    assert points.span_polygons.tolist() == [0] * 20 + [1] * 10
    assert sum(points.span_lengths) == len(points.pixels)
