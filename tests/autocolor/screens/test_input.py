from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor.screens.input import (
    LEFT,
    MARK,
    MIDDLE,
    POINTER,
    SLOP,
    Binding,
    Chord,
    Gesture,
    Mouse,
    Unit,
    turn_between,
    wheel_ratio,
)
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300, TcpPort
from ramtek_emu.host.server import TcpServer
from tests.autocolor.screens.boards import desk_viewer, middle_of
from tests.ramtek_emu.serving import in_a_thread
from tests.small import wall_scene


def kinds(gestures: list[Gesture]) -> list[str]:
    return [each.kind for each in gestures]


def test_the_degrees_of_a_drag_do_not_depend_on_its_steps() -> None:
    places, total = [(100, 100), (130, 90), (90, 140), (160, 80)], [0.0, 0.0]
    for before, after in pairwise(places):
        right, up = turn_between(*before, *after)
        total = [total[0] + right, total[1] + up]
    assert total == pytest.approx(turn_between(*places[0], *places[-1]))


def test_the_wheel_moves_closer_and_back_by_its_steps() -> None:
    assert wheel_ratio(1) < 1
    assert wheel_ratio(3) == pytest.approx(wheel_ratio(1) ** 3)
    assert wheel_ratio(2) * wheel_ratio(-2) == pytest.approx(1)


def test_a_movement_without_a_button_is_a_hover() -> None:
    assert kinds(Mouse().gestures(3, 4, "move")) == ["hover"]


def test_a_click_is_a_pick_even_if_the_hand_is_not_quite_still() -> None:
    mouse = Mouse()
    assert mouse.gestures(10, 10, "press", LEFT) == []
    assert mouse.gestures(10 + SLOP, 10 - SLOP, "move") == []
    (pick,) = mouse.gestures(10 + SLOP, 10 - SLOP, "release", LEFT)
    assert (pick.kind, pick.element, pick.line) == ("pick", 10 + SLOP, 10 - SLOP)


def test_a_drag_is_grabbed_where_the_button_was_pressed_and_dropped_at_its_release() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", MIDDLE, shift=True)
    grab, drag = mouse.gestures(20, 10, "move")
    assert (grab.kind, grab.element, grab.button, grab.shift) == ("grab", 10, MIDDLE, True)
    assert (drag.kind, drag.element, drag.button) == ("drag", 20, MIDDLE)
    # Back within the slop it is a drag still.
    assert kinds(mouse.gestures(10, 10, "move")) == ["drag"]
    assert mouse.gestures(10, 10, "release", LEFT) == []
    assert kinds(mouse.gestures(10, 10, "release", MIDDLE)) == ["drop"]
    assert kinds(mouse.gestures(10, 10, "move")) == ["hover"]


def test_other_buttons_have_no_clicks() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", MIDDLE)
    assert mouse.gestures(10, 10, "release", MIDDLE) == []


def test_a_button_that_is_forgotten_drags_no_more() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", LEFT)
    mouse.gestures(30, 10, "move")
    mouse.forget()
    assert kinds(mouse.gestures(40, 10, "move")) == ["hover"]
    assert mouse.gestures(40, 10, "release", LEFT) == []


def test_the_wheel_tells_its_steps_with_their_direction() -> None:
    assert [each.steps for each in Mouse().gestures(1, 1, "wheel up", steps=2)] == [2]
    assert [each.steps for each in Mouse().gestures(1, 1, "wheel down", steps=3)] == [-3]


@pytest.mark.parametrize(
    ("chord", "text"),
    [
        (Chord("f1"), "F1"),
        (Chord("escape"), "Esc"),
        (Chord("tab"), "Tab"),
        (Chord("left"), "Left"),
        (Chord("c", shift=True), "Shift+C"),
        (Chord("z", control=True, shift=True), "Ctrl+Shift+Z"),
        (Chord("["), "["),
    ],
)
def test_a_chord_is_written_as_on_a_keyboard(chord: Chord, text: str) -> None:
    assert str(chord) == text


def test_a_binding_is_written_as_its_chords_or_its_label() -> None:
    chords = (Chord("up"), Chord("down"))
    assert str(Binding[object](chords, "look", lambda _, __: None)) == "Up, Down"
    assert str(Binding[object](chords, "look", lambda _, __: None, label="arrows")) == "arrows"


@pytest.mark.parametrize(("name", "is_sign"), [("1", True), ("+", True), ("a", False), ("f1", False)])
def test_digits_and_signs_are_signs(name: str, is_sign: bool) -> None:
    assert Chord(name).is_sign == is_sign


# The joystick unit in process, and behind a TCP port.


@pytest.fixture
def display() -> Ramtek9300:
    return Ramtek9300()


@pytest.fixture
def unit(display: Ramtek9300) -> Unit:
    unit = Unit(display)
    unit.show()
    assert unit.poll() == []
    return unit


def told(unit: Unit) -> list[tuple[str, int, int]]:
    return [(each.kind, each.element, each.line) for each in unit.poll()]


