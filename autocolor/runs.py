"""Runs of whole numbers, one after another: the lines of an edge, the pixels of a span, its depths.

And such numbers in parts, of as many as the caches hold of what is worked on.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.int64]


def runs(first: Numbers, count: Numbers, step: Numbers | None = None) -> Numbers:
    """Run after run: `first`, `first` + `step` and so on, `count` numbers of each.

    All are (runs,) int64, every count at least 1; the step is 1 where none is given. It is one running sum,
    which in whole numbers is exact, even where it leaves 64 bits on the way.

    >>> runs(np.array([5, 1]), np.array([3, 2])).tolist()
    [5, 6, 7, 1, 2]
    """
    heads = np.cumsum(count) - count
    total = int(heads[-1] + count[-1]) if len(count) else 0
    # From the last number of a run to the first of the next the sum must make a jump.
    jump = first.copy()
    if step is None:
        numbers = np.ones(total, np.int64)
        jump[1:] -= first[:-1] + count[:-1] - 1
    else:
        numbers = np.repeat(step, count)
        jump[1:] -= first[:-1] + (count[:-1] - 1) * step[:-1]
    numbers[heads] = jump
    return np.cumsum(numbers, out=numbers)


def pieces(stop: int, most: int, start: int = 0) -> Iterator[slice]:
    """The numbers from `start` to before `stop`, at most so many at a time.

    >>> list(pieces(5, 3))
    [slice(0, 3, None), slice(3, 5, None)]
    """
    for first in range(start, stop, most):
        yield slice(first, min(first + most, stop))


def batches(count: Numbers, most: int) -> Iterator[tuple[slice, slice]]:
    """Runs in batches of about `most` numbers: which runs, and which of all their numbers.

    >>> list(batches(np.array([3, 2, 4]), 5))
    [(slice(0, 2, None), slice(0, 5, None)), (slice(2, 3, None), slice(5, 9, None))]
    """
    beyond = np.cumsum(count)
    first, base = 0, 0
    while first < len(beyond):
        last = max(first + 1, int(np.searchsorted(beyond, base + most, side="right")))
        end = int(beyond[last - 1])
        yield slice(first, last), slice(base, end)
        first, base = last, end
