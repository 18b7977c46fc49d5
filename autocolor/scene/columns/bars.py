"""Bars: the usual range of a number, and the steps in which it is set by pointing.

A value may lie beyond its bar: the limits of a column are those of its kind.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

STEPS: Final = 100
"""Assumed: a bar has at least as many steps, so that a change by one is small."""

DIGITS: Final = 12
"""Digits of a rounded value: enough for any step, and few enough to write 0.3 as 0.3."""


class Bar(NamedTuple):
    """A usual range, `low` to `high`, and a step; values on it are multiples of the step, or its ends."""

    low: float
    high: float
    step: float

    def rounded(self, value: float) -> float:
        """The nearest value on the bar; halves are rounded up, and values beyond an end become that end.

        >>> Bar(0, 2, 0.01).rounded(0.2987), Bar(1, 90, 1).rounded(0)
        (0.3, 1.0)
        """
        within = min(max(value, self.low), self.high)
        on_step = float(f"{math.floor(within / self.step + 0.5) * self.step:.{DIGITS}g}")
        return float(min(max(on_step, self.low), self.high))

    def fraction(self, value: float) -> float:
        """How far along the bar a value is, 0 to 1."""
        return (min(max(value, self.low), self.high) - self.low) / (self.high - self.low)

    def at(self, fraction: float) -> float:
        """The value on the bar at a fraction of its length, 0 to 1; others are beyond the ends.

        >>> Bar(-180, 180, 1).at(0.5)
        0.0
        """
        return self.rounded(self.low + fraction * (self.high - self.low))


def bar_within(low: float, high: float) -> Bar:
    """The bar of a range, low < high, with at least STEPS steps of 1, 2 or 5 times a power of ten.

    >>> bar_within(0, 180)
    Bar(low=0, high=180, step=1.0)
    """
    most = (high - low) / STEPS
    power = 10.0 ** math.floor(math.log10(most))
    # A step may exceed its bound by no more than rounding: 0.01 is a hundredth of 1.
    step = max((each * power for each in (1, 2, 5, 10) if each * power <= most * (1 + 1e-9)), default=power)
    return Bar(low, high, float(f"{step:.{DIGITS}g}"))
