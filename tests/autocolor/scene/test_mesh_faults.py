from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.scene.mesh_faults import (
    KINDS,
    Hole,
    QuadShapes,
    edge_faults,
    fault_scalar,
    holes_of,
    mesh_faults,
    nodes_at_one_place,
    polygon_shapes,
    quad_shapes,
    repeated_polygons,
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
    found = edge_faults(table, 7)
    for edges, of_polygons, expected in (
        (found.borders, found.border_polygons, {edge for edge in owners if len(owners[edge]) == 1}),
        (found.crowded, found.crowded_polygons, {edge for edge in owners if len(owners[edge]) > 2}),
        (
            found.turned,
            found.turned_polygons,
            {edge for edge in owners if len(owners[edge]) == 2 and directed[min(edge), max(edge)] != 1},
        ),
    ):
        assert sorted(map(sorted, edges.tolist())) == sorted(map(sorted, expected))
        assert of_polygons.tolist() == sorted({number for edge in expected for number in owners[edge]})


def test_a_box_without_two_of_its_sides_has_two_holes() -> None:
    mesh = cube()
    box = mesh.node_numbers
    opposite = next(row for row in range(1, 6) if not set(box[row]) & set(box[0]))
    kept = np.delete(box, [0, opposite], axis=0)
    holes = holes_of(mesh.coordinates, edge_faults(kept, 8).borders)
    assert [(hole.edges, hole.is_closed) for hole in holes] == [(4, True), (4, True)]
    side = np.linalg.norm(mesh.coordinates[box[0, 0]] - mesh.coordinates[box[0, 1]])
    assert [hole.length for hole in holes] == pytest.approx([4 * side] * 2)
    for hole, row in zip(sorted(holes, key=lambda each: each.center), (0, opposite), strict=False):
        assert hole.node in {*box[0].tolist(), *box[opposite].tolist()}, row


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
    ("corners", "shapes"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 0)),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], QuadShapes(1, 1, 0, 0)),
        ([[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]], QuadShapes(1, 0, 1, 0)),
        ([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 1)),
        ([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]], QuadShapes(1, 0, 0, 1)),
    ],
    ids=["square", "warped", "concave", "bow-tie that cancels", "bow-tie"],
)
@pytest.mark.parametrize("scale", [1e-20, 1.0, 1e20])
def test_the_shape_of_a_quad_does_not_depend_on_its_size(
    corners: list[list[float]], shapes: QuadShapes, scale: float
) -> None:
    for first in range(4):
        quad = np.roll(np.arange(4), first)
        mesh = Mesh(
            np.array(corners) * scale, np.array([quad, quad[[0, 1, 2, 2]]]), np.zeros(2, np.intp), ("a",)
        )
        assert quad_shapes(mesh) == shapes


def test_polygons_without_area_are_no_quads_of_another_shape() -> None:
    places = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [0, 1, 0.0]])
    found = polygon_shapes(places, np.array([[0, 1, 2, 3], [0, 1, 2, 2], [0, 0, 0, 0], [0, 1, 4, 4]]))
    assert found.without_area.tolist() == [0, 1, 2]
    assert len(found.warped) == len(found.concave) == len(found.crossed) == 0


def test_polygons_are_the_same_in_any_order_of_their_nodes() -> None:
    table = np.array([[0, 1, 2, 3], [0, 1, 2, 2], [3, 2, 1, 0], [0, 1, 3, 3], [2, 0, 1, 1]])
    assert repeated_polygons(table).tolist() == [0, 1, 2, 4]


def test_only_nodes_that_are_used_count_and_zero_has_no_sign() -> None:
    places = np.array([[0.0, 0, 0], [1, 0, 0], [-0.0, 0, 0], [0, 0, 0], [0, 1, 0]])
    assert nodes_at_one_place(places, np.array([[0, 1, 4, 4]])).tolist() == []
    assert nodes_at_one_place(places, np.array([[0, 1, 4, 4], [2, 1, 4, 4]])).tolist() == [0, 2]
