"""What a user does, at a console that has no window."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.monitor.console import Console, Key, Pointer


class PlainConsole(Console):
    """A console whose window is a list of what it was asked for."""

    asked: list[str]

    def close(self) -> None:
        self.asked.append("close")

    def toggle_full_screen(self) -> None:
        self.full_screen = not self.full_screen
        self.asked.append("toggle")

    def show_message(self, message: str) -> None:
        self.asked.append(message)


@pytest.fixture
def console(tmp_path: Path) -> PlainConsole:
    made = PlainConsole(Ramtek9300(), screenshots=tmp_path)
    made.asked = []
    return made


def test_a_key_that_nobody_takes_does_nothing_but_escape_closes(console: PlainConsole) -> None:
    taken: list[Key] = []
    console.on_key = taken.append
    console.handle_key(Key("a", "a"))
    assert (taken, console.asked) == ([Key("a", "a")], [])
    console.handle_key(Key("escape"))
    assert console.asked == ["close"]


def test_escape_goes_to_whoever_takes_it(console: PlainConsole) -> None:
    console.on_key = lambda key: key.name == "escape"
    console.handle_key(Key("escape"))
    assert console.asked == []


def test_escape_leaves_full_screen_before_it_closes(console: PlainConsole) -> None:
    for _ in range(2):
        console.handle_key(Key("f11"))
        console.handle_key(Key("escape"))
    console.handle_key(Key("return", alt=True))
    assert console.asked == ["toggle"] * 5
    assert console.full_screen


@pytest.mark.parametrize("key", [Key("left shift"), Key("right ctrl"), Key("left meta")])
def test_a_modifier_alone_is_told_to_nobody(console: PlainConsole, key: Key) -> None:
    taken: list[Key] = []
    console.on_key = taken.append
    console.handle_key(key)
    assert taken == []


def test_a_window_stays_when_its_owner_wants_it_to(console: PlainConsole) -> None:
    answers = [False, True]
    console.on_close = lambda: answers.pop(0)
    console.handle_key(Key("q", control=True))
    assert console.asked == []
    console.handle_key(Key("q", control=True))
    assert console.asked == ["close"]


def test_a_screenshot_takes_the_next_free_number(console: PlainConsole, tmp_path: Path) -> None:
    (tmp_path / "ramtek-0001.png").write_bytes(b"kept")
    console.display.send(instructions.load_entries(0, [[9, 8, 7]]))
    console.handle_key(Key("f12"))
    path = (tmp_path / "ramtek-0002.png").resolve()
    assert console.asked == [f"saved {path}"]
    assert (tmp_path / "ramtek-0001.png").read_bytes() == b"kept"
    with Image.open(path) as picture:
        assert picture.getpixel((0, 0)) == (9, 8, 7)


def test_a_screenshot_that_cannot_be_saved_is_a_message_to_the_owner(console: PlainConsole) -> None:
    told: list[str] = []
    console.on_message = told.append
    console.screenshots = Path("/none/at/all")
    console.handle_key(Key("f12"))
    assert console.asked == []
    assert len(told) == 1
    assert told[0].startswith("an output must have a folder to be in")


def test_the_mouse_moves_the_joystick_and_its_buttons_are_the_switches(console: PlainConsole) -> None:
    told: list[Pointer] = []
    console.on_pointer = told.append
    console.handle_pointer(30, 40, "move")
    console.handle_pointer(31, 41, "press", 1)
    console.handle_pointer(32, 42, "press", 3)
    joystick = console.display.joystick
    assert joystick.position == (32, 42)
    assert joystick.track
    assert console.display.cursors.enter_is_pressed
    console.handle_pointer(32, 42, "release", 3)
    console.handle_pointer(33, 43, "release", 1)
    assert not joystick.track
    assert [(pointer.enter, pointer.action, pointer.button) for pointer in told] == [
        (False, "move", 0),
        (True, "press", 1),
        (True, "press", 3),
        (True, "release", 3),
        (False, "release", 1),
    ]
