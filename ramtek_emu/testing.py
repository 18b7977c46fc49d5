"""Strategies for property tests of programs that use the display, with hypothesis.

They need hypothesis, which the extra `testing` installs. docs/TESTING.md has complete tests.
"""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Colors, Raster
from ramtek_emu.instruction_set.table import FORMATS, SUBSTANTIATED

try:
    from hypothesis import strategies as st
    from hypothesis.extra import numpy as arrays
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "ramtek_emu.testing needs the package hypothesis; run: pip install hypothesis",
        name=error.name,
    ) from error


def words(planes: int = 10) -> st.SearchStrategy[int]:
    """Words of so many bits: by default the words of pixels, 0 to 1023; with 16, the words of a stream."""
    return st.integers(0, (1 << planes) - 1)


def rasters(lines: int = 9, elements: int = 13, planes: int = 10) -> st.SearchStrategy[Raster[np.uint16]]:
    """Words of pixels, (lines, elements) uint16. Failing examples above 200 pixels shrink for minutes."""
    return arrays.arrays(np.uint16, (lines, elements), elements=words(planes), fill=st.nothing())


def entries(count: int = 1024) -> st.SearchStrategy[Colors]:
    """Lookup tables, (count, 3) uint8: the red, green and blue of each entry. Most entries are alike."""
    return arrays.arrays(np.uint8, (count, 3))


def streams(most: int = 60) -> st.SearchStrategy[list[int]]:
    """Lists of at most so many 16-bit words; many of them begin an instruction.

    A display accepts any words: instructions with operands that make no sense, unknown instructions, and an
    instruction that ends too early.
    """
    opcodes = st.sampled_from([format.opcode for format in SUBSTANTIATED]) | st.sampled_from(
        [format.opcode for format in FORMATS]
    )
    begins = st.builds(lambda opcode, low: opcode << 8 | low, opcodes, st.integers(0, 255))
    small = st.integers(0, 12)
    return st.lists(begins | small | words(16), max_size=most)
