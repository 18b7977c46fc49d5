"""The rows of the menu for the limits of a scalar, which are set along its own range."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from autocolor.mapping.band_division import own_limits
from autocolor.scene.columns.bars import bar_within
from autocolor.scene.scalars.scalar import Scalar
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Button, Switch, Widget

LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of the limits, as a share of the scalar's own range."""

PutLimits = Callable[[tuple[float, float] | None], object]


def limit_rows(session: Session, scalar: Scalar, put: PutLimits) -> list[Widget]:
    """A switch for the scalar's own range, the two limits, and limits that are symmetric around zero."""
    own_low, own_high = own_limits(session.studio.picture)
    # The range is of float32: a scene file should say 0.1, and not 0.10000000149011612.
    own = float(str(np.float32(own_low))), float(str(np.float32(own_high)))
    low, high = scalar.limits or own
    usual = bar_within(*own)
    least = LEAST_SHARE * (own[1] - own[0])
    far = max(abs(low), abs(high))
    return [
        Switch(
            "own range",
            f"Let the bands be from the least value, {own[0]:.5g}, to the largest, {own[1]:.5g}.",
            is_on=scalar.limits is None,
            flip=lambda: put(own if scalar.limits is None else None),
        ),
        Bar(
            "low limit",
            "Where the first band begins.",
            value=low,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=lambda value: put((min(value, high - least), high)),
        ),
        Bar(
            "high limit",
            "Where the last band ends.",
            value=high,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=lambda value: put((low, max(value, low + least))),
        ),
        Button(
            "around zero",
            "Limits as far below zero as above, as a scale with a light middle needs.",
            run=lambda: put((-far, far)),
        ),
    ]
