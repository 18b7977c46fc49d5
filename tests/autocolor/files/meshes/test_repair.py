from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.repair import (
    FLAT,
    LONGEST_NAME,
    MeshReport,
    Placement,
    RawPolygons,
    _have_area,
    different,
    name_of,
    placed,
    repaired,
)
from autocolor.scene.scalar import MeshScalar
from tests.tables import refused

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [0, 0, 1]]


def mesh_of(
    *polygons: list[int],
    coordinates: Any = SQUARE,
    up: str = "z",
    scalars: tuple[MeshScalar, ...] = (),
    unused_nodes: bool = True,
) -> MeshReport:
    return repaired(
        RawPolygons(
            np.array(coordinates, np.float64),
            np.array([corner for polygon in polygons for corner in polygon], np.intp),
            np.array([len(polygon) for polygon in polygons], np.intp),
            np.arange(len(polygons)),
            tuple(f"part {number}" for number in range(len(polygons))),
            scalars,
        ),
        "a.obj",
        Placement(up),
        unused_nodes=unused_nodes,
    )


SHORT = "fewer than three different corners"


@pytest.mark.parametrize(
    ("polygon", "left", "repair"),
    [
        *(
            (quad, [[0, 1, 2, 2]], "with repeated corners was repaired")
            for quad in ([0, 0, 1, 2], [0, 1, 1, 2], [0, 1, 2, 2], [0, 1, 2, 0])
        ),
        *((short, [], f"with {SHORT} was dropped") for short in ([], [0, 1], [0, 0, 1], [0, 1, 1, 0])),
        *(
            (flat, [], "without area was dropped")
            for flat in ([0, 1, 4], [0, 1, 0, 3], [0, 1, 4, 1], [0, 4, 1, 0, 4, 1])
        ),
    ],
)
def test_repeated_corners_are_removed_and_polygons_without_area_dropped(
    polygon: list[int], left: list[list[int]], repair: str
) -> None:
    report = mesh_of([0, 1, 2], polygon, [1, 2, 3])
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 2], *left, [1, 2, 3, 3]]
    assert report.mesh.part_numbers.tolist() == [0, *([1] if left else []), 2]
    assert report.repairs == (f"a.obj: 1 polygon {repair}",)
    if not left:
        plural = repair.replace("was", "were")
        assert mesh_of([0, 1, 2], polygon, polygon).repairs == (f"a.obj: 2 polygons {plural}",)


def test_nodes_that_no_polygon_uses_are_dropped_with_their_scalars() -> None:
    scalars = (
        MeshScalar("height", np.arange(6.0)),
        MeshScalar("row", np.array([7.0, 8.0, 9.0]), "polygon"),
    )
    report = mesh_of([5, 1, 3], [0, 1, 4], [3, 1, 2], scalars=scalars, unused_nodes=False)
    assert report.mesh.coordinates.tolist() == [SQUARE[row] for row in (1, 2, 3, 5)]
    assert report.mesh.node_numbers.tolist() == [[3, 0, 2, 2], [2, 0, 1, 1]]
    assert [each.values.tolist() for each in report.mesh.scalars] == [[1, 2, 3, 5], [7, 9]]
    assert report.repairs == (
        "a.obj: 1 polygon without area was dropped",
        "a.obj: 2 nodes that no polygon uses were dropped",
    )


def test_a_sound_mesh_is_left_alone_and_tables_keep_unused_nodes() -> None:
    report = mesh_of([0, 1, 2, 3], [0, 1, 2])
    assert report.repairs == ()
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 3], [0, 1, 2, 2]]
    assert report.mesh.coordinates.tolist() == SQUARE


@pytest.mark.parametrize("own_normals", [False, True])
def test_a_polygon_whose_sides_cross_is_split_at_added_nodes(own_normals: bool) -> None:
    corners = np.array([0, 1, 2, 3, 0, 2, 1, 3])
    polygons = RawPolygons(
        np.array(SQUARE, np.float64),
        corners,
        np.array([4, 4]),
        np.zeros(2, np.intp),
        ("part",),
        (
            MeshScalar("x", np.array(SQUARE, np.float64)[:, 0]),
            MeshScalar("row", np.array([7.0, 8.0]), "polygon"),
        ),
        normals=np.array([(0, 0, 1.0), (0, 0.6, 0.8)]) if own_normals else None,
        corner_normals=(corners == 2).astype(np.intp) if own_normals else None,
    )
    placement = Placement(normals="file") if own_normals else Placement()
    mesh, repairs = (report := repaired(polygons, "a.obj", placement, unused_nodes=True)).mesh, report.repairs
    assert repairs == ("a.obj: 1 polygon whose sides cross was split",)
    # The nodes of the file keep their numbers.
    assert mesh.coordinates[: len(SQUARE)].tolist() == SQUARE
    assert mesh.node_numbers[0].tolist() == [0, 1, 2, 3]
    assert [0.5, 0.5, 0] in mesh.coordinates[len(SQUARE) :].tolist()
    values, rows = (each.values for each in mesh.scalars)
    assert values == pytest.approx(mesh.coordinates[:, 0])
    assert rows.tolist() == [7, *[8] * (len(mesh.node_numbers) - 1)]
    if own_normals:
        at_crossing = mesh.node_numbers == mesh.coordinates.tolist().index([0.5, 0.5, 0])
        between = mesh.normals.vectors[mesh.normals.numbers[at_crossing]]
        assert between == pytest.approx(np.array([(0, 0.3, 0.9)] * len(between)) / 0.9**0.5)


