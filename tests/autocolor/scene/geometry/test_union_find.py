from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry import union_find
from autocolor.scene.geometry.union_find import group_numbers, unite, united_items

COUNT = 30

items = st.integers(0, COUNT - 1)
batches = st.lists(st.lists(st.tuples(items, items), max_size=20), max_size=4)


def roots_one_by_one(pairs: list[tuple[int, int]]) -> list[int]:
    """The lowest of each item's group, by passing it on until nothing changes."""
    lowest = list(range(COUNT))
    changed = True
    while changed:
        changed = False
        for one, other in pairs:
            if lowest[one] != lowest[other]:
                lowest[one] = lowest[other] = min(lowest[one], lowest[other])
                changed = True
    return lowest


@given(batches)
def test_items_are_in_one_group_when_pairs_lead_from_one_to_the_other(
    several: list[list[tuple[int, int]]],
) -> None:
    parents = np.arange(COUNT)
    for pairs in several:
        one, other = np.array(pairs, np.intp).reshape(-1, 2).T
        unite(parents, one, other)
    lowest = roots_one_by_one([pair for pairs in several for pair in pairs])
    in_order = sorted(set(lowest))
    assert group_numbers(parents).tolist() == [in_order.index(each) for each in lowest]


def test_a_long_chain_in_any_order_is_one_group(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(union_find, "AT_ONCE", 100)
    chain = np.random.default_rng(7).permutation(10_000)
    parents = np.arange(len(chain))
    links = np.random.default_rng(8).permutation(len(chain) - 1)
    for some in np.array_split(links, 5):
        unite(parents, chain[some], chain[some + 1])
    assert not group_numbers(parents).any()


def test_united_items_are_those_that_are_not_the_root_of_their_group() -> None:
    parents = np.arange(9)
    unite(parents, np.array([1, 4, 7]), np.array([5, 5, 2]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(union_find, "AT_ONCE", 4)
        assert united_items(parents).tolist() == [4, 5, 7]
    assert united_items(np.arange(0)).tolist() == []