def test_bits_above_the_place_of_a_cursor_are_no_part_of_it(display: Ramtek9300) -> None:
    class Noisy(Ramtek9300):
        def receive(self, count: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
            return super().receive(count) | np.uint16(0x8000)

    noisy = Noisy()
    noisy.joystick.move_to(30, 40)
    Unit(noisy).show()
    assert noisy.joystick.position == (30, 40)


def test_a_movement_is_told_once(unit: Unit, display: Ramtek9300) -> None:
    display.joystick.move_to(30, 40)
    assert told(unit) == [("hover", 30, 40)]
    assert told(unit) == []


def test_enter_is_read_once_however_late(unit: Unit, display: Ramtek9300) -> None:
    display.joystick.move_to(30, 40)
    display.joystick.press_enter()
    display.joystick.press_enter()
    assert told(unit) == [("hover", 30, 40), ("pick", 30, 40)]
    assert told(unit) == []


def test_what_was_pressed_before_the_unit_is_shown_is_no_pick(display: Ramtek9300) -> None:
    display.joystick.press_enter()
    unit = Unit(display)
    unit.show()
    assert told(unit) == []


def test_a_drag_lasts_as_long_as_track(unit: Unit, display: Ramtek9300) -> None:
    display.joystick.track = True
    assert told(unit) == [("grab", 0, 0)]
    display.joystick.move_to(30, 40)
    assert told(unit) == [("drag", 30, 40)]
    display.joystick.move_to(31, 40)
    display.joystick.track = False
    assert told(unit) == [("drag", 31, 40), ("drop", 31, 40)]


def test_the_pointer_and_the_mark_are_cursors_and_write_no_word(unit: Unit, display: Ramtek9300) -> None:
    written = display.frame_buffer.written
    unit.mark((100, 90))
    marked = display.cursors[MARK]
    assert (marked.element, marked.line, marked.is_visible) == (100, 90, True)
    assert display.cursors[POINTER].is_visible
    received = display.words_received
    unit.mark((100, 90))
    assert display.words_received == received
    unit.mark(None)
    assert not display.cursors[MARK].is_visible
    unit.hide()
    assert not display.cursors[POINTER].is_visible
    assert display.frame_buffer.written == written


def test_a_mark_beyond_the_screen_is_at_its_edge(unit: Unit, display: Ramtek9300) -> None:
    unit.mark((-40, 90))
    assert (display.cursors[MARK].element, display.cursors[MARK].line) == (0, 90)
    unit.mark((10**6, 10**6))
    assert display.cursors[MARK].line == 0x3FF


def test_the_unit_alone_sets_a_number_and_moves_a_handle(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    display = viewer.display
    assert isinstance(display, Ramtek9300)
    viewer.poll()
    element, line = middle_of(viewer.board, "ambient")
    for place, switch in (((element, line), True), ((639, line), True), ((639, line), False)):
        display.joystick.move_to(*place)
        viewer.poll()
        display.joystick.track = switch
        viewer.poll()
    assert viewer.studio.scene.ambient == 1.0
    start = viewer.board.screen.handles()[0][1:3]
    for place in (start, (150, 150)):
        display.joystick.move_to(*place)
        display.joystick.press_enter()
        viewer.poll()
    assert viewer.studio.scene.view.eye[:2] == (-5.0, -5.0)


# The same session in process and over TCP.

Step = tuple[str, int, int]
steps = st.lists(
    st.tuples(
        st.sampled_from(["move", "move", "enter", "track", "release"]),
        st.one_of(st.integers(0, 639), st.integers(500, 639)),
        st.integers(0, 479),
    ),
    max_size=12,
)


def played(viewer: Viewer, joystick: Callable[[Step], None], session: list[Step]) -> None:
    for step in session:
        joystick(step)
        viewer.poll()


def moving(display: Ramtek9300) -> Callable[[Step], None]:
    def move(step: Step) -> None:
        kind, element, line = step
        if kind == "enter":
            display.joystick.press_enter()
        elif kind == "move":
            display.joystick.move_to(element, line)
        else:
            display.joystick.track = kind == "track"

    return move


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(session=steps)
def test_the_same_gestures_in_process_and_over_tcp_give_the_same_words(
    tmp_path: Path, session: list[Step]
) -> None:
    here, there = Ramtek9300(), Ramtek9300()
    played(Viewer(wall_scene(), here, tmp_path), moving(here), session)
    with in_a_thread(TcpServer(there, idle_seconds=20.0)) as server, TcpPort(server.address) as port:
        viewer = Viewer(wall_scene(), port, tmp_path)
        # The pointer is where the host put it before the user moves it.
        viewer.session.word_at(0, 0)
        played(viewer, moving(there), session)
        # What was sent is drawn when something is read back.
        viewer.session.word_at(0, 0)
        assert np.array_equal(here.words, there.words)
        assert np.array_equal(here.entries, there.entries)
        for one, other in zip(here.cursors.all, there.cursors.all, strict=True):
            assert (one.element, one.line, one.state) == (other.element, other.line, other.state)
