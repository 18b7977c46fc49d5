"""What the benchmarks share: cases that are taken in turns, with the caches emptied before each."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

CACHES = 48 << 20
WARMING = 2
"""Rounds that are not counted."""


@dataclass(frozen=True)
class Case:
    """Something to time; `most` is its target as (what it is compared with, the largest ratio).

    `before` is run first and not timed.
    """

    name: str
    run: Callable[[], object]
    most: tuple[str, float] | None = None
    before: Callable[[], object] | None = None


def timed(every: Sequence[Case], rounds: int) -> dict[str, list[float]]:
    """Seconds of each case in each round, the cases in turns."""
    caches = np.zeros(CACHES, np.uint8)
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
