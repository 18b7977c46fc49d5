from __future__ import annotations

import mmap
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.memory import STATUS, forget_peak, peak

ROOT = Path(__file__).parents[2]
PEAK = "from benchmarks.memory import peak; print(peak())"

pytestmark = pytest.mark.skipif(
    not STATUS.exists(), reason="only Linux tells the peak of a process by itself"
)


def use_and_give_back() -> None:
    """Use 64 MB that the system itself gives: a process that rendered a picture keeps those of an array."""
    with mmap.mmap(-1, 64 << 20) as memory:
        for _ in range(64):
            memory.write(bytes(1 << 20))


def test_the_peak_stays_when_memory_is_given_back() -> None:
    forget_peak()
    before = peak()
    use_and_give_back()
    assert peak() - before == pytest.approx(64, abs=4)


def test_a_forgotten_peak_is_counted_anew() -> None:
    use_and_give_back()
    before = peak()
    forget_peak()
    assert before - peak() > 50


def test_a_small_process_started_by_a_large_one_is_small() -> None:
    large = np.ones(256 << 20, np.uint8)
    command = [sys.executable, "-c", PEAK]
    small = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert float(small) < 100
    assert large.all()
