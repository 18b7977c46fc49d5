"""Watching the picture come in, through the viewer and without a window."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor.mapping.ranges import BACKGROUND
from autocolor.screens.picture.watching import MESSAGE, PICTURE_SECONDS, TICK_SECONDS
from autocolor.screens.viewer import Viewer
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand, has_the_same
from tests.small import SMALL, car

CLOSE = car().with_view(field_of_view=8.0)
"""A scene that is seen on every line, so that each one that is not there is missed."""


class Clock:
    """A clock that goes on only when it is set, and by `step` whenever it is read."""

    def __init__(self) -> None:
        self.now = 100.0
        self.step = 0.0

    def __call__(self) -> float:
        self.now += self.step
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr("time.monotonic", clock)
    return clock


@pytest.fixture
def hand(tmp_path: Path, clock: Clock) -> Hand:
    del clock
    return Hand(Viewer(CLOSE, Ramtek9300(SMALL), tmp_path))


def lines_there(hand: Hand) -> int:
    """How many lines of the picture have come in; all others must be background."""
    words, picture = hand.display.words, hand.viewer.studio.words
    is_there = (words == picture).all(axis=1).tolist()
    count = is_there.index(False) if False in is_there else len(picture)
    assert (words[count:] == BACKGROUND).all()
    return count


def after(hand: Hand, clock: Clock, part: float) -> int:
    """Tick once when a part of the time of a whole picture is over; how many lines are there then."""
    clock.now += part * PICTURE_SECONDS
    hand.viewer.on_tick()
    return lines_there(hand)


@pytest.fixture
def watching(hand: Hand, clock: Clock) -> Hand:
    """A hand before a picture of which half has come in."""
    hand.press("w")
    assert after(hand, clock, 0.5) == 12
    return hand


def test_the_picture_is_blanked_and_comes_in_line_by_line(hand: Hand, clock: Clock) -> None:
    display, viewer = hand.display, hand.viewer
    assert (viewer.studio.words != BACKGROUND).any(axis=1).all()
    hand.press("w")
    written, entries = display.frame_buffer.written, display.lookup_table.written
    assert lines_there(hand) == 0
    assert viewer.caption.endswith(MESSAGE)
    assert after(hand, clock, 0.5 / 24) == 1
    for line in range(1, 24):
        assert after(hand, clock, 1 / 24) == line + 1
    assert MESSAGE not in viewer.caption
    # Each word is sent once, and no entry.
    after(hand, clock, 1)
    assert display.frame_buffer.written - written == viewer.studio.words.size
    assert display.lookup_table.written == entries


# What is computed between two looks at the clock takes a share of a tick.
@pytest.mark.parametrize(("share", "most"), [(0.33, 3), (0.49, 2), (0.9, 1)])
def test_a_tick_begins_no_line_after_its_time(hand: Hand, clock: Clock, share: float, most: int) -> None:
    hand.press("w")
    clock.step = TICK_SECONDS * share
    counts = [0]
    while counts[-1] < 24:
        counts.append(after(hand, clock, 10))
    assert set(np.diff(counts[:-1]).tolist()) == {most}


ENDINGS: dict[str, Callable[[Hand], object]] = {
    "escape": lambda hand: hand.press("escape"),
    "w": lambda hand: hand.press("w"),
    "a key that does nothing": lambda hand: hand.press("q"),
    "a click": lambda hand: hand.viewer.on_pointer(5, 5, "press", 1),
    "the right button": lambda hand: hand.viewer.on_pointer(5, 5, "press", 3),
}
EDITS: dict[str, Callable[[Hand], object]] = {
    "left": lambda hand: hand.press("left"),
    "left held down": lambda hand: hand.press("left", repeated=True),
    "a light": lambda hand: hand.press("1"),
    "the wheel": lambda hand: hand.viewer.on_pointer(5, 5, "wheel up"),
}


@pytest.mark.parametrize("name", ENDINGS)
def test_the_whole_picture_is_shown_at_once(watching: Hand, clock: Clock, name: str) -> None:
    scene = watching.scene
    ENDINGS[name](watching)
    assert lines_there(watching) == after(watching, clock, 0.1) == 24
    assert MESSAGE not in watching.viewer.caption
    assert watching.scene is scene
    assert not watching.press("escape")


def test_the_mouse_moving_and_the_key_held_down_do_not_end_watching(watching: Hand) -> None:
    watching.viewer.on_pointer(9, 5, "move")
    assert watching.press("w", repeated=True)
    assert lines_there(watching) == 12


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_shows_the_whole_picture_and_is_done(watching: Hand, name: str) -> None:
    before = watching.scene
    EDITS[name](watching)
    watching.viewer.on_tick()
    assert watching.scene is not before
    fresh = Ramtek9300(SMALL)
    Studio(watching.scene, fresh)
    assert has_the_same(watching.display, fresh)
    watching.press("Ctrl+Z", "Alt+Left")
    assert watching.scene.equals(before)


@pytest.mark.parametrize("page", ["f1", "f4"])
def test_a_page_covers_all_of_a_picture_that_comes_in(watching: Hand, clock: Clock, page: str) -> None:
    watching.press(page, "w")
    # From a page, watching returns to the picture.
    assert (watching.viewer.page, lines_there(watching)) == ("picture", 0)
    watching.press(page)
    words = watching.display.words.copy()
    clock.now += 0.3 * PICTURE_SECONDS
    watching.viewer.on_tick()
    assert np.array_equal(watching.display.words, words)
    watching.press(page)
    assert lines_there(watching) == 24


def test_the_picture_is_watched_by_a_row_of_the_menu_and_any_pick_shows_it(tmp_path: Path) -> None:
    # A legend stands over the picture, and comes back with it.
    hand = Hand(Viewer(car().with_scalar(name="stress"), Ramtek9300(), tmp_path))
    hand.open_menu()
    hand.pick("watch")
    assert not np.array_equal(hand.display.words, hand.viewer.studio.words)
    assert MESSAGE in hand.viewer.caption
    hand.click(10, 10)
    assert MESSAGE not in hand.viewer.caption
    assert hand.shows(hand.scene)
