from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration
from ramtek_emu.memory.lookup_table import LookupTable

runs = st.tuples(st.integers(0, 2047), st.sampled_from([0, 1, 2, 3, 50, 2048, 2049]))


@given(
    st.sampled_from([GMR_9300, PRINCETON_9300]),
    st.lists(runs, min_size=1, max_size=4),
    st.lists(st.integers(0, 3), min_size=1, max_size=8),
)
def test_all_that_was_written_since_a_count_lies_in_the_run(
    configuration: Configuration, choice: list[tuple[int, int]], loads: list[int]
) -> None:
    table = LookupTable(configuration)
    before = [(0, table.packed.copy())]
    for number, which in enumerate(loads):
        address, count = choice[which % len(choice)]
        row = (np.arange(count) * 31 + number * 0x0101 + 1).astype(np.uint16)
        table.load(address, row)
        for written, packed in before:
            run = table.entries_written_since(written)
            first, end = run or (0, table.size)
            differing = np.flatnonzero(table.packed != packed)
            assert ((first <= differing) & (differing < end)).all()
        before.append((table.written, table.packed.copy()))


def test_loading_the_same_entries_repeatedly_counts_as_one_range() -> None:
    table = LookupTable()
    table.load(0, np.zeros(2048, np.uint16))
    written = table.written
    for number in range(3):
        table.load(21, np.full(4, number, np.uint16))
        table.load(100, np.zeros(0, np.uint16))
        assert table.entries_written_since(written) == (10, 13)
    table.load(26, np.array([0x0203, 1], np.uint16))
    assert table.entries_written_since(written) is None
    assert table.entries_written_since(table.written - 1) == (13, 14)
