"""Held ranges: the rows of the menu for the range of intensities that the exposure holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from autocolor.scene.columns.bars import bar_within
from autocolor.scene.scene import OBJECT, Exposure
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Widget

LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of minimum and maximum, as a share of the bar's range."""

BEYOND: Final = 2.0
"""Assumed: the bars go to twice the largest intensity of the picture."""


def held_rows(session: Session, put: Callable[[Mapping[str, object]], object]) -> list[Widget]:
    """The minimum and the maximum that are held for the chosen surface; none where nothing is held for it."""
    exposure = session.scene.exposure
    name = held_name(exposure, session.surface_name)
    if isinstance(exposure, str) or not name:
        return []
    low, high = dict(exposure)[name]
    # What is held may lie beyond: a bar whose range followed it would run away from a drag.
    usual = bar_within(0.0, BEYOND * (session.studio.image.mapped.ranges.whole.maximum or 1.0))
    least = LEAST_SHARE * usual.high

    def hold(minimum: float, maximum: float) -> object:
        limits = {**dict(exposure), name: (minimum, maximum)}
        return put({"exposure": tuple(limits.items())})

    of = "all surfaces" if name == OBJECT else name
    return [
        Bar(
            "minimum",
            f"The intensity of {of} that is shown by the lowest level.",
            value=low,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=lambda value: hold(max(0.0, min(value, high - least)), high),
        ),
        Bar(
            "maximum",
            f"The intensity of {of} that is shown by the highest level.",
            value=high,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=lambda value: hold(low, max(value, low + least)),
        ),
    ]


def held_name(exposure: Exposure, surface: str) -> str:
    """The name of the held range by which a surface is mapped: its own, or the object's; empty if none is."""
    held = () if isinstance(exposure, str) else [name for name, _ in exposure]
    own = surface if surface != OBJECT else ""
    return next((name for name in (own, OBJECT) if name and name in held), "")
