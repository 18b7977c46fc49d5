"""The panel of a mapping curve: intensity rises to the right, the level upward.

Behind the curve stands how often each intensity is seen, and on it its points.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.scene.curves import CurvePoints
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, lines, outline, segments, text
from autocolor.widgets.labels import short_name
from autocolor.widgets.menu import WORK

PANEL: Final = Area(8, WORK.bottom - 215, 223, WORK.bottom - 8)
"""The panel, at the lower left of the picture."""

CURVE: Final = Area(PANEL.left + 8, PANEL.top + 16, PANEL.right - 8, PANEL.bottom - 8)
"""Where the curve is."""

ACROSS: Final = np.linspace(0, 1, CURVE.width, dtype=np.float32)
"""The fraction of the intensities at each element of the curve."""

MOST_CHARACTERS: Final = (CURVE.width - 2 * CHARACTER) // CHARACTER - len("level")

MOST_COUNTED: Final = 20_000
"""Assumed: intensities that are counted; the panel cannot tell more apart."""


class Curve(NamedTuple):
    """What the panel shows.

    `levels` are fractions at ACROSS, `shares` are how often the intensities there are seen, 0 to 1.
    """

    surface: str
    levels: Singles
    shares: Singles
    points: CurvePoints
    touched: int | None
    """The number of the point that was touched last."""


def panel_items(curve: Curve) -> list[Item]:
    """How the panel looks."""
    name = short_name(curve.surface, MOST_CHARACTERS)
    top = PANEL.top + 4
    found = [
        filled(PANEL, NIGHT),
        outline(PANEL, SLATE),
        text("level", CURVE.left, top, LIGHT_GRAY),
        _share_item(curve.shares),
        outline(CURVE, SLATE),
        lines([_places_of(ACROSS, curve.levels)], YELLOW, CURVE),
    ]
    if name:
        found.append(text(name, CURVE.right + 1 - CHARACTER * len(name), top, GRAY))
    for number, (x, y) in enumerate(curve.points):
        element, line = place_of(x, y)
        word = YELLOW if number == curve.touched else WHITE
        found.append(filled(Area(element - 2, line - 2, element + 2, line + 2).within(PANEL), word))
    return found


def place_of(x: float, y: float) -> tuple[int, int]:
    """The element and the line of fractions of intensity and level."""
    return round(CURVE.left + x * (CURVE.width - 1)), round(CURVE.bottom - y * (CURVE.height - 1))


def fractions_of(element: int, line: int) -> tuple[float, float]:
    """The fractions of intensity and level at a place, 0 to 1."""
    x = (element - CURVE.left) / (CURVE.width - 1)
    y = (CURVE.bottom - line) / (CURVE.height - 1)
    return min(1.0, max(0.0, x)), min(1.0, max(0.0, y))


def _places_of(xs: Singles, ys: Singles) -> Floats:
    """The elements and lines, (n, 2), of fractions."""
    return np.column_stack(
        [CURVE.left + xs * (CURVE.width - 1.0), CURVE.bottom - ys * (CURVE.height - 1.0)]
    ).astype(np.float64)


def _share_item(shares: Singles) -> Item:
    """A line upward for each element, as long as intensities there are frequent."""
    tops = _places_of(ACROSS, shares)
    feet = np.column_stack([tops[:, 0], np.full(len(tops), float(CURVE.bottom))])
    return segments(np.hstack([feet, tops]), SLATE, CURVE)


def shares_of(intensities: Singles, low: float, high: float) -> Singles:
    """How often the intensities from low to high are seen at ACROSS, in proportion to the most frequent.

    Assumed: the square root, so that rare ones are seen beside a background that is everywhere.
    """
    some = intensities[:: max(1, len(intensities) // MOST_COUNTED)]
    counts, _ = np.histogram(some, bins=len(ACROSS), range=(low, high) if low < high else (low, low + 1))
    shares: Singles = np.sqrt(counts / max(1, counts.max())).astype(np.float32)
    return shares
