from __future__ import annotations

from unittest.mock import patch

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu.video.dirty_lines import lines_with
from tests.ramtek_emu.strategies import quick, rasters


@quick
@given(rasters(60, 5), st.integers(0, 1023), st.integers(1, 1024))
def test_the_lines_that_show_a_run_of_entries_are_found(
    raster: NDArray[np.uint16], first: int, count: int
) -> None:
    end = min(first + count, 1024)
    with patch("ramtek_emu.video.dirty_lines.STRIP", 7):
        top, bottom = lines_with(raster, first, end)
    showing = [line for line, words in enumerate(raster.tolist()) if any(first <= w < end for w in words)]
    assert (top, bottom) == ((showing[0], showing[-1] + 1) if showing else (0, 0))
