from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks import plots
from benchmarks.panels import moved_apart
from benchmarks.points import EDITS, QUANTITIES

SPREAD = {"low": 1.0, "median": 2.0, "high": 4.0}
POINTS = [
    {
        "quantity": name,
        "label": quantity.label(size),
        "polygons": size,
        "lights": size,
        "pixels": size,
        "pixels seen": size // 2,
        "edits ms": dict.fromkeys(EDITS, SPREAD),
        "open ms": 100.0,
        "open MiB": 20.0,
        "edit MiB": 30.0,
    }
    for name, quantity in QUANTITIES.items()
    for size in quantity.sizes
]
SCALING = {"rounds": 1, "points": POINTS}


def target(
    name: str, measured: dict[str, float] | None, bound: float, verdict: str, **more: Any
) -> dict[str, Any]:
    row = {"target": name, "unit": "ms", "measured": measured, "bound": bound, "verdict": verdict}
    return {**row, "at least": False, **more}


AT_MOST = target("one that is met", SPREAD, 5, "met")
AT_LEAST = target("one that is missed", SPREAD, 8, "MISSED", **{"at least": True})
NOTHING = target("one that allows nothing", {"low": 0.0, "median": 0.0, "high": 0.0}, 0, "met")
SKIPPED = target("one that is skipped", None, 1, "skipped")
TARGETS = {
    "targets": [AT_MOST, AT_LEAST, NOTHING, SKIPPED],
    "peers": {"a peer": {"agrees": True}},
    "cases ms": {"whole frame": SPREAD, "a copy": SPREAD, "a peer: whole frame": SPREAD},
}


@pytest.mark.parametrize(("plot", "measured"), [(plots.scaling, SCALING), (plots.targets, TARGETS)])
def test_a_plot_is_written_where_matplotlib_is_installed(plot: Any, measured: Any, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    assert plot(measured, tmp_path / "new" / "plot.png")
    assert (tmp_path / "new" / "plot.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("plot", "measured"), [(plots.scaling, SCALING), (plots.targets, TARGETS)])
def test_without_matplotlib_a_plot_says_that_it_was_not_written(
    plot: Any, measured: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plots, "find_spec", lambda name: None)
    assert not plot(measured, tmp_path / "plot.png")
    assert not list(tmp_path.iterdir())


@given(st.lists(st.floats(0, 100)), st.floats(0.1, 20))
def test_names_that_were_moved_apart_keep_their_order(places: list[float], apart: float) -> None:
    moved = moved_apart(places, apart)
    order = sorted(range(len(places)), key=lambda row: places[row])
    assert all(moved[two] - moved[one] >= apart * (1 - 1e-9) for one, two in pairwise(order))


def test_names_that_are_apart_stay_where_they_are() -> None:
    assert moved_apart([30, 0, 15], 10) == [30, 0, 15]


def test_a_bar_is_longer_to_the_right_the_more_a_bound_is_missed() -> None:
    assert plots.bar_of(AT_MOST).ratio == (0.2, 0.4, 0.8)
    assert plots.bar_of(AT_LEAST).ratio == (2, 4, 8)
    assert plots.bar_of(AT_LEAST).name == "one that is missed \u2265 8 ms"


def test_a_frame_of_another_picture_is_named_so() -> None:
    peers = {"one": {"agrees": True}, "other": {"agrees": False}}
    names = [plots.frame_name(peer, peers) for peer in ("", "one", "other")]
    assert names == [plots.OWN, "one", "other\n(not comparable)"]


def test_a_target_without_a_ratio_has_a_note_instead() -> None:
    assert (plots.bar_of(NOTHING).ratio, plots.bar_of(NOTHING).note) == (None, "0 ms, met")
    assert (plots.bar_of(SKIPPED).ratio, plots.bar_of(SKIPPED).note) == (None, "skipped")
