"""The own range of a scalar, which is shown where `[scalar]` gives no limits."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Final, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.scene.mesh import Mesh

Limits = tuple[float, float]

UNIT: Final = (0.0, 1.0)
"""Assumed: the range of a scalar without any value."""

LEAST_EXTENT: Final = 1e-6
"""Assumed: a range that is shorter than this share of its numbers is noise of float32, and has no extent."""

SMALLEST: Final = 1e-36
"""Below this, float32 has no room for the half of a number."""

MOST_KEPT: Final = 64
"""Assumed: ranges that are kept of one mesh; while a direction is dragged, each has one of its own."""


def size_of(mesh: Mesh) -> float:
    """The diagonal of the box around a mesh."""
    low, high = mesh.bounds
    return float(np.linalg.norm(high - low))


class ScalarValues(NamedTuple):
    """A scalar at the visible points, (n,) float32 in their order, NaN where missing, and its own range."""

    values: Singles
    limits: Limits


def within(values: Singles, limits: Limits) -> ScalarValues:
    """The values, in their own array, with those that rounding put beyond the limits put on them."""
    return ScalarValues(np.clip(values, *limits, out=values), limits)


def widened(low: float, high: float, least: float = 0.0) -> Limits:
    """The range from `low` to `high` as numbers of float32, since those at the pixels are.

    Assumed: one without extent, as of a constant, is widened on both sides by half of its number, or by
    `least` if that is more, and by a half where both are 0; so the value is in the middle of the colors. An
    extent of at most `least` is none.

    >>> widened(1.0, 3.0), widened(8.0, 8.0), widened(0.0, 0.0)
    ((1.0, 3.0), (4.0, 12.0), (-0.5, 0.5))
    """
    low, high = float(np.float32(low)), float(np.float32(high))
    most = max(abs(low), abs(high))
    if high - low > max(LEAST_EXTENT * most, least):
        return low, high
    half = max(most / 2, least)
    half = half if half > SMALLEST else 0.5
    return float(np.float32(low - half)), float(np.float32(high + half))


def range_of(values: Floats, cut: float = 0, least: float = 0.0) -> Limits:
    """The least and the largest of the values that are not missing, `widened`; UNIT if all are.

    `cut` percent of the values are beyond either end.
    """
    found = values[np.isfinite(values)]
    if not len(found):
        return UNIT
    if cut:
        low, high = np.percentile(found, [cut, 100 - cut]).tolist()
        return widened(low, high, least)
    return widened(float(found.min()), float(found.max()), least)


_KEPT: Final[WeakKeyDictionary[Mesh, dict[Hashable, Limits]]] = WeakKeyDictionary()


def kept(mesh: Mesh, key: Hashable, compute: Callable[[], Limits]) -> Limits:
    """A range that depends on nothing but the mesh and the key; computed once, and not for each picture."""
    ranges = _KEPT.setdefault(mesh, {})
    if key not in ranges:
        if len(ranges) >= MOST_KEPT:
            ranges.clear()
        ranges[key] = compute()
    return ranges[key]
