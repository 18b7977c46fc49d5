from __future__ import annotations

import pytest

from ramtek_emu import WordsError, instructions


def test_streams_follow_each_other_as_one() -> None:
    both = instructions.concatenate(instructions.reset(), instructions.zoom(2))
    assert both.tolist() == [0x0500, 0x2600, 0x0101]
    assert instructions.concatenate().tolist() == []


def test_what_is_no_stream_is_refused() -> None:
    with pytest.raises(WordsError, match=r"a stream of words must be one row, not of shape \(1, 1\)"):
        instructions.concatenate([[1]])  # type: ignore[arg-type]
