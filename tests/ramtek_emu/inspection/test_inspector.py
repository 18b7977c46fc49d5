"""The window of an inspector: keys, the mouse, and a real window once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pygame
import pytest

from ramtek_emu import Configuration, Ramtek9300, instructions
from ramtek_emu.inspection.histories import EntryRange
from ramtek_emu.inspection.inspector import BINDINGS, MOUSE, MOUSE_LIVE, Inspector
from ramtek_emu.inspection.page import EDGE
from ramtek_emu.inspection.session import inspection_of, is_busy, tick
from ramtek_emu.monitor.input_queue import Key, Pointer
from tests.ramtek_emu.displays import shown
from tests.ramtek_emu.inspection.replays import replay_of
from tests.ramtek_emu.inspection.sessions import Served
from tests.ramtek_emu.recorded_streams import OUTLINE

LARGE = Configuration(name="LARGE", elements=640, lines=480, planes=10)


def inspector_of(words: object, configuration: Configuration = LARGE) -> Inspector:
    return at_rest(Inspector(inspection_of(replay_of(np.asarray(words).tolist(), configuration))))


def at_rest(inspector: Inspector) -> Inspector:
    while is_busy(inspector.session):
        inspector._do(tick)
    return inspector


def press(inspector: Inspector, *names: str) -> Inspector:
    for name in names:
        shift, plain = name.startswith("shift "), name.removeprefix("shift ")
        text = plain if len(plain) == 1 else ""
        assert inspector.press(Key(plain, text.upper() if shift else text, shift=shift))
    return at_rest(inspector)


def point(inspector: Inspector, *actions: tuple[str, int, int]) -> Inspector:
    """The mouse at places of the page: "press", "move", "release" of the left button."""
    for action, element, line in actions:
        inspector.point(Pointer(element + EDGE, line + EDGE, action, 0 if action == "move" else 1))
    return at_rest(inspector)


def click(inspector: Inspector, element: int, line: int) -> Inspector:
    return point(inspector, ("press", element, line), ("release", element, line))


BOXES = np.concatenate(
    (
        instructions.erase((0, 0, 639, 479), 5),
        instructions.load_entries(5, [[10, 20, 30]]),
        instructions.erase((100, 100, 200, 200), 7),
        instructions.erase((150, 150, 300, 250), 5),
        instructions.load_entries(5, [[40, 50, 60]]),
    )
)


def test_keys_step_forward_and_back() -> None:
    inspector, numbers = inspector_of(OUTLINE), []
    for key in ("right", "down", "page down", "left", "up", "page up", "end", "right", "home", "left"):
        press(inspector, key)
        numbers.append(inspector.session.number)
    last = len(inspector.session.replay.stream)
    assert numbers == [1, 2, 12, 11, 10, 0, last, last, 0, 0]


def test_a_number_and_a_text_are_typed() -> None:
    inspector = inspector_of(BOXES)
    assert press(inspector, "4", "return").session.number == 4
    assert press(inspector, "home", "f", "l", "a", "m", "return").session.number == 2
    assert press(inspector, "return").session.number == 5
    assert press(inspector, "shift return", "escape").session.number == 2


def test_a_button_does_what_its_key_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    by_button, by_key = inspector_of(BOXES), inspector_of(BOXES)
    for number, binding in enumerate(by_button.buttons):
        box = by_button.page.layout.buttons[number]
        # Escape leaves a prompt or a page, but not the position.
        click(press(by_button, "escape"), box.left + 2, box.top + 2)
        press(by_key, "escape", binding.keys[-1])
        assert replace(by_button.session, replay=by_key.session.replay, message="") == replace(
            by_key.session, message=""
        )


def test_a_click_on_a_pixel_shows_its_history_and_a_click_on_a_row_goes_there() -> None:
    inspector = press(inspector_of(BOXES), "end")
    click(inspector, 160, 170)
    assert inspector.session.selection == (160, 170, 160, 170)
    assert [write.number for write in inspector.session.writes or ()] == [1, 3, 4]
    history, listing = (inspector.page.layout.boxes[name] for name in ("history", "listing"))
    click(inspector, history.left + 5, history.top + 2 * 11 + 3)
    assert inspector.session.number == 3
    click(inspector, listing.left + 5, listing.top + 3 * 11 + 3)
    assert inspector.session.number == 2


def test_a_rectangle_is_dragged_and_its_changes_are_found() -> None:
    inspector = inspector_of(BOXES)
    point(inspector, ("press", 290, 240), ("move", 250, 220), ("release", 240, 210))
    assert inspector.session.selection == (240, 210, 290, 240)
    numbers = [press(inspector, "c").session.number for _ in range(3)]
    assert numbers == [1, 1, 1]
    inspector.point(Pointer(5, 5, "press", 3))
    assert inspector.session.selection is None


def test_entries_are_selected_on_their_page() -> None:
    inspector = press(inspector_of(BOXES), "end", "f4")
    boxes = [(20 * 5 + 3, 3), (20 * 7 + 3, 3)]
    click(inspector, *boxes[0])
    assert [write.number for write in inspector.session.writes or ()] == [2, 5]
    ends = [("press", boxes[1]), ("move", boxes[0]), ("release", boxes[0])]
    point(inspector, *((action, *box) for action, box in ends))
    assert inspector.session.selection == EntryRange(5, 8)


def test_the_bar_is_dragged_over_the_whole_stream() -> None:
    inspector = inspector_of(OUTLINE)
    bar, last = inspector.page.layout.bar, len(inspector.session.replay.stream)
    places = [bar.left + bar.width // 2, bar.left - 50, bar.left + bar.width + 500]
    inspector.point(Pointer(places[0], bar.top + 2, "press", 1))
    numbers = [at_rest(inspector).session.number]
    for place in places[1:]:
        # The pointer may leave the bar while its button is down.
        inspector.point(Pointer(place, 30, "move"))
        numbers.append(at_rest(inspector).session.number)
    assert numbers == [(last + 1) // 2, 0, last]


def test_the_wheel_steps() -> None:
    inspector = press(inspector_of(OUTLINE), "end")
    last = inspector.session.number
    for action, steps, number in (("wheel up", 5, last - 5), ("wheel down", 2, last - 3)):
        inspector.point(Pointer(9, 9, action, steps=steps))
        assert at_rest(inspector).session.number == number


def test_the_pointer_is_noted_on_the_field_and_on_the_page_of_entries() -> None:
    inspector = inspector_of(BOXES)
    noted = []
    for place in ((639, 479), (0, 0), (642, 479)):
        noted.append(point(inspector, ("move", *place)).session.pointed)
    assert noted == [(639, 479), (0, 0), None]
    press(inspector, "f4")
    entries = [point(inspector, ("move", *place)).session.pointed for place in ((639, 479), (0, 0))]
    assert entries == [EntryRange(1023, 1024), EntryRange(0, 1)]
    assert point(inspector, ("move", 642, 479)).session.pointed is None


def test_the_help_page_has_every_key_and_fits() -> None:
    for is_live in (False, True):
        inspector = Inspector(Served(Ramtek9300()).inspection.state) if is_live else inspector_of([])
        rows = inspector.page._help_rows
        assert {binding.text for binding in inspector.bindings} <= {keys for keys, _ in rows}
        assert 16 + 15 * (len(rows) + 1) + 9 <= 480
        assert (MOUSE_LIVE[0] in rows) == is_live
        assert set(MOUSE) <= set(rows)
        assert max(len(action) for _, action in rows) <= 60


def test_no_key_has_two_meanings() -> None:
    keys = [key for binding in BINDINGS for key in binding.keys]
    assert len(keys) == len(set(keys))


def test_the_mouse_is_the_joystick_of_a_display_that_runs_and_inspects_a_paused_display() -> None:
    host = Served(Ramtek9300()).host
    inspector = Inspector(inspection_of(host))
    point(inspector, ("move", 30, 40), ("press", 31, 41), ("release", 32, 42))
    assert host.display.joystick.position == (32, 42)
    assert host.display.cursors.enter_is_pressed
    assert inspector.session.selection is None
    # A click elsewhere on the page, such as a button that pauses, leaves the joystick alone.
    button = inspector.page.layout.buttons[0]
    click(inspector, button.left + 2, button.top + 2)
    click(inspector, 60, 70)
    assert host.display.joystick.position == (32, 42)
    assert inspector.session.selection == (60, 70, 60, 70)


def test_the_window_shows_the_page_after_keys_and_clicks(on_screen: str) -> None:
    opened = inspector_of(BOXES)
    opened.monitor.open()
    monitor, page = opened.monitor, opened.page
    keys = (
        pygame.K_RIGHT,
        pygame.K_END,
        pygame.K_LEFT,
        pygame.K_F4,
        pygame.K_F4,
        pygame.K_F1,
        pygame.K_ESCAPE,
    )
    for key in keys:
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=key, unicode="", mod=0))
        pygame.event.post(pygame.event.Event(pygame.KEYUP, key=key, mod=0))
        monitor.step(5)
        assert np.array_equal(shown(), page.colors())
    assert opened.session.number == 4
    for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
        pygame.event.post(pygame.event.Event(kind, pos=(162, 172), button=1))
    while opened.session.writes is None:
        monitor.step(5)
    assert opened.session.selection == (160, 170, 160, 170)
    assert np.array_equal(shown(), page.colors())
    event = pygame.event.Event(pygame.KEYDOWN, key=pygame.K_q, unicode="\x11", mod=pygame.KMOD_LCTRL)
    pygame.event.post(event)
    monitor.run(opened.is_busy)
    assert not monitor.is_open
    # A hint for the user is a message on the page.
    monitor.tell("nothing is lit")
    assert opened.session.message == "nothing is lit"
