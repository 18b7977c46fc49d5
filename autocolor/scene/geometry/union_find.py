"""Union-find: items that are united in pairs, and the groups that come of it.

Every item has a parent, a lower item of its group; the root of a group is its lowest item and its own parent.
At first every item is a root, as in `np.arange`. All functions work on many items at once.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Indices, Scratch, chunks

AT_ONCE: Final = 1 << 15


def unite(parents: Indices, one: Indices, other: Indices) -> None:
    """Unite the groups of each pair of items; `parents` is changed in place."""
    while len(one):
        # Drop the pairs that are in one group by now.
        one, other = roots_of(parents, np.concatenate([one, other])).reshape(2, -1)
        apart = np.flatnonzero(one != other)
        one, other = np.take(one, apart), np.take(other, apart)
        # Make the lower root the parent of the higher one. Where several pairs share the higher root, the
        # lowest parent is taken and the other pairs try again.
        np.minimum.at(parents, np.maximum(one, other), np.minimum(one, other))


def group_numbers(parents: Indices, scratch: Scratch = np.empty) -> Indices:
    """The group of each item; groups are numbered from 0 in the order of their roots."""
    groups: Indices = scratch(parents.shape, parents.dtype.type)
    count = 0
    for chunk in chunks(len(parents), AT_ONCE):
        items = np.arange(chunk.start, chunk.stop)
        is_root = parents[chunk] == items
        numbers = np.cumsum(is_root)
        groups[chunk] = numbers + (count - 1)
        count += int(numbers[-1])
        # A root is the lowest of its group, so that it has its number by now.
        others = items[~is_root]
        groups[others] = groups[roots_of(parents, others)]
    return groups


def united_items(parents: Indices) -> Indices:
    """The items that are not the root of their group, ascending."""
    found = [
        np.flatnonzero(parents[chunk] != np.arange(chunk.start, chunk.stop)) + chunk.start
        for chunk in chunks(len(parents), AT_ONCE)
    ]
    return np.concatenate([np.empty(0, np.intp), *found])


def roots_of(parents: Indices, items: Indices) -> Indices:
    """The root of each item, which becomes its parent (path compression)."""
    ancestors = np.take(parents, items)
    while True:
        higher = np.take(parents, ancestors)
        if (higher == ancestors).all():
            return higher
        parents[items] = ancestors = higher
