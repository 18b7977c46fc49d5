from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.checks import Vector
from autocolor.errors import InputError
from autocolor.scene.geometry import diagonals as module
from autocolor.scene.geometry import polygon_split
from autocolor.scene.geometry.diagonals import NO_DIAGONAL, quad_diagonals
from autocolor.scene.geometry.polygon_split import clipped_ears, split_polygons
from autocolor.testing import meshes
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.small import grid

DART = [(0.0, 0.0, 0.0), (2.0, 5.0, 0.0), (4.0, 0.0, 0.0), (2.0, 1.0, 0.0)]
SQUARE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
LONG = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (3.0, 1.0, 0.0), (2.0, 1.0, 0.0)]
STRAIGHT = [(0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (6.0, 0.0, 0.0), (3.0, 20.0, 0.0)]


def ends_and_warp(corners: list[Vector], polygon: list[int]) -> tuple[set[int], float]:
    """The nodes at the ends of the diagonal of one quad, and its warp."""
    (start,), (warp,) = Mesh(np.array(corners), np.array([polygon])).diagonals
    return {polygon[int(start)], polygon[int(start) + 2]}, float(warp)


@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize(
    ("corners", "ends", "convex"),
    [
        (DART, {1, 3}, False),
        (LONG, {1, 3}, True),
        # The shorter diagonal would leave a triangle without area.
        (STRAIGHT, {1, 3}, False),
        # Equally long: through the lowest node, in spite of the last digits.
        (SQUARE, {0, 2}, True),
        ([*SQUARE[:2], (1.0 + 1e-9, 1.0, 0.0), SQUARE[3]], {0, 2}, True),
        ([SQUARE[0], (1.0 + 1e-9, 0.0, 0.0), *SQUARE[2:]], {0, 2}, True),
    ],
)
def test_the_diagonal_lies_inside_and_is_the_shorter_one(
    corners: list[Vector], ends: set[int], convex: bool, turn: int, backward: bool
) -> None:
    polygon = np.roll([0, 1, 2, 3], turn)[:: -1 if backward else 1].tolist()
    assert ends_and_warp(corners, polygon) == (ends, 0 if convex else np.inf)


@pytest.mark.parametrize("size", [1e-30, 1.0, 1e30])
def test_the_warp_is_the_distance_between_the_diagonals(size: float) -> None:
    warped = [(x * size, y * size, z * size) for x, y, z in [*SQUARE[:2], (1.0, 1.0, 0.0), (0.0, 1.0, 0.1)]]
    (_,), (warp,) = Mesh(np.array(warped), np.array([[0, 1, 2, 3]])).diagonals
    # The lines from (0, 0, 0) along (1, 1, 0), and from (1, 0, 0) along (-1, 1, 0.1).
    normal = np.cross((1, 1, 0), (-1, 1, 0.1))
    assert warp == pytest.approx(size * abs(normal[0]) / np.linalg.norm(normal), rel=1e-6)


@pytest.mark.parametrize("place", range(4))
def test_a_triangle_is_not_cut_whichever_node_it_repeats(place: int) -> None:
    polygon = np.roll([0, 1, 2, 2], place)
    (start,), (warp,) = Mesh(np.array(SQUARE), polygon[None]).diagonals
    # Without a diagonal, it is the triangle of the first three corners.
    assert start == (NO_DIAGONAL if place < 2 else 0)
    halves = (
        [[0, 1, 2]]
        if start == NO_DIAGONAL
        else [[start, start + 1, start + 2], [start + 2, start + 3, start]]
    )
    assert [len({int(polygon[corner % 4]) for corner in half}) for half in halves].count(3) == 1
    assert warp == 0


def test_a_regular_grid_is_cut_in_one_direction() -> None:
    mesh = grid(9, 7, (-1, 0.1, -1), (2, 0.3, 0), (-0.3 / 7, 2 / 7, 0.7))
    assert len(set(mesh.diagonals.starts.tolist())) == 1


@given(meshes())
def test_diagonals_do_not_depend_on_the_chunks(mesh: Mesh) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "POLYGONS_AT_ONCE", 2)
        in_chunks = quad_diagonals(mesh.coordinates, mesh.node_numbers)
    assert in_chunks.starts.tolist() == mesh.diagonals.starts.tolist()
    assert in_chunks.warps.tolist() == mesh.diagonals.warps.tolist()


