"""The window on a virtual screen (Xvfb), and its keys and mouse without a screen."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from PIL import Image

from ramtek_emu import GMR_9300, Ramtek9300, instructions
from ramtek_emu.arrays import Colors
from ramtek_emu.monitor.glass import viewport
from ramtek_emu.monitor.input_queue import Close
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.monitor.window import Key, Monitor, Pointer
from tests.ramtek_emu.displays import shown
from tests.ramtek_emu.film_reader import decoded, durations_of

QUIT = (pygame.K_q, "\x11", pygame.KMOD_LCTRL)


@pytest.fixture
def monitor(on_screen: str, tmp_path: Path) -> Iterator[Monitor]:
    """An open window on the test pattern."""
    display = Ramtek9300()
    display.send(pattern())
    monitor = Monitor(display, screenshots=tmp_path)
    monitor.open()
    settle(monitor)
    yield monitor
    monitor.close()


@pytest.fixture
def messages(monitor: Monitor) -> list[str]:
    """The messages of the window."""
    told: list[str] = []
    monitor.on_message = told.append
    return told


def settle(monitor: Monitor) -> None:
    for _ in range(10):
        monitor.step(5)


def resize(monitor: Monitor, size: tuple[int, int]) -> None:
    pygame.display.set_mode(size, pygame.RESIZABLE)
    pygame.event.post(pygame.event.Event(pygame.WINDOWEXPOSED))
    settle(monitor)


def post(kind: int, **values: Any) -> None:
    pygame.event.post(pygame.event.Event(kind, **values))


def press(monitor: Monitor, key: int, text: str = "", mod: int = 0) -> None:
    post(pygame.KEYDOWN, key=key, unicode=text, mod=mod)
    post(pygame.KEYUP, key=key, mod=mod)
    monitor.step()


def load(monitor: Monitor, red: int) -> None:
    """Load an entry that the test pattern shows."""
    monitor.display.send(instructions.load_entries(9, [[red, 100, 50]]))


@pytest.mark.parametrize(("size", "multiple"), [((641, 487), 1), ((1399, 1001), 2)])
def test_every_pixel_is_a_block_at_every_window_size(
    monitor: Monitor, size: tuple[int, int], multiple: int
) -> None:
    resize(monitor, size)
    blocks = np.repeat(np.repeat(monitor.display.field(), multiple, axis=0), multiple, axis=1)
    left, top, *_ = viewport((640, 480), size)
    expected = np.zeros((size[1], size[0], 3), np.uint8)
    expected[top : top + len(blocks), left : left + len(blocks[0])] = blocks
    assert np.array_equal(shown(), expected)


def test_the_window_refreshes_only_when_something_was_written(monitor: Monitor) -> None:
    before = monitor.refreshed
    settle(monitor)
    assert monitor.refreshed == before
    load(monitor, 200)
    monitor.step()
    assert monitor.refreshed == before + 1
    monitor.display.send(np.array([0x0700], np.uint16))
    monitor.step()
    assert monitor.refreshed == before + 1


def test_full_screen_keeps_whole_multiples_and_the_window_s_size(monitor: Monitor) -> None:
    size = pygame.display.get_window_size()
    press(monitor, pygame.K_F11)
    settle(monitor)
    assert pygame.display.get_window_size() == (1400, 1100)
    assert (shown()[70 : 70 + 960, 60 : 60 + 1280][::2, ::2] == monitor.display.field()).all()
    press(monitor, pygame.K_RETURN, "\r", pygame.KMOD_LALT)
    settle(monitor)
    assert pygame.display.get_window_size() == size


def test_the_field_fills_the_window_and_is_a_whole_multiple_again(
    monitor: Monitor, messages: list[str]
) -> None:
    resize(monitor, (1000, 900))
    assert (shown()[210:690, 180:820] == monitor.display.field()).all()
    press(monitor, pygame.K_F10)
    settle(monitor)
    assert monitor.glass.fit
    assert (shown()[75:825].any(axis=2).mean(axis=0) > 0).all()
    press(monitor, pygame.K_F10)
    settle(monitor)
    assert (shown()[210:690, 180:820] == monitor.display.field()).all()
    assert messages == ["the picture fills the window", "the picture at a whole multiple"]


def test_keys_and_their_releases_are_handed_over_as_plain_values(monitor: Monitor) -> None:
    given: list[object] = []

    def take(key: Key) -> bool:
        given.append(key)
        return True

    monitor.on_key, monitor.on_release = take, given.append
    press(monitor, pygame.K_a, "a")
    press(monitor, pygame.K_z, "\x1a", pygame.KMOD_LCTRL | pygame.KMOD_LSHIFT)
    press(monitor, pygame.K_LSHIFT)
    press(monitor, pygame.K_ESCAPE)
    # The release is also reported when another window gets the keyboard.
    post(pygame.KEYDOWN, key=pygame.K_b, unicode="b", mod=pygame.KMOD_RALT)
    post(pygame.WINDOWFOCUSLOST)
    post(pygame.KEYUP, key=pygame.K_b, mod=0)
    monitor.step()
    assert given == [
        Key("a", "a"), "a",
        Key("z", "\x1a", control=True, shift=True), "z",
        Key("escape"), "escape",
        Key("b", "b", alt=True), "b",
    ]  # fmt: skip
    assert monitor.is_at_rest
    assert monitor.is_open


def test_a_field_is_shown_between_any_two_keys_and_between_press_and_release(monitor: Monitor) -> None:
    resize(monitor, (640, 480))
    monitor.on_key = lambda key: load(monitor, ord(key.text))
    monitor.on_release = lambda name: load(monitor, ord(name) - 32)
    for key, text in ((pygame.K_a, "a"), (pygame.K_b, "b")):
        post(pygame.KEYDOWN, key=key, unicode=text, mod=0)
    post(pygame.KEYUP, key=pygame.K_b, mod=0)
    before = monitor.refreshed
    for number, letter in enumerate("abB", 1):
        monitor.step()
        assert monitor.refreshed == before + number
        assert monitor.display.entries[9, 0] == ord(letter)
        assert np.array_equal(shown(), monitor.display.field())


def test_closing_asks_whoever_drives_the_display(monitor: Monitor) -> None:
    answers = [False, False, True]
    monitor.on_close = lambda: answers.pop(0)
    press(monitor, *QUIT)
    post(pygame.QUIT)
    assert monitor.step() is True
    assert monitor.is_open
    post(pygame.QUIT)
    assert monitor.step() is False
    assert not monitor.is_open
    assert not answers


class Clock:
    """The time of the monitor."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        monkeypatch.setattr("time.monotonic", lambda: self.now)


