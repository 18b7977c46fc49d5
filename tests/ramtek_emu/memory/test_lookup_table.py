from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, instructions
from ramtek_emu.memory.lookup_table import LookupTable
from tests.tables import refused

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


def test_entries_are_read_only_and_written_only_grows() -> None:
    table = LookupTable()
    table.load(6, np.array([0x0203], np.uint16))
    assert table.written == 1
    with pytest.raises(ValueError, match="read-only"):
        table.entries[0, 0] = 1
    with pytest.raises(ValueError, match="read-only"):
        table.packed[0] = 1


CHOOSE = "choose an entry of the table"
test_what_is_not_sent = refused(
    lambda given: instructions.load_entries(*given),
    [
        ((1024, [[0, 0, 0]]), f"the first entry must be 0 to 1023, not 1024; {CHOOSE}"),
        ((-1, [[0, 0, 0]]), f"the first entry must be 0 to 1023, not -1; {CHOOSE}"),
        ((1.0, [[0, 0, 0]]), f"the first entry must be 0 to 1023, not 1.0; {CHOOSE}"),
        ((1023, [[0, 0, 0]] * 2), "a run of entries must end at 1023, not 1024 (2 from 1023 on); send fewer"),
        ((7, [[0, 0, 0], [0, 256, 0]]), "a color must be 0 to 255, not 256 (entry 8, green); clip it first"),
        ((7, [[0, 0, -1]]), "a color must be 0 to 255, not -1 (entry 7, blue); clip it first"),
        (
            (0, [[0.0, 0.0, float("nan")]]),
            "colors must be whole numbers, not float64; convert them first, rounding half up",
        ),
        (
            (0, [0, 0, 0]),
            "colors must be an (n, 3) array of red, green, blue, not of shape (3,); reshape it",
        ),
    ],
)
