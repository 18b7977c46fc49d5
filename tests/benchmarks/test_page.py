from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import page
from benchmarks.cases import spread
from benchmarks.targets import MISSED


def test_without_a_browser_the_page_is_not_measured(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(page, "CHROMIUM", str(tmp_path / "chromium"))
    measured = page.measure(quick=True)
    assert page.text(measured).startswith("skipped: ")
    assert measured["targets"] == []


def test_a_change_that_takes_too_long_misses_its_target(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "find_spec", lambda name: name)
    monkeypatch.setattr(page, "CHROMIUM", __file__)
    monkeypatch.setattr(page, "page_kilobytes", lambda lights=False: 150.0)
    monkeypatch.setattr(
        page, "change_seconds", lambda rounds, changes: {each.name: spread([0.0041]) for each in changes}
    )
    measured = page.measure(quick=True)
    assert [row["verdict"] for row in measured["targets"]] == [MISSED]
    assert "4.1" in page.text(measured)
    assert "MISSED" in page.text(measured)