test_a_mesh_without_polygons_left_is_refused = refused(
    lambda polygons: mesh_of(*polygons),
    [
        (polygons, f"a.obj: a mesh must have a polygon with area, not none{causes}; add polygons")
        for polygons, causes in (
            ([], ""),
            (
                [[0, 1, 4], [0, 1], [2]],
                f"; 2 polygons with {SHORT} were dropped; 1 polygon without area was dropped",
            ),
        )
    ]
    + [
        (
            [[0, 1, 2], [0, 1] * 501],
            "a.obj, polygon 2: a polygon must have at most 1,000 corners, not 1,002; split it",
        )
    ],
)


def flat(corners: list[list[float]]) -> bool:
    """Whether a triangle has no area, worked out with fractions."""
    a, b, c = ([Fraction(number) for number in corner] for corner in corners)
    one = [q - p for p, q in zip(a, b, strict=True)]
    other = [q - p for p, q in zip(a, c, strict=True)]
    return all(one[i] * other[j] == one[j] * other[i] for i, j in ((0, 1), (1, 2), (2, 0)))


@given(
    quads=st.lists(
        st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=4, max_size=4), min_size=1, max_size=30
    ),
    scale=st.sampled_from([1.0, 2.0**-200, 2.0**90]),
    far=st.sampled_from([0.0, 1e3]),
)
def test_a_polygon_has_area_at_any_size_unless_both_its_diagonals_make_flat_triangles(
    quads: list[list[tuple[int, int, int]]], scale: float, far: float
) -> None:
    coordinates = (np.array(quads, np.float64).reshape(-1, 3) + far) * scale
    numbers = np.arange(len(coordinates)).reshape(-1, 4)
    # Half of them are triangles.
    numbers[::2, 3] = numbers[::2, 2]
    expected = []
    for quad in coordinates[numbers].tolist():
        a, b, c, d = quad
        expected.append(
            not (flat([a, b, c]) and flat([a, c, d])) and not (flat([a, b, d]) and flat([b, c, d]))
        )
    assert _have_area(coordinates, numbers).tolist() == expected


def test_a_turned_zero_has_no_sign_and_given_coordinates_are_kept() -> None:
    given = np.zeros((1, 3))
    assert not np.signbit(placed(given, Placement("y"))).any()
    assert not np.signbit(given).any()


def test_a_piece_of_a_polygon_has_the_scalars_of_the_whole() -> None:
    error = MeshScalar("error", np.array([7.0, 8.0, 9.0]), "polygon")
    mesh = mesh_of([0, 0, 1], [0, 1, 4, 2, 3], [0, 1, 2], scalars=(error,)).mesh
    assert mesh.scalars[0].values.tolist() == [8] * (len(mesh.node_numbers) - 1) + [9]


def test_names_are_different_printable_and_not_too_long() -> None:
    assert different(["a", "a", "b", "a", "a 2"]) == ("a", "a 2", "b", "a 3", "a 2 2")
    assert different(["q", "q", "q"], " of polygons") == ("q", "q of polygons", "q of polygons 2")
    assert name_of(b"  b\0" + b"c" * 300) == "b?" + "c" * (LONGEST_NAME - 2)
    assert (name_of(" Kühler ".encode()), name_of("Kühler".encode("latin-1"))) == ("Kühler", "Kühler")
    # A long name is cut between letters.
    assert name_of(("x" + "ü" * 1000).encode()) == "x" + "ü" * (LONGEST_NAME - 1)


def test_a_polygon_is_flat_if_its_triangles_are_flatter_than_a_share_of_its_size() -> None:
    for size in (1e-30, 1e30):
        corners = [[(0, 0, 0), (1, 0, 0), (1, h, 0), (0, h, 0)] for h in (FLAT / 2, 2 * FLAT)]
        coordinates = np.array(corners).reshape(-1, 3) * size
        assert _have_area(coordinates, np.arange(8).reshape(2, 4)).tolist() == [False, True]
