from __future__ import annotations

import numpy as np
import pytest

from autocolor.scene.geometry.faults.edge_faults import edge_faults
from autocolor.scene.geometry.faults.holes import Hole, holes_of
from tests.autocolor.meshes import cube


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


def test_holes_that_share_a_node_are_one_that_branches_and_longer_ones_come_first() -> None:
    places = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [9, 0, 0], [19, 0, 0], [9, 10, 0.0]]
    )
    borders = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0], [5, 6], [7, 6], [7, 5]])
    long, branching = holes_of(places, borders)
    assert long.length == pytest.approx(20 + 10 * 2**0.5)
    assert long == Hole(3, long.length, (14, 5, 0), 5, True)
    assert (branching.edges, branching.node, branching.is_closed) == (6, 0, False)


def test_no_border_is_no_hole() -> None:
    assert holes_of(np.zeros((3, 3)), np.empty((0, 2), np.intp)) == []
