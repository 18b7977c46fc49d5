from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.runs import batches, pieces, runs

whole = st.integers(-(2**63), 2**63 - 1)


@given(st.lists(st.tuples(whole, st.integers(1, 9), whole)))
def test_runs_follow_each_other_even_where_the_sum_leaves_64_bits(rows: list[tuple[int, int, int]]) -> None:
    first, count, step = np.array(rows, np.int64).reshape(-1, 3).T
    expected = [start + k * by for start, many, by in rows for k in range(many)]
    wrapped = [(number + 2**63) % 2**64 - 2**63 for number in expected]
    assert runs(first, count, step).tolist() == wrapped


@given(st.lists(st.tuples(st.integers(-1000, 1000), st.integers(1, 9))))
def test_without_a_step_each_number_is_one_more(rows: list[tuple[int, int]]) -> None:
    first, count = np.array(rows, np.int64).reshape(-1, 2).T
    assert runs(first, count).tolist() == [start + k for start, many in rows for k in range(many)]


@given(st.lists(st.integers(1, 9)), st.integers(1, 20))
def test_batches_hold_every_run_once_and_are_no_larger_than_they_must(counts: list[int], most: int) -> None:
    every = list(batches(np.array(counts, np.int64), most))
    assert [k for part, _ in every for k in range(len(counts))[part]] == list(range(len(counts)))
    for part, some in every:
        assert sum(counts[: part.start]) == some.start
        assert sum(counts[part]) == some.stop - some.start
        assert some.stop - some.start <= most or part.stop == part.start + 1


@given(st.integers(0, 50), st.integers(0, 50), st.integers(1, 20))
def test_pieces_hold_every_number_once_and_never_too_many(start: int, length: int, most: int) -> None:
    every = list(pieces(start + length, most, start))
    assert [number for piece in every for number in range(100)[piece]] == list(range(start, start + length))
    assert all(0 < piece.stop - piece.start <= most for piece in every)
