from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.faults.edge_faults import edge_faults
from tests.autocolor.meshes import cube

polygons = st.lists(st.lists(st.integers(0, 6), min_size=3, max_size=4, unique=True), min_size=1, max_size=12)


@given(polygons)
def test_the_edges_are_those_that_a_count_in_a_table_finds(rows: list[list[int]]) -> None:
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


def test_a_closed_surface_has_no_fault_and_a_turned_polygon_four() -> None:
    table = cube().node_numbers
    found = edge_faults(table, 8)
    assert (len(found.borders), len(found.turned), len(found.crowded)) == (0, 0, 0)
    turned = table.copy()
    turned[2] = turned[2, ::-1]
    found = edge_faults(turned, 8)
    assert len(found.turned) == 4
    assert 2 in found.turned_polygons.tolist()


def test_a_mesh_without_polygons_has_no_edges() -> None:
    assert edge_faults(np.empty((0, 4), np.intp), 0).borders.shape == (0, 2)
