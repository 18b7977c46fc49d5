"""The edges of a mesh that polygons do not share as those of a closed surface do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Indices, runs


@dataclass(frozen=True, eq=False)
class EdgeFaults:
    """Edges, each (edges, 2) rows of nodes, and the rows of the polygons that have them, ascending.

    A border has one polygon, a shared edge two, and a crowded one three or more. Where the polygons of a
    shared edge are turned to one side, they run along it in opposite directions; a turned edge is run twice
    in the same one. Polygons are looked at by their nodes alone: two nodes at one place are not joined.
    """

    borders: Indices
    border_polygons: Indices
    turned: Indices
    turned_polygons: Indices
    crowded: Indices
    crowded_polygons: Indices


def edge_faults(node_numbers: Indices, node_count: int) -> EdgeFaults:
    """The edges of a polygon table, (polygons, 4), that are borders, turned or crowded."""
    starts = np.ascontiguousarray(node_numbers.T)
    ends = np.roll(starts, -1, axis=0)
    # An edge from a node to itself closes a triangle, and is none.
    places = np.flatnonzero(starts.ravel() != ends.ravel())
    start, end = starts.ravel()[places], ends.ravel()[places]
    keys = np.minimum(start, end) * node_count + np.maximum(start, end)
    order = np.argsort(keys)
    is_first = np.diff(keys[order], prepend=-1) != 0
    firsts = np.flatnonzero(is_first)
    counts = np.diff(firsts, append=len(order))
    pairs = firsts[counts == 2]
    runs_up = (start < end)[order]
    turned = pairs[runs_up[pairs] == runs_up[pairs + 1]]
    crowded = counts > 2

    def edges(at: Indices) -> Indices:
        return np.stack([start[order[at]], end[order[at]]], axis=1)

    def polygons(at: Indices) -> Indices:
        return np.unique(places[order[at]] % len(node_numbers))

    borders = firsts[counts == 1]
    return EdgeFaults(
        edges(borders),
        polygons(borders),
        edges(turned),
        polygons(np.concatenate([turned, turned + 1])),
        edges(firsts[crowded]),
        polygons(runs(firsts[crowded], counts[crowded])),
    )
