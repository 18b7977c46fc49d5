from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.errors import UsageError
from autocolor.screens.input import Gesture
from autocolor.screens.screen import Cached, Handle, Screen
from tests.autocolor.screens.boards import desk_hand


def test_a_plain_screen_shows_nothing_and_does_nothing(tmp_path: Path) -> None:
    session = desk_hand(tmp_path).viewer.session
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
    assert screen.sample(1, 1) is None
    assert screen.color_at(1, 1) is None
    with pytest.raises(UsageError, match=r"^this screen takes no color; turn to color mixing$"):
        screen.take_color("red", 1, 1)
    assert session.scene is scene


def test_a_cached_value_is_computed_once_for_the_same_sources() -> None:
    cached: Cached[list[int]] = Cached()
    source = [1]
    first = cached.of(lambda: [2], source, "a")
    assert first == [2]
    assert cached.of(lambda: [3], source, "a") is first
    # An equal source is another one.
    assert cached.of(lambda: [3], [1], "a") == [3]
    assert cached.of(lambda: [4], [1], source) == [4]
    assert cached.of(lambda: [5]) == [5]


def test_a_failed_computation_is_not_cached() -> None:
    cached: Cached[float] = Cached()
    for _ in range(2):
        try:
            cached.of(lambda: 1 / 0, "a")
        except ZeroDivisionError:
            continue
        raise AssertionError
    assert cached.of(lambda: 1.0, "a") == 1.0
