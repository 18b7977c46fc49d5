"""What a user does, at a console that has no window."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.monitor.console import Console
from ramtek_emu.monitor.input_queue import Close, Key, Pointer, Release


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


def test_a_key_that_is_let_go_is_told_by_its_name_unless_it_is_a_modifier(console: PlainConsole) -> None:
    console.handle(Release("a"))
    told: list[str] = []
    console.on_release = told.append
    for name in ("a", "left shift", "f1"):
        console.handle(Release(name))
    assert told == ["a", "f1"]


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
    assert console.asked == ["", f"saved {path}"]
    assert (tmp_path / "ramtek-0001.png").read_bytes() == b"kept"
    with Image.open(path) as picture:
        assert picture.getpixel((0, 0)) == (9, 8, 7)


def test_a_screenshot_that_cannot_be_saved_is_a_message_to_the_owner(console: PlainConsole) -> None:
    told: list[str] = []
    console.on_message = told.append
    console.screenshots = Path("/none/at/all")
    console.handle_key(Key("f12"))
    assert console.asked == []
    assert told[0] == ""
    assert told[1].startswith("an output must have a folder to be in")


def test_the_mouse_moves_the_joystick_and_its_buttons_are_the_switches(console: PlainConsole) -> None:
    told: list[Pointer] = []
    console.on_pointer = told.append
    console.handle_pointer(Pointer(30, 40, False, "move"))
    console.handle_pointer(Pointer(31, 41, False, "press", 1))
    console.handle_pointer(Pointer(32, 42, False, "press", 3))
    joystick = console.display.joystick
    assert joystick.position == (32, 42)
    assert joystick.track
    assert console.display.cursors.enter_is_pressed
    console.handle_pointer(Pointer(32, 42, False, "release", 3))
    console.handle_pointer(Pointer(33, 43, False, "release", 1))
    assert not joystick.track
    assert [(pointer.enter, pointer.action, pointer.button) for pointer in told] == [
        (False, "move", 0),
        (True, "press", 1),
        (True, "press", 3),
        (True, "release", 3),
        (False, "release", 1),
    ]


def test_the_mouse_and_dropped_files_and_closing_are_told(console: PlainConsole) -> None:
    told: list[object] = []
    console.on_drop = told.append
    console.handle(Path("scene.toml"))
    console.handle(Close())
    assert told == [Path("scene.toml")]
    assert console.asked == ["close"]


def test_escape_leaves_full_screen_before_it_goes_to_the_program(console: PlainConsole) -> None:
    taken: list[Key] = []

    def take(key: Key) -> bool:
        taken.append(key)
        return True

    console.on_key = take
    console.handle_key(Key("f11"))
    console.handle_key(Key("escape"))
    assert (console.full_screen, taken) == (False, [])
    console.handle_key(Key("escape"))
    assert taken == [Key("escape")]


def test_a_window_is_asked_to_close_once_for_each_press(console: PlainConsole) -> None:
    answers = [False, True]
    console.on_close = lambda: answers.pop(0)
    console.handle_key(Key("q", control=True))
    console.handle_key(Key("q", control=True, repeated=True))
    assert answers == [True]
    assert console.asked == []


def test_shortcuts_do_not_repeat(console: PlainConsole) -> None:
    for name in ("f11", "f12", "f1"):
        console.handle_key(Key(name, repeated=True))
    assert console.asked == []
    assert console.overlay.page == ""


def test_a_page_is_shown_over_the_field_unless_the_program_has_its_own(console: PlainConsole) -> None:
    for key, page in (("f1", "help"), ("f4", "entries"), ("f4", ""), ("f1", "help"), ("escape", "")):
        console.handle_key(Key(key))
        assert console.overlay.page == page
    assert console.asked == []
    console.on_key = lambda key: key.name in ("f1", "f4")
    console.handle_key(Key("f1"))
    assert console.overlay.page == ""


def test_a_console_is_at_rest_when_nothing_is_held_and_nothing_waits(console: PlainConsole) -> None:
    assert console.is_at_rest
    for held in (Key("left"), Pointer(1, 2, False, "press", 1)):
        console.input.add(held)
        console.handle(console.input.take())
        assert not console.is_at_rest
        console.input.release_everything()
        while console.input:
            assert not console.is_at_rest
            console.handle(console.input.take())
        assert console.is_at_rest
    console.input.add(Key("left shift"))
    console.input.take()
    assert console.is_at_rest
