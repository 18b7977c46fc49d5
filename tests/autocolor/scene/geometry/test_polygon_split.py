from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.scene.geometry import polygon_split
from autocolor.scene.geometry.polygon_split import clipped_ears, split_polygons


def area(points: np.ndarray, rows: object) -> float:
    """Twice the signed area of a polygon in the plane z = 0."""
    corners = points[np.asarray(rows)]
    x, y = corners[:, 0], corners[:, 1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def test_triangles_and_quads_stay_whole_and_pieces_take_the_place_of_their_polygon() -> None:
    turns = np.arange(6) * math.pi / 3
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    corners = [0, 1, 2, 5, 4, 0, 1, 2, 3, 4, 5, 5, 4, 3, 2]
    pieces, owners = split_polygons(points, np.array(corners), np.array([3, 2, 6, 0, 4]))
    # A polygon of fewer than three corners has no piece.
    assert owners.tolist() == [0, 2, 2, 4]
    assert pieces[[0, 3]].tolist() == [[0, 1, 2, 2], [5, 4, 3, 2]]


@pytest.mark.parametrize("count", [5, 6, 7, 20])
def test_a_convex_polygon_becomes_quads_and_at_most_one_triangle(count: int) -> None:
    turns = np.arange(count) * 2 * math.pi / count
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    pieces, _ = split_polygons(points, np.arange(count), np.array([count]))
    assert len(pieces) == (count - 1) // 2
    assert (pieces[:, 2] == pieces[:, 3]).sum() == count % 2
    assert sum(area(points, piece) for piece in pieces) == pytest.approx(area(points, range(count)))


@given(
    st.lists(st.integers(1, 20), min_size=5, max_size=24),
    st.sampled_from([(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1)]),
)
def test_a_star_shaped_polygon_is_covered_once_in_any_plane(
    radii: list[int], axes: tuple[int, int, int]
) -> None:
    turns = np.arange(len(radii)) * 2 * math.pi / len(radii)
    points = np.stack([radii * np.cos(turns), radii * np.sin(turns), 0 * turns], axis=1)
    pieces, _ = split_polygons(points[:, axes], np.arange(len(radii)), np.array([len(radii)]))
    areas = [area(points, piece) for piece in pieces]
    assert min(areas) >= -1e-9
    assert sum(areas) == pytest.approx(area(points, range(len(radii))))


@given(st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=5, max_size=30))
def test_clipping_ends_whatever_crosses(points: list[tuple[float, float]]) -> None:
    pieces = clipped_ears(points)
    assert len(pieces) == len(points) - 3
    assert {row for piece in pieces for row in piece} == set(range(len(points)))


def test_clipping_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(polygon_split, "MOST_CLIPPING", 10)
    notched = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 1, 0], [0, 2, 0]], np.float64)
    split_polygons(notched, np.tile(np.arange(5), 2), np.array([5, 5]))
    with pytest.raises(InputError) as caught:
        split_polygons(notched, np.tile(np.arange(5), 3), np.array([5, 5, 5]))
    assert str(caught.value) == (
        "there must be fewer polygons with reflex corners, not so many with 5 corners; split them into"
        " triangles"
    )
