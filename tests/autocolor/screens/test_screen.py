from __future__ import annotations

from pathlib import Path

from autocolor.screens.input import Gesture
from autocolor.screens.screen import Handle, Screen
from tests.autocolor.screens.boards import desk_viewer


def test_a_plain_screen_shows_nothing_and_does_nothing(tmp_path: Path) -> None:
    session = desk_viewer(tmp_path).session
    scene, screen = session.scene, Screen(session)
    assert isinstance(screen.base(), int)
    for nothing in (screen.items(), screen.loads(), screen.rows(), screen.widgets(), screen.handles()):
        assert len(nothing) == 0
    gesture, handle = Gesture("pick", 1, 1), Handle("a", 1, 1, "a")
    screen.enter()
    screen.hold(handle)
    screen.place(handle, 2, 2)
    screen.release()
    screen.pick(gesture)
    screen.drag(gesture, gesture, gesture)
    screen.wheel(gesture)
    screen.leave()
    assert not screen.key("a", "a")
    assert not screen.idle()
    assert session.scene is scene
