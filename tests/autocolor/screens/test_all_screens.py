from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor.screens.all_screens import SCREENS
from autocolor.screens.screen import Screen
from autocolor.screens.viewer import Viewer
from autocolor.widgets.sheet import Sheet
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import wall_scene
from tests.autocolor.screens.boards import point


def test_every_screen_has_a_name_and_a_title_of_its_own_and_help() -> None:
    for told in ([each.name for each in SCREENS], [each.title for each in SCREENS]):
        assert all(told)
        assert len(set(told)) == len(told)
    assert all(each.help for each in SCREENS)


@pytest.mark.parametrize("lights", [None, []], ids=["a light", "no light"])
@pytest.mark.parametrize("screen", SCREENS, ids=[each.name for each in SCREENS])
def test_every_screen_is_drawn_hovered_and_left_without_a_trace(
    screen: type[Screen], lights: list[object] | None, tmp_path: Path
) -> None:
    display = Ramtek9300()
    scene = wall_scene() if lights is None else wall_scene(lights=lights)
    viewer = Viewer(scene, display, folder=tmp_path)
    viewer.tell("")
    words, entries = display.words.copy(), display.entries.copy()
    viewer.session.turn_to(screen.name)
    viewer.tell("")
    for element, line in ((560, 40), (560, 200), (300, 200), (100, 400), (5, 475)):
        point(viewer, "hover", element, line)
        fresh = Ramtek9300()
        Sheet(fresh).show(viewer.board.page())
        assert np.array_equal(display.words, fresh.words)
        assert np.array_equal(display.entries, fresh.entries)
    viewer.session.turn_to("picture")
    viewer.tell("")
    assert np.array_equal(display.words, words)
    assert np.array_equal(display.entries, entries)
    assert viewer.studio.scene is scene
