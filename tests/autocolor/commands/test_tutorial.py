from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.commands.tutorial import teach
from autocolor.journal.history import History
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Refused, Run
from tests.small import car


def test_the_panel_stands_over_the_first_screen() -> None:
    display = Ramtek9300()
    viewer = Viewer(car(), display)
    before = display.field()
    teach(viewer)
    labels = [each.label for each in viewer.board.widgets()]
    assert labels == ["skip", "end", "up", "tutorial"]
    panel = viewer.board.widgets()[-1].area
    changed = before != display.field()
    assert changed[panel.top : panel.bottom + 1, panel.left : panel.right + 1].any()
    # The first message of the viewer was at the bottom.
    assert not changed[: panel.top].any()
    assert not changed[panel.bottom + 1 : 464].any()


def test_it_is_taught_on_a_display_elsewhere(
    folder: Path, run: Run, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[str, str, Path, float]] = []

    def session(history: History, address: str, place: Path, prepare: object, timeout: float) -> None:
        assert prepare is teach
        asked.append((history.scene.name, address, place, timeout))

    monkeypatch.setattr("autocolor.commands.tutorial.session_elsewhere", session)
    assert run("tutorial", "--to", "tcp://127.0.0.1:9300", "--timeout", "200").code == 0
    assert asked == [("coupe", "tcp://127.0.0.1:9300", folder, 200.0)]
    refused("tutorial --to 127.0.0.1", 2)
