"""What a page looks like is tried through the board, in test_board.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor.screens.board.composition import with_loads
from autocolor.screens.board.message_line import MESSAGE
from autocolor.screens.viewer import Viewer
from autocolor.widgets.areas import SCREEN
from autocolor.widgets.items import filled
from tests.autocolor.screens.boards import desk_viewer


def test_entries_without_loads_are_the_same_array() -> None:
    entries = np.zeros((1024, 3), np.uint8)
    assert with_loads(entries, []) is entries


def test_loads_replace_runs_and_leave_the_entries_as_they_were() -> None:
    entries = np.zeros((1024, 3), np.uint8)
    table = with_loads(entries, [(5, np.full((3, 3), 9, np.uint8)), (7, np.full((2, 3), 4, np.uint8))])
    assert table[4:10, 0].tolist() == [0, 9, 9, 4, 4, 0]
    assert not entries.any()


def test_a_message_stands_over_all_that_a_screen_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer: Viewer = desk_viewer(tmp_path)
    viewer.tell("a message")
    told = [item for item in viewer.board.page().items if MESSAGE.covers(item.area)]
    monkeypatch.setattr(viewer.board.screen, "items", lambda: [filled(SCREEN, 3)])
    items = list(viewer.board.page().items)
    assert items.index(filled(SCREEN, 3)) < min(items.index(item) for item in told)
