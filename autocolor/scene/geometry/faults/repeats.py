"""Rows of a table that equal another row: polygons with the same nodes, nodes at the same place."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices

MIXED: Final = np.uint64(0x9E3779B97F4A7C15)
"""An odd number by which the columns are mixed, that of the golden ratio."""


def repeated_polygons(node_numbers: Indices) -> Indices:
    """The rows of polygons that have the same nodes as another one, in any order, ascending."""
    nodes = np.array(node_numbers)
    # A triangle repeats its last node, whichever that is.
    nodes[nodes[:, 2] == nodes[:, 3], 3] = -1
    nodes.sort(axis=1)
    return repeated_rows(nodes)


def nodes_at_one_place(coordinates: Floats, node_numbers: Indices) -> Indices:
    """The rows of used nodes that have the same place as another used one, ascending."""
    used = np.zeros(len(coordinates), np.bool_)
    used[node_numbers.T] = True
    rows = np.flatnonzero(used)
    # Adding zero makes -0.0 and 0.0 the same bits.
    places = np.ascontiguousarray(coordinates[rows] + 0.0)
    repeated: Indices = rows[repeated_rows(places.view(np.int64).reshape(len(rows), 3))]
    return repeated


def repeated_rows(table: AnyArray) -> Indices:
    """The rows of a table of whole numbers, (rows, columns), that equal another row, ascending."""
    if not len(table):
        return np.empty(0, np.intp)
    # Rows that are equal have equal sums of their mixed columns: only those are compared.
    sums = np.zeros(len(table), np.uint64)
    for column in table.astype(np.int64, copy=False).T:
        sums = (sums ^ np.ascontiguousarray(column).view(np.uint64)) * MIXED
        sums ^= sums >> np.uint64(29)
    order = np.argsort(sums, kind="stable")
    is_next_equal = sums[order[1:]] == sums[order[:-1]]
    candidates = order[np.append(is_next_equal, False) | np.append([False], is_next_equal)]
    if not len(candidates):
        return np.empty(0, np.intp)
    rows = table[candidates]
    by_value = np.lexsort(rows.T)
    is_same = (rows[by_value[1:]] == rows[by_value[:-1]]).all(axis=1)
    repeats = by_value[np.append(is_same, False) | np.append([False], is_same)]
    return np.sort(candidates[repeats])
