"""Streams of words, put together."""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_stream
from ramtek_emu.instruction_set.instruction import NO_WORDS


def concatenate(*parts: Words) -> Words:
    """Several streams, one after the other, as one."""
    return np.concatenate([checked_stream(part) for part in parts]) if parts else NO_WORDS
