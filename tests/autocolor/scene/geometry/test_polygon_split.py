from __future__ import annotations

import math
from typing import Any

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


def test_triangles_and_quads_are_not_split() -> None:
    coordinates = np.random.default_rng(1).uniform(size=(5, 3))
    pieces, owners = split_polygons(coordinates, np.array([0, 1, 2, 3, 2, 1, 0]), np.array([4, 3]))
    assert pieces.tolist() == [[0, 1, 2, 3], [2, 1, 0, 0]]
    assert owners.tolist() == [0, 1]


def test_polygons_with_fewer_than_three_corners_have_no_piece() -> None:
    pieces, owners = split_polygons(np.zeros((3, 3)), np.array([0, 1, 0, 1, 2]), np.array([2, 0, 3]))
    assert pieces.tolist() == [[0, 1, 2, 2]]
    assert owners.tolist() == [2]


@pytest.mark.parametrize("count", [5, 6, 7, 20])
def test_a_convex_polygon_becomes_quads_and_at_most_one_triangle(count: int) -> None:
    turns = np.arange(count) * 2 * math.pi / count
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    pieces, _ = split_polygons(points, np.arange(count), np.array([count]))
    assert len(pieces) == (count - 1) // 2
    assert (pieces[:, 2] == pieces[:, 3]).sum() == count % 2
    assert sum(area(points, piece) for piece in pieces) == pytest.approx(area(points, range(count)))


def test_pieces_take_the_place_of_their_polygon() -> None:
    turns = np.arange(6) * math.pi / 3
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    corners = [0, 1, 2, 0, 1, 2, 3, 4, 5, 3, 4, 5]
    _, owners = split_polygons(points, np.array(corners), np.array([3, 6, 3]))
    assert owners.tolist() == [0, 1, 1, 2]


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


def spiral(count: int) -> list[tuple[float, float]]:
    """A spiral band of four turns: where clipping begins, hardly a corner is an ear."""
    half = count // 2
    turns = np.append(np.arange(half), np.arange(half)[::-1]) * 8 * math.pi / half
    radii = (1 + turns) * np.repeat([1.0, 1.05], half)
    return list(zip((radii * np.cos(turns)).tolist(), (radii * np.sin(turns)).tolist(), strict=True))


def test_hardly_a_corner_is_tested_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    tests = 0
    turn = polygon_split._turn

    def counted(*points: Any) -> Any:
        nonlocal tests
        tests += 1
        return turn(*points)

    monkeypatch.setattr(polygon_split, "_turn", counted)
    assert len(clipped_ears(spiral(300)[::-1])) == 297
    assert tests < 300 * 60


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
