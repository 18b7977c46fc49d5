"""What a window shows."""

from __future__ import annotations

import numpy as np
import pytest

pygame = pytest.importorskip("pygame")


def shown() -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """The pixels of the window, (height, width, 3)."""
    return np.asarray(pygame.surfarray.array3d(pygame.display.get_surface())).transpose(1, 0, 2)
