from __future__ import annotations

import pytest

from benchmarks.movement import Log, Span, figures, text


def test_the_figures_of_a_movement_are_those_of_its_own_fields() -> None:
    log = Log()
    # The key repeats from half a second on; ten fields a second, and one that is late.
    log.fields = [10.0, *(10.5 + 0.1 * step for step in range(40)), 14.6, 20.0]
    log.edits = [10.0, 14.0, 15.02, 17.0]
    log.refined = [9.0, 15.1, 15.3]
    log.held["a key held"] = Span(10.0, 15.0)
    found = figures(log, log.held["a key held"])
    assert found == {
        "fields a second": pytest.approx(40 / 4.1),
        "longest ms between fields": pytest.approx(200),
        "last edit, ms after release": pytest.approx(20),
        "fine picture, ms after release": pytest.approx(100),
    }
    shown = text({"absent": [], "movements": {"a key held": found}})
    assert "longest ms between fields" in shown
    assert "200" in shown


def test_a_missing_program_is_told() -> None:
    assert text({"absent": ["Xvfb"], "movements": {}}) == "skipped: not installed: Xvfb"
