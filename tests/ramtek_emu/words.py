"""Words as people of the time read them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def hexadecimal(words: npt.NDArray[np.uint16]) -> str:
    """Each word as four hexadecimal digits."""
    return " ".join(f"{word:04X}" for word in words)
