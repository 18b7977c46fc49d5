"""Words, entries and streams for the tests of programs that use the display."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from ramtek_emu.arrays import Raster
from ramtek_emu.instruction_set.table import FORMATS, SUBSTANTIATED

words = st.integers(0, 0xFFFF)
ten_bit_words = st.integers(0, 1023)


def streams(most: int = 60) -> st.SearchStrategy[list[int]]:
    """Random words; many of them begin an instruction."""
    opcodes = st.sampled_from([format.opcode for format in SUBSTANTIATED]) | st.sampled_from(
        [format.opcode for format in FORMATS]
    )
    begins = st.builds(lambda opcode, low: opcode << 8 | low, opcodes, st.integers(0, 255))
    small = st.integers(0, 12)
    return st.lists(begins | small | words, max_size=most)


def rasters(lines: int = 9, elements: int = 13) -> st.SearchStrategy[Raster[np.uint16]]:
    """(lines, elements) ten-bit words."""
    return arrays.arrays(np.uint16, (lines, elements), elements=ten_bit_words, fill=st.nothing())
