"""What the benchmarks share: cases taken in turns, with the caches emptied before each, and quartiles."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

CACHES = 48 << 20
WARMING = 2
"""Rounds that are not counted."""


@dataclass(frozen=True)
class Case:
    """Something to time; `before` is run first and not timed."""

    name: str
    run: Callable[[], object]
    before: Callable[[], object] | None = None


class Spread(NamedTuple):
    """The median of some numbers between their quartiles."""

    low: float
    median: float
    high: float

    def times(self, factor: float) -> Spread:
        """The spread of the numbers times a positive factor."""
        return Spread(self.low * factor, self.median * factor, self.high * factor)


def timed(every: Sequence[Case], rounds: int) -> dict[str, list[float]]:
    """Seconds of each case in each round, the cases in turns."""
    # Ones, for of zeros that nobody has written there is only one page to read.
    caches = np.ones(CACHES, np.uint8)
    seconds: dict[str, list[float]] = {case.name: [] for case in every}
    for number in range(rounds + WARMING):
        for case in every:
            if case.before is not None:
                case.before()
            # Read, for lines that were written would have to be put back while the case runs.
            caches.sum()
            begin = time.perf_counter()
            case.run()
            if number >= WARMING:
                seconds[case.name].append(time.perf_counter() - begin)
    return seconds


def spread(numbers: Sequence[float]) -> Spread:
    """The median and the quartiles of one or more numbers.

    >>> spread([1, 2, 3, 4, 5])
    Spread(low=2.0, median=3.0, high=4.0)
    """
    if len(numbers) == 1:
        return Spread(*(float(numbers[0]),) * 3)
    return Spread(*statistics.quantiles(numbers, n=4, method="inclusive"))


def ratios(seconds: Sequence[float], to: Sequence[float]) -> Spread:
    """How many times as long one case takes as another, round by round.

    The two of a round were measured shortly after each other, so that a machine that is slower for a while is
    so for both.

    >>> ratios([2, 6, 20], [1, 2, 10])
    Spread(low=2.0, median=2.0, high=2.5)
    """
    return spread([one / other for one, other in zip(seconds, to, strict=True)])
