"""Holes: the closed loops that the border edges of a mesh form. The rim of an open surface is one, too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Floats, Indices, lengths
from autocolor.scene.geometry.union_find import group_numbers, unite


@dataclass(frozen=True)
class Hole:
    """A loop of border edges: how many, how long together, the middle of its bounds, and one of its nodes.

    A loop that is not `is_closed` branches, as where two holes share a node.
    """

    edges: int
    length: float
    center: tuple[float, float, float]
    node: int
    is_closed: bool


def holes_of(coordinates: Floats, borders: Indices) -> list[Hole]:
    """The loops of border edges, (edges, 2) rows of nodes, the longest first."""
    if not len(borders):
        return []
    nodes, ends = np.unique(borders, return_inverse=True)
    ends = ends.reshape(-1, 2)
    parents = np.arange(len(nodes))
    unite(parents, ends[:, 0], ends[:, 1])
    group_of_node = group_numbers(parents)
    group = group_of_node[ends[:, 0]]
    count = int(group_of_node.max()) + 1
    places = coordinates[nodes]
    edge_counts = np.bincount(group, minlength=count)
    long = np.bincount(group, lengths((places[ends[:, 0]] - places[ends[:, 1]]).T), minlength=count)
    # At each node of a closed loop two edges meet.
    branches = np.bincount(ends.ravel(), minlength=len(nodes)) != 2
    is_open = np.bincount(group_of_node, branches, minlength=count) > 0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, group_of_node, places)
    np.maximum.at(high, group_of_node, places)
    first = np.full(count, len(coordinates))
    np.minimum.at(first, group_of_node, nodes)
    centers = (low / 2 + high / 2).tolist()
    return [
        Hole(
            int(edge_counts[row]),
            float(long[row]),
            tuple(centers[row]),
            int(first[row]),
            not bool(is_open[row]),
        )
        for row in np.argsort(-long, kind="stable").tolist()
    ]
