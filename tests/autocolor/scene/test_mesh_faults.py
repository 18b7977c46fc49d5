from __future__ import annotations

from collections import Counter, defaultdict
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.scene.mesh_faults import (
    KINDS,
    Hole,
    edge_faults,
    fault_scalar,
    holes_of,
    mesh_faults,
    quad_shapes,
)
from tests.small import cube


def faulty() -> Mesh:
    """A warped quad, a concave and a crossed one, a repeated and a turned triangle, and one without area."""
    return Mesh(
        np.array(
            [
                [0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0],
                [5, 0, 0], [7, 0, 0], [5.5, 0.5, 0], [5, 2, 0],
                [10, 0, 0], [11, 1, 0], [11, 0, 0], [10, 1, 0],
                [20, 0, 0], [21, 0, 0], [20, 1, 0], [21, 1, 0],
                [30, 0, 0], [31, 0, 0], [32, 0, 0],
                [99, 0, 0], [20, 1, 0],
            ]
        ),
        np.array(
            [
                [0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11],
                [12, 13, 14, 14], [13, 15, 14, 14], [14, 12, 13, 13], [16, 17, 18, 18],
                [12, 20, 13, 13],
            ]
        ),
    )  # fmt: skip


def test_each_kind_of_fault_is_found_with_its_rows() -> None:
    found = {fault.kind: fault for fault in mesh_faults(faulty())}
    assert list(found) == [kind for kind in KINDS if kind in found]
    polygons = {kind: found[kind].rows.tolist() for kind in ("warped", "concave", "crossed", "repeated")}
    assert polygons == {"warped": [0], "concave": [1], "crossed": [2], "repeated": [3, 5]}
    assert found["without area"].rows.tolist() == [6]
    assert found["unused"].rows.tolist() == [19]
    assert found["unwelded"].rows.tolist() == [14, 20]
    assert sorted(map(sorted, found["crowded"].rows.tolist())) == [[12, 13], [13, 14]]
    assert found["turned"].polygons.tolist() == [3, 5]
    assert [hole.edges for hole in found["border"].holes][-1] > 0


def test_a_cube_has_no_fault() -> None:
    assert mesh_faults(cube()) == ()
    assert mesh_faults(Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp))) == ()


def test_the_scalar_has_the_gravest_fault_of_each_polygon() -> None:
    mesh = faulty()
    scalar = fault_scalar(mesh, mesh_faults(mesh))
    numbers = {kind: number for number, kind in enumerate(KINDS, 1)}
    assert (scalar.name, scalar.of) == ("fault", "polygon")
    assert scalar.values[2] == numbers["crossed"]
    assert scalar.values[5] == numbers["crowded"]
    assert scalar.values[6] == numbers["without area"]
    assert not fault_scalar(cube(), ()).values.any()


polygons = st.lists(st.lists(st.integers(0, 6), min_size=3, max_size=4, unique=True), min_size=1, max_size=12)


@given(polygons)
def test_the_edges_agree_with_a_count_in_a_table(rows: list[list[int]]) -> None:
    directed: Counter[tuple[int, int]] = Counter()
    owners: dict[frozenset[int], list[int]] = defaultdict(list)
    for number, row in enumerate(rows):
        for start, end in zip(row, [*row[1:], row[0]], strict=True):
            directed[start, end] += 1
            owners[frozenset((start, end))].append(number)
    table = np.array([[*row, *row[-1:]][:4] for row in rows])
    expected = {
        "border": {edge for edge in owners if len(owners[edge]) == 1},
        "turned": {edge for edge in owners if len(owners[edge]) == 2 and directed[min(edge), max(edge)] != 1},
        "crowded": {edge for edge in owners if len(owners[edge]) > 2},
    }
    for fault in edge_faults(Mesh(np.zeros((7, 3)), table)):
        edges = expected.pop(fault.kind)
        assert sorted(map(sorted, fault.rows.tolist())) == sorted(map(sorted, edges))
        assert fault.polygons.tolist() == sorted({number for edge in edges for number in owners[edge]})
    assert not expected


