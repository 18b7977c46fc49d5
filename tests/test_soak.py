"""What `python -m tests.soak` says of the samples that it took."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.soak import Sample, Subject

MINUTES = 60


@pytest.mark.parametrize(
    ("megabytes", "descriptors", "end"),
    [
        (lambda minute: 100 + min(minute, 30), lambda _: 6, "0 faults, started again 0 times"),
        (lambda minute: 100 + 2 * minute, lambda _: 6, "; LEAK"),
        (lambda _: 100, lambda minute: 6 + minute // 10, "; +6 descriptors"),
    ],
)
def test_memory_that_grows_to_the_end_and_descriptors_that_stay_are_leaks(
    megabytes: Callable[[int], float], descriptors: Callable[[int], int], end: str
) -> None:
    subject = Subject.__new__(Subject)
    subject.name, subject.faults, subject.ends = "studio", [], 0
    subject.samples = [
        Sample(60 * minute, 1, megabytes(minute), descriptors(minute), 2, 0, 0, 10 * minute)
        for minute in range(MINUTES + 1)
    ]
    text, leaks = subject.verdict(60 * MINUTES)
    assert text.endswith(end)
    assert leaks == (";" in end)
