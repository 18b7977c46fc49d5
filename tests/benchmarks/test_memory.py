from __future__ import annotations

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


def test_the_peak_stays_when_memory_is_given_back() -> None:
    forget_peak()
    before = peak()
    np.ones(64 << 20, np.uint8)
    assert peak() - before == pytest.approx(64, abs=2)


def test_a_forgotten_peak_is_counted_anew() -> None:
    np.ones(64 << 20, np.uint8)
    before = peak()
    forget_peak()
    assert before - peak() > 50


def test_a_small_process_started_by_a_large_one_is_small() -> None:
    large = np.ones(256 << 20, np.uint8)
    command = [sys.executable, "-c", PEAK]
    small = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert float(small) < 100
    assert large.all()