def test_a_box_without_two_of_its_sides_has_two_holes() -> None:
    box = cube()
    sides = box.node_numbers.tolist()
    opposite = next(side for side in sides if not {*side} & {*sides[0]})
    rest = [side for side in sides if side not in (sides[0], opposite)]
    border, *_ = edge_faults(Mesh(box.coordinates, np.array(rest)))
    assert [(hole.edges, hole.length, hole.is_closed) for hole in border.holes] == [(4, 4.0, True)] * 2
    assert {hole.node for hole in border.holes} == {min(sides[0]), min(opposite)}


def test_holes_that_share_a_node_are_one_branching_hole_and_longer_holes_come_first() -> None:
    places = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [9, 0, 0], [19, 0, 0], [9, 10, 0.0]]
    )
    borders = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0], [5, 6], [7, 6], [7, 5]])
    long, branching = holes_of(places, borders)
    assert long.length == pytest.approx(20 + 10 * 2**0.5)
    assert long == Hole(3, long.length, (14, 5, 0), 5, True)
    assert (branching.edges, branching.node, branching.is_closed) == (6, 0, False)


@pytest.mark.parametrize(
    ("corners", "warped", "concave", "crossed"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], 0, 0, 0),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], 1, 0, 0),
        ([[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]], 0, 1, 0),
        ([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], 0, 0, 1),
        ([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]], 0, 0, 1),
    ],
    ids=["square", "warped", "concave", "bow-tie that cancels", "bow-tie"],
)
@pytest.mark.parametrize("scale", [1e-20, 1.0, 1e20])
def test_the_shape_of_a_quad_does_not_depend_on_its_size(
    corners: list[list[float]], warped: int, concave: int, crossed: int, scale: float
) -> None:
    for first in range(4):
        quad = np.roll(np.arange(4), first)
        mesh = Mesh(np.array(corners) * scale, np.array([quad, quad[[0, 1, 2, 2]]]))
        counts = {"quads": 1, "warped": warped, "concave": concave, "crossed": crossed}
        assert quad_shapes(mesh) == counts


PLACES = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [0, 1, 0.0]]
SIGNED = [[0.0, 0, 0], [1, 0, 0], [-0.0, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("nodes", "polygons", "kind", "rows"),
    [
        (PLACES, [[0, 1, 2, 3], [0, 1, 2, 2], [0, 0, 0, 0], [0, 1, 4, 4]], "without area", [0, 1, 2]),
        (PLACES, [[0, 1, 2, 3], [0, 1, 2, 2], [0, 0, 0, 0], [0, 1, 4, 4]], "warped", []),
        (PLACES, [[0, 1, 2, 3]], "crossed", []),
        # Polygons are the same in any order of their nodes.
        (
            PLACES,
            [[0, 1, 2, 3], [0, 1, 2, 2], [3, 2, 1, 0], [0, 1, 3, 3], [2, 0, 1, 1]],
            "repeated",
            [0, 1, 2, 4],
        ),
        (PLACES, [[0, 1, 4, 4], [0, 1, 4, 4]], "repeated", [0, 1]),
        # Only nodes that are used count, and zero has no sign.
        (SIGNED, [[0, 1, 3, 3]], "unwelded", []),
        (SIGNED, [[0, 1, 3, 3], [2, 1, 3, 3]], "unwelded", [0, 2]),
        (SIGNED, np.empty((0, 4), np.intp), "unwelded", []),
        (SIGNED, np.empty((0, 4), np.intp), "unused", [0, 1, 2, 3]),
    ],
)
def test_the_rows_of_a_fault_are_these(nodes: Any, polygons: Any, kind: str, rows: list[int]) -> None:
    faults = {fault.kind: fault.rows.tolist() for fault in mesh_faults(Mesh(nodes, polygons))}
    assert faults.get(kind, []) == rows
