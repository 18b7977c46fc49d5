"""Clocks that stand still: no picture is coarse and no message passes, however slow the machine is."""

from __future__ import annotations

import time

import pytest


@pytest.fixture(autouse=True)
def _still_clocks(monkeypatch: pytest.MonkeyPatch) -> None:
    now = time.monotonic()
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: 0.0)
    monkeypatch.setattr("time.monotonic", lambda: now)
