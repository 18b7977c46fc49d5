from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.events import (
    CASES,
    CASES_OF_MANY,
    WARMING,
    AbsentError,
    Bench,
    Case,
    Shown,
    at,
    drag,
    figures,
    key,
    menu,
    opened,
    row,
    text,
)
from ramtek_emu.monitor.input_queue import Key
from tests.small import car

pytest.importorskip("pygame")


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    with opened(car(), tmp_path) as found:
        yield found


def test_the_time_of_an_event_is_that_until_its_field(bench: Bench) -> None:
    fields = bench.monitor.refreshed
    shown = bench.shown(at((639, 60)))
    assert shown.came
    assert 0 < shown.wall < 2
    assert bench.monitor.refreshed == fields + 1
    assert bench.viewer.board.has_menu


def test_an_event_that_shows_nothing_is_told(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmarks.events.GIVEN_UP", 0.05)
    bench.monitor.on_key = lambda _: True
    shown = bench.shown(Key("x", "x"))
    assert (shown.wall, shown.came) == (0.05, False)
    assert figures([shown, Shown(0.001, 0.001, True)], 10)["without a field"] == 1


def test_what_is_dragged_is_found_by_its_label_and_edits_the_scene(bench: Bench) -> None:
    before = bench.viewer.studio.scene
    found = row(Case("intensity", "lights", 1000, drag("intensity")), bench, 3)
    assert found["verdict"] == "met"
    assert found["left over"] == 0
    assert bench.viewer.studio.scene.light("key") != before.light("key")
    assert bench.viewer.studio.scene.view == before.view
    # However many events a drag has, it is one step.
    assert len(bench.viewer.studio.history.to_undo) == 1


@pytest.mark.parametrize(
    ("screen", "label", "reason"),
    [
        ("none", "intensity", "there is no screen 'none'"),
        ("lights", "none", "nothing is called 'none' on the screen 'lights'"),
    ],
)
def test_a_case_whose_screen_or_widget_is_not_there_is_skipped(
    bench: Bench, screen: str, label: str, reason: str
) -> None:
    found = row(Case("a case", screen, 10, drag(label)), bench, 3)
    assert (found["verdict"], found["reason"]) == ("skipped", reason)
    with pytest.raises(AbsentError):
        bench.place("none")


def test_the_menu_goes_before_it_comes_again_and_keys_are_released(bench: Bench) -> None:
    assert len(list(menu(bench, 3))) == 3
    assert all(each.came for each in key("c")(bench, 3))
    assert len(bench.viewer.studio.history.to_undo) == 3
    assert bench.monitor.input.down == frozenset()


def test_the_limit_is_for_the_median() -> None:
    shown = [Shown(wall / 1e3, 0.002, True) for wall in (3.0, 4.0, 90.0)]
    assert figures(shown, 4.0) == {
        "median": pytest.approx(4.0),
        "worst": pytest.approx(90.0),
        "processor": pytest.approx(2.0),
        "without a field": 0,
        "verdict": "met",
    }
    assert figures(shown, 3.9)["verdict"] == "MISSED"


def test_each_line_tells_the_limit_and_the_share_of_it() -> None:
    met = {"scene": "the coupe", "case": "color", "limit": 4} | figures([Shown(0.002, 0.001, True)], 4)
    skipped = {"scene": "the coupe", "case": "blend", "limit": 4, "verdict": "skipped", "reason": "none"}
    shown = text({"absent": [], "targets": [met | {"left over": 0}, skipped]})
    assert shown.splitlines()[1].split() == ["color", "4", "2.0", "0.50", "2.0", "1.0", "0", "met"]
    assert shown.splitlines()[2].split() == ["blend", "4", "skipped:", "none"]


def test_the_cases_have_names_of_their_own_and_events_that_are_not_counted() -> None:
    for cases in (CASES, CASES_OF_MANY):
        assert len({case.name for case in cases}) == len(cases)
    assert WARMING > 0
