"""Color scales: the colors from the lowest to the highest value of a scalar.

viridis, plasma, inferno, magma and cividis are perceptually uniform: equal steps of the value look equally
large, and stay in order in a print without colors. turbo and rainbow have more colors to tell apart, and
steps that mislead; coolwarm and RdBu diverge from a light middle, for values around a zero. zebra is black
and white in turn, for lines of equal value, and shows how smooth a surface is.

Measured and rejected: the `cmap` library, which knows several hundred scales. A scene must have the same
colors everywhere, and one that names a scale of an optional package could be read only where that is
installed. The scales of scale_tables.py take 2 kB, `cmap` 7.3 MB; any other scale is given as a list of
colors, up to one for each band.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.scene.columns.color_kinds import ColorKind
from autocolor.scene.scalars.scale_tables import SCALE_TABLES

REVERSED: Final = "_r"
"""What ends the name of a scale whose colors run from its last to its first, as in matplotlib."""

IN_TURN: Final = ("zebra", f"zebra{REVERSED}")
"""The scales whose colors are repeated from band to band; those between the colors of others are mixed."""


def _named_scales() -> dict[str, tuple[str, ...]]:
    scales: dict[str, tuple[str, ...]] = {}
    for name, table in SCALE_TABLES.items():
        scales[name] = tuple(f"#{color}" for color in table.split())
        scales[name + REVERSED] = scales[name][::-1]
    return scales


COLOR_SCALES: Final[Mapping[str, tuple[str, ...]]] = _named_scales()
"""The colors of each named scale, at equal distances."""


@lru_cache(maxsize=64)
def scale_colors(scale: str | tuple[Color, ...], count: int) -> Bytes:
    """The colors of `count` bands, (count, 3) uint8, read-only.

    Assumed: the first and the last band have the colors of the scale's ends, and the others are at equal
    distances between them, so that few bands differ as much as the scale allows. The middle band of an odd
    number has the middle color of a diverging scale.

    >>> scale_colors("grays", 3).tolist()
    [[0, 0, 0], [128, 128, 128], [255, 255, 255]]
    """
    colors = COLOR_SCALES[scale] if isinstance(scale, str) else scale
    given = np.array([ColorKind().accepted(color) for color in colors], np.float64)
    if isinstance(scale, str) and scale in IN_TURN:
        return read_only(given[np.arange(count) % len(given)].astype(np.uint8))
    places = np.linspace(0, len(given) - 1, count)
    mixed = [np.interp(places, np.arange(len(given)), component) for component in given.T]
    return read_only(np.floor(np.stack(mixed, axis=1) + 0.5).astype(np.uint8))
