"""Color scales: the colors from the lowest to the highest value of a scalar."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.scene.columns.color_kinds import ColorKind

COLOR_SCALES: Final[Mapping[str, tuple[str, ...]]] = {
    "viridis": (
        "#440154", "#482878", "#3e4a89", "#31688e", "#26828e",
        "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725",
    ),
    "grays": ("#000000", "#ffffff"),
    "rainbow": ("#0000ff", "#00ffff", "#00ff00", "#ffff00", "#ff0000"),
}  # fmt: skip
"""The colors of each named scale, at equal distances."""


@lru_cache(maxsize=64)
def scale_colors(scale: str | tuple[Color, ...], count: int) -> Bytes:
    """The colors of `count` bands, (count, 3) uint8, read-only: the scale at the middle of each band.

    Assumed: the first and the last band have the colors of its ends.

    >>> scale_colors("grays", 3).tolist()
    [[0, 0, 0], [128, 128, 128], [255, 255, 255]]
    """
    colors = COLOR_SCALES[scale] if isinstance(scale, str) else scale
    given = np.array([ColorKind().accepted(color) for color in colors], np.float64)
    places = np.linspace(0, len(given) - 1, count)
    mixed = [np.interp(places, np.arange(len(given)), component) for component in given.T]
    return read_only(np.floor(np.stack(mixed, axis=1) + 0.5).astype(np.uint8))