def area(points: np.ndarray, rows: object) -> float:
    """Twice the signed area of a polygon in the plane z = 0."""
    corners = points[np.asarray(rows)]
    x, y = corners[:, 0], corners[:, 1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def test_triangles_and_quads_stay_whole_and_pieces_take_the_place_of_their_polygon() -> None:
    turns = np.arange(6) * math.pi / 3
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    corners = [0, 1, 2, 5, 4, 0, 1, 2, 3, 4, 5, 5, 4, 3, 2]
    pieces, owners, *_ = split_polygons(points, np.array(corners), np.array([3, 2, 6, 0, 4]))
    # A polygon of fewer than three corners has no piece.
    assert owners.tolist() == [0, 2, 2, 4]
    assert pieces[[0, 3]].tolist() == [[0, 1, 2, 2], [5, 4, 3, 2]]


@pytest.mark.parametrize("count", [5, 6, 7, 20])
def test_a_convex_polygon_becomes_quads_and_at_most_one_triangle(count: int) -> None:
    turns = np.arange(count) * 2 * math.pi / count
    points = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    pieces, *_ = split_polygons(points, np.arange(count), np.array([count]))
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
    pieces, *_ = split_polygons(points[:, axes], np.arange(len(radii)), np.array([len(radii)]))
    areas = [area(points, piece) for piece in pieces]
    assert min(areas) >= -1e-9
    assert sum(areas) == pytest.approx(area(points, range(len(radii))))


def test_polygons_of_a_count_are_clipped_alike_however_many_are_worked_on_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(3)
    radii, turns = random.uniform(0.3, 1, (7, 9)), np.arange(9) * 2 * math.pi / 9
    points = np.stack([radii * np.cos(turns), radii * np.sin(turns), 0 * radii], axis=2).reshape(-1, 3)
    polygons = (points, np.arange(63), np.full(7, 9))
    at_once = split_polygons(*polygons)
    monkeypatch.setattr(polygon_split, "PAIRS_AT_ONCE", 170)
    in_chunks = split_polygons(*polygons)
    assert in_chunks.corners.tolist() == at_once.corners.tolist()
    assert in_chunks.owners.tolist() == at_once.owners.tolist()


@given(st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=5, max_size=30))
def test_clipping_ends_whatever_crosses(points: list[tuple[float, float]]) -> None:
    (pieces,) = clipped_ears(np.array([points], np.float64))
    assert len(pieces) == len(points) - 3
    assert set(pieces.ravel().tolist()) == set(range(len(points)))


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


TENTH = math.pi / 10
PENTAGRAM = [(math.cos(8 * turn * TENTH), math.sin(8 * turn * TENTH)) for turn in range(5)]
# The points of a regular pentagram of radius 1, without the pentagon between them.
NOTCH = math.sin(TENTH) / math.cos(2 * TENTH)
TIPS = 5 * NOTCH * math.sin(2 * TENTH) - 2.5 * NOTCH**2 * math.sin(4 * TENTH)

CROSSED = [
    ("a bow-tie that cancels", [(0, 0), (1, 1), (1, 0), (0, 1)], 1 / 2),
    ("a bow-tie", [(0, 0), (1, 1), (1, 0), (0, 0.5)], 5 / 12),
    ("a pentagram", PENTAGRAM, TIPS),
    ("two rectangles that touch at a crossing", [(0, 0), (2, 0), (2, 2), (1, 2), (1, -1), (0, -1)], 3),
]


each_crossed = pytest.mark.parametrize(
    ("outline", "filled"), [case[1:] for case in CROSSED], ids=[case[0] for case in CROSSED]
)


@each_crossed
@pytest.mark.parametrize("turned", [False, True])
def test_a_polygon_whose_sides_cross_is_split_into_its_even_odd_regions(
    outline: list[tuple[float, float]], filled: float, turned: bool
) -> None:
    points = np.array([(0.5, 9, 9), *((x, y, 0) for x, y in outline)])
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0] if turned else np.eye(3)
    square, crossed = [0, 1, 2], range(1, len(points))
    pieces, owners, added, rows = split_polygons(
        points @ turn, np.array([*square, *crossed]), np.array([3, len(outline)])
    )
    assert rows.tolist() == [1]
    assert pieces[owners == 0].tolist() == [[0, 1, 2, 2]]
    flat = np.concatenate([points, added.between(points)])
    assert flat[1:, 2] == pytest.approx(0)
    areas = np.array([area(flat, piece) for piece in pieces[owners == 1]])
    assert (areas > 0).all() or (areas < 0).all()
    assert np.abs(areas).sum() / 2 == pytest.approx(filled)


def test_sides_that_cross_too_often_are_refused() -> None:
    turns = np.arange(301) * 300 * math.pi / 301
    star = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    with pytest.raises(InputError) as caught:
        split_polygons(star, np.arange(301), np.array([301]))
    assert str(caught.value) == (
        "the sides of a polygon must cross less often, not 44,849 times; split it into triangles"
    )


@pytest.mark.parametrize("interpolation", ["scan line", "invariant"])
@each_crossed
def test_a_polygon_whose_sides_cross_is_filled_even_odd_however_it_is_turned(
    outline: list[tuple[float, float]], filled: float, interpolation: str
) -> None:
    nodes = [(x, y, 0.0) for x, y in outline]
    mesh = Mesh.of(nodes, [list(range(len(nodes)))])
    for angle in (10.0, 30.0, 75.0):
        view = View((0.5, 0.5, 10.0), target=(0.5, 0.5, 0.0), field_of_view=24.0, angle=angle)
        points = visible_surfaces(mesh, view, (1,), 480, 640, interpolation=interpolation)
        pixel = 2 * 10 * math.tan(math.radians(12)) / 480
        assert len(points.pixels) * pixel**2 == pytest.approx(filled, rel=0.01)