def title() -> str:
    return str(pygame.display.get_caption()[0])


def show_load(monitor: Monitor, red: int) -> Colors:
    """The field after a load that was shown."""
    load(monitor, red)
    monitor.step()
    return monitor.display.field()


def test_a_recording_has_the_fields_that_were_shown_with_their_times(
    monitor: Monitor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock(monkeypatch)
    (tmp_path / "ramtek-0001.webp").write_bytes(b"mine")
    fields = [show_load(monitor, 10)]
    press(monitor, pygame.K_F3)
    assert title() == "RAMTEK 9300 - recording - F3 ends it"
    settle(monitor)
    assert tuple(shown()[-6, -6]) == (240, 60, 60)
    clock.now += 0.2
    press(monitor, pygame.K_F1)
    for seconds, red in ((0.05, 20), (0.25, 30), (0.1, 20)):
        clock.now += seconds
        fields.append(show_load(monitor, red))
        # What the window shows again is no new field.
        settle(monitor)
    clock.now += 0.5
    press(monitor, pygame.K_F3)
    path = tmp_path / "ramtek-0002.webp"
    assert title() == f"RAMTEK 9300 - saved {path.resolve()}, 4 fields"
    assert np.array_equal(decoded(path), fields)
    assert durations_of(path) == [250, 250, 100, 500]
    assert (tmp_path / "ramtek-0001.webp").read_bytes() == b"mine"
    show_load(monitor, 40)
    monitor.caption = "another"
    assert title() == "another"


def test_in_full_screen_a_message_stands_over_the_field_for_a_while_and_in_no_film(
    monitor: Monitor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    press(monitor, pygame.K_F11)
    settle(monitor)
    clock = Clock(monkeypatch)
    before = shown().copy()
    press(monitor, pygame.K_F3)
    assert monitor.overlay.message == "F3 ends it"
    settle(monitor)
    assert not np.array_equal(shown()[-200:], before[-200:])
    assert np.array_equal(shown()[: 70 + 464 * 2], before[: 70 + 464 * 2])
    clock.now += 60
    monitor.step()
    # The mark of the film alone is left.
    assert np.array_equal(shown()[: 70 + 464 * 2], before[: 70 + 464 * 2])
    assert np.array_equal(shown()[:, : 60 + 620 * 2], before[:, : 60 + 620 * 2])
    press(monitor, pygame.K_F3)
    assert np.array_equal(decoded(tmp_path / "ramtek-0001.webp"), [monitor.display.field()])


def test_a_recording_that_is_full_is_saved(
    monitor: Monitor, messages: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ramtek_emu.films.MOST_FIELDS", 3)
    fields = [monitor.display.field()]
    press(monitor, pygame.K_F3)
    fields += [show_load(monitor, red) for red in (10, 20, 30)]
    path = tmp_path / "ramtek-0001.webp"
    assert messages == [f"the film is full: saved {path.resolve()}, 3 fields"]
    monitor.caption = "RAMTEK"
    assert title() == "RAMTEK"
    assert np.array_equal(decoded(path), fields[:3])


@pytest.mark.parametrize("way", ["close", "key"])
def test_closing_the_window_saves_the_recording(
    monitor: Monitor, tmp_path: Path, way: str, capsys: pytest.CaptureFixture[str]
) -> None:
    press(monitor, pygame.K_F3)
    if way == "close":
        monitor.close()
    else:
        press(monitor, *QUIT)
    assert not monitor.is_open
    path = tmp_path / "ramtek-0001.webp"
    assert np.array_equal(decoded(path), [monitor.display.field()])
    assert capsys.readouterr().err == f"saved {path.resolve()}, 1 field\n"
    monitor.close()
    assert [path.name for path in tmp_path.iterdir()] == ["ramtek-0001.webp"]


def test_a_recording_that_cannot_be_saved_goes_to_another_folder(
    monitor: Monitor,
    messages: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monitor.screenshots, elsewhere = tmp_path / "never", tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(elsewhere))
    fields = [monitor.display.field()]
    press(monitor, pygame.K_F3)
    fields.append(show_load(monitor, 10))
    press(monitor, pygame.K_F3)
    path = elsewhere / "ramtek-0001.webp"
    assert messages[0].endswith(f"; saved {path.resolve()}, 2 fields")
    assert np.array_equal(decoded(path), fields)
    # Without any folder, the film is lost.
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "full"))
    press(monitor, pygame.K_F3)
    press(monitor, *QUIT)
    assert capsys.readouterr().err.endswith("the film is lost: no folder could take it\n")


def test_f2_shows_the_words_through_tables_of_grays(monitor: Monitor, messages: list[str]) -> None:
    own = monitor.display.field()
    seen = []
    for _ in range(3):
        press(monitor, pygame.K_F2)
        settle(monitor)
        seen.append(monitor.display.scan_out.shown_table)
        assert np.array_equal(monitor.display.field(), own) == (not seen[-1])
    assert seen == ["gray", "gray8", ""]
    assert messages == ["the table gray", "the table gray8", "the display's table"]
    monitor.on_key = lambda _: False
    press(monitor, pygame.K_F2)
    assert monitor.display.scan_out.shown_table == ""


def test_the_mouse_and_dropped_files_are_reported_in_elements_and_lines(monitor: Monitor) -> None:
    calls: list[object] = []
    monitor.on_pointer = monitor.on_drop = calls.append
    resize(monitor, (1380, 960))
    calls.clear()
    post(pygame.MOUSEBUTTONDOWN, pos=(50, 0), button=1)
    post(pygame.MOUSEMOTION, pos=(53, 3), rel=(0, 0), buttons=(1, 0, 0))
    post(pygame.MOUSEBUTTONUP, pos=(2000, 959), button=1)
    post(pygame.MOUSEBUTTONDOWN, pos=(53, 3), button=4)
    post(pygame.DROPFILE, file="/some/scene.toml")
    monitor.step()
    for mods in (pygame.KMOD_LSHIFT, pygame.KMOD_RCTRL, pygame.KMOD_RSHIFT | pygame.KMOD_LMETA):
        pygame.key.set_mods(mods)
        post(pygame.MOUSEBUTTONDOWN, pos=(50, 0), button=2)
        post(pygame.MOUSEWHEEL, x=0, y=-3)
        monitor.step()
    pygame.key.set_mods(0)
    presses = [call for call in calls if not isinstance(call, Pointer) or "wheel" not in call.action]
    assert presses == [
        Pointer(0, 0, "press", 1),
        Pointer(1, 1, "move"),
        Pointer(639, 479, "release", 1),
        Path("/some/scene.toml"),
        Pointer(0, 0, "press", 2, shift=True),
        Pointer(0, 0, "press", 2, control=True),
        Pointer(0, 0, "press", 2, shift=True, control=True),
    ]
    wheels = [call for call in calls if call not in presses and isinstance(call, Pointer)]
    assert [(wheel.action, wheel.steps) for wheel in wheels] == [("wheel down", 3)] * 3


def test_a_blinking_cursor_comes_and_goes(monitor: Monitor, monkeypatch: pytest.MonkeyPatch) -> None:
    monitor.display.send(np.array([0x1600, 50, 0xC00 | 60], np.uint16))
    resize(monitor, (640, 480))
    seen = []
    clock = Clock(monkeypatch)
    for seconds in (10.1, 10.6, 11.1):
        clock.now = seconds
        monitor.step()
        seen.append(shown().copy())
    assert (seen[0] != seen[1]).any()
    assert (seen[0] == seen[2]).all()


def test_help_and_entries_stand_over_the_field_and_touch_no_word(monitor: Monitor) -> None:
    display = monitor.display
    resize(monitor, (640, 480))
    written, field = display.frame_buffer.written, display.field()
    press(monitor, pygame.K_F1)
    assert not np.array_equal(shown(), field)
    press(monitor, pygame.K_F4)
    cells = shown()[::15, ::20][:32, :32].reshape(-1, 3)
    assert np.array_equal(cells, display.entries)
    # The page follows the table.
    load(monitor, 200)
    settle(monitor)
    assert shown()[5, 9 * 20 + 5].tolist() == [200, 100, 50]
    press(monitor, pygame.K_ESCAPE)
    settle(monitor)
    assert np.array_equal(shown(), display.field())
    assert display.frame_buffer.written == written


def test_another_display_takes_the_place_of_the_first_in_the_open_window(monitor: Monitor) -> None:
    resize(monitor, (640, 480))
    # As much was written in both, elsewhere.
    monitor.display.send(instructions.erase((0, 0, 99, 99), 1))
    settle(monitor)
    other = Ramtek9300()
    other.send(pattern())
    other.send(instructions.erase((100, 200, 199, 299), 2))
    assert not np.array_equal(other.field(), monitor.display.field())
    monitor.display.joystick.move_to(123, 45)
    monitor.display = other
    monitor.step()
    assert np.array_equal(shown(), other.field())
    assert other.joystick.position == (123, 45)
    window = pygame.display.get_wm_info()["window"]
    ticks: list[object] = []

    def tick() -> None:
        ticks.append(pygame.display.get_wm_info()["window"])
        if len(ticks) == 3:
            monitor.close()

    monitor.on_tick = tick
    monitor.run()
    assert ticks == [window] * 3
    assert not pygame.display.get_init()


class UnopenedMonitor(Monitor):
    """A monitor without a window; `asked` lists the requests to its window."""

    asked: list[str]

    def close(self) -> None:
        self.asked.append("close")

    def toggle_full_screen(self) -> None:
        self.full_screen = not self.full_screen
        self.asked.append("toggle")

    def show_message(self, message: str) -> None:
        self.asked.append(message)


@pytest.fixture
def unopened(tmp_path: Path) -> UnopenedMonitor:
    monitor = UnopenedMonitor(Ramtek9300(), screenshots=tmp_path)
    monitor.asked = []
    return monitor


@pytest.mark.parametrize(
    ("key", "is_given"),
    [
        *((key, True) for key in (Key("a", "a"), Key("escape"), Key("f1"), Key("q", "q"), Key("return"))),
        *((Key(name), False) for name in ("left shift", "right ctrl", "left meta")),
        *((Key(name, repeated=True), False) for name in ("f3", "f10", "f11")),
        (Key("return", alt=True, repeated=True), False),
        (Key("q", control=True, repeated=True), False),
    ],
)
def test_a_key_that_is_no_shortcut_is_given_to_the_program(
    unopened: UnopenedMonitor, key: Key, is_given: bool
) -> None:
    taken: list[Key] = []

    def take(key: Key) -> bool:
        taken.append(key)
        return True

    unopened.on_key = take
    unopened.handle_key(key)
    assert (taken, unopened.asked, unopened.overlay.page) == ([key] if is_given else [], [], "")


def test_escape_leaves_full_screen_before_it_goes_to_the_program(unopened: UnopenedMonitor) -> None:
    taken: list[Key] = []
    unopened.on_key = taken.append
    for key in (Key("f11"), Key("escape"), Key("return", alt=True), Key("f11"), Key("escape")):
        unopened.handle_key(key)
    assert unopened.asked == ["toggle"] * 4
    assert taken == [Key("escape")]


def test_a_screenshot_takes_the_next_free_number_or_is_a_message(
    unopened: UnopenedMonitor, tmp_path: Path
) -> None:
    (tmp_path / "ramtek-0001.png").write_bytes(b"kept")
    unopened.display.send(instructions.load_entries(0, [[9, 8, 7]]))
    unopened.handle_key(Key("f12", repeated=True))
    unopened.handle_key(Key("f12"))
    path = (tmp_path / "ramtek-0002.png").resolve()
    assert unopened.asked == ["", f"saved {path}"]
    assert (tmp_path / "ramtek-0001.png").read_bytes() == b"kept"
    with Image.open(path) as picture:
        assert picture.getpixel((0, 0)) == (9, 8, 7)
    given: list[str] = []
    unopened.on_message = given.append
    unopened.screenshots = Path("/none/at/all")
    unopened.handle_key(Key("f12"))
    assert len(unopened.asked) == 2
    assert (given[0], len(given)) == ("", 2)


def test_the_mouse_moves_the_joystick_and_its_buttons_are_the_switches(unopened: UnopenedMonitor) -> None:
    given: list[Pointer] = []
    unopened.on_pointer = given.append
    unopened.handle_pointer(Pointer(30, 40, "move"))
    unopened.handle_pointer(Pointer(31, 41, "press", 1))
    unopened.handle_pointer(Pointer(32, 42, "press", 3))
    joystick = unopened.display.joystick
    assert joystick.position == (32, 42)
    assert joystick.track
    assert unopened.display.cursors.enter_is_pressed
    unopened.handle_pointer(Pointer(32, 42, "release", 3))
    unopened.handle_pointer(Pointer(33, 43, "release", 1))
    assert not joystick.track
    assert [(pointer.action, pointer.button) for pointer in given] == [
        ("move", 0), ("press", 1), ("press", 3), ("release", 3), ("release", 1),
    ]  # fmt: skip


def test_a_program_s_picture_is_shown_and_its_mouse_is_no_joystick(on_screen: str, tmp_path: Path) -> None:
    given: list[Pointer] = []
    display, page = Ramtek9300(), Ramtek9300(replace(GMR_9300, elements=300, lines=200))
    monitor = Monitor(display, source=page.scan_out, screenshots=tmp_path, on_pointer=given.append)
    monitor.open()
    resize(monitor, (600, 400))
    for color in ((16, 32, 48), (64, 80, 96)):
        page.send(instructions.load_entries(0, [color]))
        monitor.step()
        assert (shown() == color).all()
    given.clear()
    place = display.joystick.position
    post(pygame.MOUSEBUTTONDOWN, pos=(599, 399), button=1)
    monitor.step()
    assert given == [Pointer(299, 199, "press", 1)]
    assert display.joystick.position == place
    assert not display.cursors.enter_is_pressed
    monitor.steer(given[0])
    assert display.joystick.position == (299, 199)
    assert display.cursors.enter_is_pressed
    monitor.screenshot()
    assert (tmp_path / "ramtek-0001.png").read_bytes() == page._repr_png_()
    monitor.close()


def test_a_page_is_shown_over_the_field(unopened: UnopenedMonitor) -> None:
    for key, page in (("f1", "help"), ("f4", "entries"), ("f4", ""), ("f1", "help"), ("escape", "")):
        unopened.handle_key(Key(key))
        unopened.handle_key(Key(key, repeated=True))
        assert unopened.overlay.page == page
    assert unopened.asked == []
    unopened.handle(Close())
    assert unopened.asked == ["close"]


def test_a_monitor_is_at_rest_when_nothing_is_down_and_nothing_waits(unopened: UnopenedMonitor) -> None:
    assert unopened.is_at_rest
    for down in (Key("left"), Pointer(1, 2, "press", 1)):
        unopened.input.add(down)
        unopened.handle(unopened.input.take())
        assert not unopened.is_at_rest
        unopened.input.release_everything()
        while unopened.input:
            assert not unopened.is_at_rest
            unopened.handle(unopened.input.take())
        assert unopened.is_at_rest
    unopened.input.add(Key("left shift"))
    unopened.input.take()
    assert unopened.is_at_rest
