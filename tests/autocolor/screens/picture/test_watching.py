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
from tests.autocolor.screens.hand import Hand
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
def viewer(tmp_path: Path, clock: Clock) -> Viewer:
    del clock
    return Viewer(CLOSE, Ramtek9300(SMALL), folder=tmp_path)


def display_of(viewer: Viewer) -> Ramtek9300:
    assert isinstance(viewer.display, Ramtek9300)
    return viewer.display


def lines_there(viewer: Viewer) -> int:
    """How many lines of the picture have come in; all others must be background."""
    words, picture = display_of(viewer).words, viewer.studio.words
    for count in range(len(picture), -1, -1):
        if np.array_equal(words[:count], picture[:count]):
            assert (words[count:] == BACKGROUND).all()
            return count
    raise AssertionError("no lines can be there before the first")


def is_whole(viewer: Viewer) -> bool:
    return np.array_equal(display_of(viewer).words, viewer.studio.words)


def after(viewer: Viewer, clock: Clock, part: float) -> None:
    """Tick once when a part of the time of a whole picture is over."""
    clock.now += part * PICTURE_SECONDS
    viewer.on_tick()


@pytest.fixture
def watching(viewer: Viewer, clock: Clock) -> Viewer:
    """A viewer in which half of the picture has come in."""
    viewer.on_key("w", typed="w")
    after(viewer, clock, 0.5)
    assert lines_there(viewer) == 12
    return viewer


def test_the_picture_is_blanked_and_comes_in_line_by_line(viewer: Viewer, clock: Clock) -> None:
    assert (viewer.studio.words != BACKGROUND).any(axis=1).all()
    viewer.on_key("w", typed="w")
    written, entries = display_of(viewer).frame_buffer.written, display_of(viewer).lookup_table.written
    assert lines_there(viewer) == 0
    assert viewer.caption.endswith(MESSAGE)
    after(viewer, clock, 0.5 / 24)
    assert lines_there(viewer) == 1
    for line in range(1, 24):
        after(viewer, clock, 1 / 24)
        assert lines_there(viewer) == line + 1
    assert is_whole(viewer)
    assert MESSAGE not in viewer.caption
    # Each word is sent once, and no entry.
    after(viewer, clock, 1)
    display = display_of(viewer)
    assert display.frame_buffer.written - written == viewer.studio.words.size
    assert display.lookup_table.written == entries


# What is computed between two looks at the clock takes a share of a tick.
@pytest.mark.parametrize(("share", "most"), [(0.33, 3), (0.49, 2), (0.9, 1)])
def test_a_tick_begins_no_line_after_its_time(viewer: Viewer, clock: Clock, share: float, most: int) -> None:
    viewer.on_key("w", typed="w")
    clock.now += 10 * PICTURE_SECONDS
    clock.step = TICK_SECONDS * share
    counts = []
    while not is_whole(viewer):
        before = lines_there(viewer)
        viewer.on_tick()
        counts.append(lines_there(viewer) - before)
    assert set(counts[:-1]) == {most}
    assert sum(counts) == 24


ENDINGS: dict[str, Callable[[Viewer], object]] = {
    "escape": lambda viewer: viewer.on_key("escape"),
    "w": lambda viewer: viewer.on_key("w", typed="w"),
    "a key that does nothing": lambda viewer: viewer.on_key("q", typed="q"),
    "a click": lambda viewer: viewer.on_pointer(5, 5, "press", 1),
    "the right button": lambda viewer: viewer.on_pointer(5, 5, "press", 3),
}
EDITS: dict[str, Callable[[Viewer], object]] = {
    "left": lambda viewer: viewer.on_key("left"),
    "left held down": lambda viewer: viewer.on_key("left", repeated=True),
    "a light": lambda viewer: viewer.on_key("1", typed="1"),
    "the wheel": lambda viewer: viewer.on_pointer(5, 5, "wheel up"),
}


@pytest.mark.parametrize("name", ENDINGS)
def test_the_whole_picture_is_shown_at_once(watching: Viewer, clock: Clock, name: str) -> None:
    scene = watching.studio.scene
    ENDINGS[name](watching)
    assert is_whole(watching)
    after(watching, clock, 0.1)
    assert is_whole(watching)
    assert MESSAGE not in watching.caption
    assert watching.studio.scene is scene


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_shows_the_whole_picture_and_is_done(watching: Viewer, name: str) -> None:
    before = watching.studio.scene
    EDITS[name](watching)
    watching.on_tick()
    assert watching.studio.scene is not before
    fresh = Ramtek9300(SMALL)
    Studio(watching.studio.scene, fresh)
    assert display_of(watching).words.tolist() == fresh.words.tolist()
    assert display_of(watching).entries.tolist() == fresh.entries.tolist()
    watching.on_key("z", control=True)
    watching.on_key("left", alt=True)
    assert watching.studio.scene.equals(before)


def test_the_mouse_moving_and_the_key_held_down_do_not_end_watching_and_escape_does_first(
    watching: Viewer,
) -> None:
    watching.on_pointer(9, 5, "move")
    assert watching.on_key("w", typed="w", repeated=True)
    assert lines_there(watching) == 12
    assert watching.on_key("escape")
    assert not watching.on_key("escape")


@pytest.mark.parametrize("page", ["f1", "f4"])
def test_a_page_covers_all_of_a_picture_that_comes_in(watching: Viewer, clock: Clock, page: str) -> None:
    watching.on_key(page)
    watching.on_key("w", typed="w")
    # From a page, watching returns to the picture.
    assert (watching.page, lines_there(watching)) == ("picture", 0)
    watching.on_key(page)
    words = display_of(watching).words.copy()
    after(watching, clock, 0.3)
    assert display_of(watching).words.tolist() == words.tolist()
    watching.on_key(page)
    assert is_whole(watching)


def test_the_picture_is_watched_by_a_row_of_the_menu_and_any_pick_shows_it(tmp_path: Path) -> None:
    # A legend stands over the picture, and comes back with it.
    hand = Hand(Viewer(car().with_scalar(name="stress"), Ramtek9300(), tmp_path))
    viewer, display = hand.viewer, hand.display
    hand.open_menu()
    hand.pick("watch")
    assert not np.array_equal(display.words, viewer.studio.words)
    assert "line by line" in viewer.caption
    hand.click(10, 10)
    assert "line by line" not in viewer.caption
    assert hand.shows(hand.scene)
