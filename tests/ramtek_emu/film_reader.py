"""Films as Pillow reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageSequence

from ramtek_emu.arrays import Colors


def decoded(path: str | Path) -> list[Colors]:
    """The fields of a film or a picture, (lines, elements, 3) uint8."""
    with Image.open(path) as film:
        return [np.asarray(field.convert("RGB")) for field in ImageSequence.Iterator(film)]


def durations_of(path: Path) -> list[float]:
    """The durations of the fields of a film, in milliseconds."""
    with Image.open(path) as film:
        return [field.convert("RGB").info.get("duration", 0) for field in ImageSequence.Iterator(film)]
