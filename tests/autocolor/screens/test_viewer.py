from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError, Mesh, Scene, Surface, View
from autocolor.arrays import Words
from autocolor.scene.defaults import framed
from autocolor.screens.keys import BINDINGS, WINDOW_KEYS
from autocolor.screens.screen import Screen
from autocolor.screens.session import MESSAGE_SECONDS
from autocolor.screens.viewer import SCREENS, Viewer
from autocolor.widgets.items import Area
from autocolor.widgets.menu import MESSAGE_CHARACTERS
from autocolor.widgets.widget import Button
from ramtek_emu import GMR_9300, Ramtek9300
from tests.autocolor.screens.boxes import told
from tests.autocolor.screens.hand import Hand
from tests.small import boxes, cube, wall_scene
from tests.tables import first

MIDDLE = np.array([0.5, 0.5, 0.5])
"""The middle of the box."""


def box_scene() -> Scene:
    """The boxes, and a surface that no part has."""
    return boxes().replace(name="box", surfaces=[Surface("unused"), *boxes().surfaces])


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return Hand(Viewer(box_scene(), Ramtek9300(), tmp_path))


def distance(scene: Scene) -> float:
    """From the eye to the middle of the box."""
    return float(np.linalg.norm(np.array(scene.view.eye) - MIDDLE))


def paint_of(hand: Hand, name: str = "low") -> tuple[int, int, int]:
    return hand.scene.surfaces[name].paint.object_color


# Keys.


def test_every_key_says_what_it_does_in_words_of_its_own_and_is_taken(hand: Hand) -> None:
    said = [binding.does for binding in BINDINGS] + [does for _, does in WINDOW_KEYS]
    assert all(said)
    assert len(set(said)) == len(said)
    chords = [chord for binding in BINDINGS for chord in binding.chords]
    assert len(set(chords)) == len(chords)
    assert not {str(chord) for chord in chords} & {"F10", "F11", "Ctrl+Q"}
    assert {keys for keys, _ in WINDOW_KEYS} >= {"F10", "Ctrl+Q"}
    for chord in chords:
        hand.go_to("help" if chord.name == "escape" else "picture")
        assert hand.viewer.on_key(chord.name, chord.control, chord.shift, alt=chord.alt)


@pytest.mark.parametrize("key", ["q", "Ctrl+Shift+s", "Ctrl+f1", "escape"])
def test_keys_that_do_nothing_are_not_taken(hand: Hand, key: str) -> None:
    before = hand.message
    assert not hand.press(key)
    assert hand.message == before


EDITS: dict[str, Callable[[Scene], object]] = {
    "left": lambda scene: np.cross(scene.view.eye, (-2, -3, 2))[2] > 0,
    "right": lambda scene: np.cross(scene.view.eye, (-2, -3, 2))[2] < 0,
    "up": lambda scene: scene.view.eye[2] > 2,
    "down": lambda scene: scene.view.eye[2] < 2,
    "+": lambda scene: distance(scene) == pytest.approx(0.9 * distance(box_scene())),
    "=": lambda scene: distance(scene) == pytest.approx(0.9 * distance(box_scene())),
    "-": lambda scene: distance(scene) == pytest.approx(distance(box_scene()) / 0.9),
    ",": lambda scene: scene.view.angle == -5,
    ".": lambda scene: scene.view.angle == 5,
    "r": lambda scene: scene.view == framed(box_scene().view, cube().coordinates),
    "1": lambda scene: [light.on for light in scene.lights] == [False, True],
    "2": lambda scene: [light.on for light in scene.lights] == [True, False],
    "[": lambda scene: scene.surfaces["low"].paint.blend == pytest.approx(0.55),
    "]": lambda scene: scene.surfaces["low"].paint.blend == pytest.approx(0.65),
    "e": lambda scene: scene.exposure != box_scene().exposure,
    "c": lambda scene: scene.surfaces["low"].paint != box_scene().surfaces["low"].paint,
    "Shift+c": lambda scene: scene.surfaces["low"].paint != box_scene().surfaces["low"].paint,
}


@pytest.mark.parametrize("key", EDITS)
def test_each_edit_is_shown_undone_and_done_again(hand: Hand, key: str) -> None:
    before = hand.scene
    hand.press(key)
    after = hand.scene
    assert EDITS[key](after)
    assert hand.shows(after)
    if after.view != before.view:
        hand.press("Alt+Left")
        assert hand.scene.equals(before)
        hand.press("Alt+Right")
        assert hand.scene.equals(after)
        return
    hand.press("Ctrl+Z")
    assert hand.scene is before
    assert hand.message.startswith("undone: ")
    hand.press("Ctrl+Y")
    assert hand.scene is after
    assert hand.message.startswith("redone: ")
    hand.press("Ctrl+Z", "Ctrl+Shift+Z")
    assert hand.scene is after


@pytest.mark.parametrize(
    ("name", "shift", "typed", "same"),
    [
        ("=", True, "+", "+"),
        ("[+]", False, "+", "+"),
        ("é", True, "2", "2"),
        ("[2]", False, "2", "2"),
        ("8", False, "[", "["),
    ],
)
def test_keys_of_other_keyboards_are_known_by_what_they_type(
    hand: Hand, name: str, shift: bool, typed: str, same: str
) -> None:
    hand.viewer.on_key(name, shift=shift, typed=typed)
    assert EDITS[same](hand.scene)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("2", "light fill off"),
        ("[", "blend 0.55"),
        ("9", "the scene has no light 9"),
        # In full screen, the message is all that tells which surface it is.
        ("s", "surface high"),
        ("e", "exposure held: less light is darker"),
        ("Ctrl+Z", "nothing to undo"),
        ("Ctrl+Y", "nothing to redo"),
        ("f5", "view: from -y"),
        ("f6", "view: from x"),
        ("Shift+f6", "view: from -x"),
        ("f7", "view: from y"),
        ("f8", "view: top"),
        ("f9", "view: three quarters"),
    ],
)
def test_a_key_says_what_it_did(hand: Hand, keys: str, message: str) -> None:
    hand.press(keys)
    assert hand.message == message


def test_a_key_with_shift_turns_finely_and_home_goes_back_to_the_view_as_opened(hand: Hand) -> None:
    before = hand.scene
    hand.press(*["Shift+left"] * 5, *["Shift+up"] * 5)
    finely = hand.scene.view.eye
    hand.press("home")
    assert hand.scene.view == before.view
    hand.press("left", "up")
    assert finely == pytest.approx(hand.scene.view.eye)


@pytest.mark.parametrize("key", first(2, ["left", "]", "+", ","]))
def test_a_key_held_down_is_one_step(hand: Hand, key: str) -> None:
    before = hand.scene
    hand.press(key)
    once = hand.scene
    hand.press(key, key, key, repeated=True)
    assert hand.scene is not once
    hand.press("Ctrl+Z", "Alt+Left")
    assert hand.scene.equals(before)
    assert not hand.viewer.studio.undo()
    assert not hand.viewer.studio.view_back()


@pytest.mark.parametrize("key", ["f1", "f4", "1", "e"])
def test_a_switch_does_not_flip_and_escape_goes_no_further_while_a_key_is_held_down(
    hand: Hand, key: str
) -> None:
    assert hand.press(key)
    switched = hand.viewer.page, hand.scene
    for each in (key, key, "escape"):
        assert hand.press(each, repeated=True)
        assert (hand.viewer.page, hand.scene) == switched


def test_undo_and_colors_go_on_while_their_key_is_held_down(hand: Hand) -> None:
    before = hand.scene
    hand.press("c")
    hand.press("c", repeated=True)
    hand.press("Ctrl+Z")
    assert hand.scene is not before
    hand.press("Ctrl+Z", repeated=True)
    assert hand.scene is before


def test_a_key_pressed_again_or_after_another_is_a_step_of_its_own(hand: Hand) -> None:
    seen = []
    for key, repeated in (("left", False), ("left", False), ("c", False), ("left", True)):
        # A key that was down before the one before it is marked as repeated in its own first edit.
        seen.append(hand.scene)
        hand.press(key, repeated=repeated)
    for scene, back in zip(reversed(seen), ("Alt+Left", "Ctrl+Z", "Alt+Left", "Alt+Left"), strict=True):
        hand.press(back)
        assert hand.scene.equals(scene)


def test_the_chosen_surface_is_recolored(hand: Hand) -> None:
    seen = []
    for _ in range(2):
        seen.append(hand.viewer.caption.split(" - ")[2])
        hand.press("s")
    assert seen == ["[low]", "[high]"]
    assert "[low]" in hand.viewer.caption
    hand.press("Shift+s")
    paints = {name: paint_of(hand, name) for name in ("unused", "low", "high")}
    hand.press("c")
    assert [name for name in paints if paint_of(hand, name) != paints[name]] == ["high"]


def test_a_refused_edit_shows_a_message_and_changes_nothing(hand: Hand) -> None:
    hand.viewer.studio.edit(hand.scene.replace(view=View((0, -9.9e35, 0), target=(0, 0, 0))))
    before = hand.scene
    assert hand.press("-")
    assert hand.scene is before
    message, is_warning = told(hand)
    assert is_warning
    assert message in hand.viewer.caption


def test_a_mesh_without_anything_can_be_looked_at(tmp_path: Path) -> None:
    nothing = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    scene = Scene(nothing, (), (), (), View((0, -1, 0), target=(0, 0, 0)))
    hand = Hand(Viewer(scene, Ramtek9300(), tmp_path))
    hand.press(*EDITS, "s", "f1", "f4", "escape", "Ctrl+s")
    assert hand.viewer.caption.startswith("autocolor - scene - saved ")


# Screens.


def test_every_screen_has_a_name_and_a_title_of_its_own_and_help() -> None:
    for texts in ([each.name for each in SCREENS], [each.title for each in SCREENS]):
        assert all(texts)
        assert len(set(texts)) == len(texts)
    assert all(each.help for each in SCREENS)


@pytest.mark.parametrize("lights", first(1, [None, []]), ids=["a light", "no light"])
@pytest.mark.parametrize("screen", SCREENS, ids=[each.name for each in SCREENS])
def test_every_screen_is_reached_drawn_and_hovered_undoes_redoes_and_is_left_without_a_trace(
    screen: type[Screen], lights: list[object] | None, tmp_path: Path
) -> None:
    scene = wall_scene() if lights is None else wall_scene(lights=lights)
    hand = Hand(Viewer(scene, Ramtek9300(), tmp_path))
    hand.press("c")
    after = hand.scene
    if screen.word:
        hand.turn_to(screen.title)
    else:
        hand.go_to(screen.name)
    for place in ((560, 40), (560, 200), (300, 200), (100, 400), (5, 475)):
        hand.move(*place)
        assert hand.is_drawn_whole()
    for share, wanted in ((0.1, scene), (0.9, after), (0.1, scene)):
        assert hand.viewer.page == screen.name
        hand.move(20, 20)
        hand.open_menu()
        hand.pick(" ", share)
        assert hand.scene is wanted
    if screen.name != "picture":
        hand.turn_to("picture")
    assert hand.viewer.page == "picture"
    hand.move(20, 20)
    assert hand.shows(scene)


def test_keys_lead_along_the_strip_and_round_to_its_first_screen(hand: Hand) -> None:
    names = [screen.name for screen in SCREENS if screen.word]
    assert len(names) == 10
    assert all(len(screen.word) <= 7 for screen in SCREENS)
    for digit, name in zip("1234567890", names, strict=True):
        hand.press(f"Ctrl+{digit}")
        assert hand.viewer.page == name
    hand.press("Ctrl+Tab")
    assert hand.viewer.page == names[0]
    hand.viewer.on_key("tab", control=True, shift=True)
    assert hand.viewer.page == names[-1]


@pytest.mark.parametrize("key", first(2, ["left", "Ctrl+Z", "1", "e"]))
def test_an_edit_of_the_picture_leads_back_to_it(hand: Hand, key: str) -> None:
    hand.press("c", "f4", key)
    assert hand.viewer.page == "picture"
    assert hand.shows(hand.scene)


def test_a_screen_without_a_menu_tells_how_to_bring_it(hand: Hand) -> None:
    hand.viewer.tell("")
    hand.viewer.session.turn_to("blending")
    hand.move(100, 100)
    assert hand.message.endswith("; the right edge: the menu")
    assert len(hand.message) <= MESSAGE_CHARACTERS


# Messages.


def test_a_message_stands_over_the_picture_for_a_while(hand: Hand, wait: Callable[[float], None]) -> None:
    picture = hand.viewer.studio.words
    assert np.array_equal(hand.display.words[:464], picture[:464])
    assert not np.array_equal(hand.display.words, picture)
    hand.viewer.tell("")
    assert np.array_equal(hand.display.words, picture)
    hand.press("Ctrl+s")
    wait(MESSAGE_SECONDS - 0.1)
    hand.viewer.on_tick()
    assert not np.array_equal(hand.display.words, picture)
    wait(0.1)
    hand.viewer.on_tick()
    assert np.array_equal(hand.display.words, picture)


def test_the_first_message_stands_until_the_menu_comes_or_something_is_done(
    hand: Hand, wait: Callable[[float], None]
) -> None:
    welcome = "F1: help; Tab or the right edge: the menu"
    wait(100 * MESSAGE_SECONDS)
    hand.viewer.on_tick()
    hand.move(100, 100)
    assert hand.hint == welcome
    hand.move(638, 8)
    assert hand.hint == f"file, Ctrl+0: {hand.viewer.screens['file'].help}"
    hand.viewer.tell(welcome, persistent=True)
    hand.press("c")
    assert hand.message != welcome


# Saving, leaving, opening.


def test_the_caption_marks_unsaved_changes(hand: Hand) -> None:
    assert hand.viewer.caption == "autocolor - box - [low] - F1: help; Tab or the right edge: the menu"
    hand.press("c")
    assert hand.viewer.caption.startswith("autocolor - box* - [low]")
    hand.press("Ctrl+Z")
    assert hand.viewer.caption == "autocolor - box - [low] - undone: low: object color #f4a39b"
    # A light that is switched off and on leaves nothing to save.
    for is_changed in (True, False):
        hand.press("1")
        assert ("*" in hand.viewer.caption) is is_changed


@pytest.mark.parametrize("key", ["Ctrl+s", "f12", "Shift+f12"])
def test_a_refused_save_shows_a_message_and_stays_unsaved(hand: Hand, tmp_path: Path, key: str) -> None:
    hand.viewer.session.folder = tmp_path / "none"
    hand.press("c", key)
    assert told(hand)[1]
    assert "*" in hand.viewer.caption
    assert os.listdir(tmp_path) == []


def test_closing_with_unsaved_work_takes_two_times_in_a_row(hand: Hand) -> None:
    assert hand.viewer.on_close()
    hand.press("c")
    assert not hand.viewer.on_close()
    assert hand.message == "not saved: Ctrl+S saves, close again to discard the changes"
    hand.press("f1")
    assert not hand.viewer.on_close()
    assert hand.viewer.on_close()
    hand.press("Ctrl+Z")
    assert hand.viewer.on_close()


@pytest.mark.parametrize(
    ("name", "text", "starts", "ends"),
    [
        ("three.toml", "ambient = -1\nscaling = 1\ndither = 2\n", "three.toml", "more)"),
        ("a\nb\x1b[31m.obj", "v 0 0 zero\n", r"a\nb\x1b[31m.obj, line 1", ""),
    ],
)
def test_a_dropped_file_that_is_damaged_shows_a_line_and_changes_nothing(
    hand: Hand, tmp_path: Path, name: str, text: str, starts: str, ends: str
) -> None:
    scene = hand.scene
    (tmp_path / name).write_text(text)
    hand.viewer.on_drop(tmp_path / name)
    message, is_warning = told(hand)
    assert is_warning
    assert message.isprintable()
    assert message.startswith(starts)
    assert ends in message
    assert hand.shows(scene)


# Movements and the mouse.


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock on which every picture takes a second."""
    ticks = itertools.count()
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: float(next(ticks)))


@pytest.mark.usefixtures("slow")
@pytest.mark.parametrize("by", ["a key at rest", "a key without effect", "the wheel"])
def test_a_picture_is_coarse_while_it_moves_and_refined_when_it_rests(
    hand: Hand, wait: Callable[[float], None], by: str
) -> None:
    if by == "the wheel":
        hand.viewer.on_pointer(2, 2, "wheel up")
    else:
        hand.press("left")
        hand.press("left", repeated=True)
    # Between two steps of the wheel nothing is held.
    hand.viewer.on_tick(is_at_rest=by == "the wheel")
    assert hand.viewer.studio.is_coarse
    assert not hand.shows(hand.scene)
    if by != "a key at rest":
        wait(1)
    hand.viewer.on_tick(is_at_rest=by != "a key without effect")
    assert hand.shows(hand.scene)


@pytest.mark.usefixtures("slow")
@pytest.mark.parametrize("keys", [("r",), ("1",), ("f1", "f1"), ("f4", "escape")])
def test_an_edit_without_a_movement_and_a_page_lead_to_a_fine_picture(
    hand: Hand, keys: tuple[str, ...]
) -> None:
    hand.press("left", *keys)
    assert hand.shows(hand.scene)


@pytest.mark.usefixtures("slow")
def test_a_movement_whose_fine_picture_is_refused_is_taken_back(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = hand.scene
    hand.press("left")

    def refuse() -> None:
        raise InputError("an intensity must be finite, not inf")

    monkeypatch.setattr(hand.viewer.studio, "refine", refuse)
    hand.viewer.on_tick()
    assert told(hand) == ("an intensity must be finite, not inf", True)
    assert hand.shows(before)


def test_the_wheel_moves_closer_and_its_steps_are_one_view_to_go_back_from(hand: Hand) -> None:
    before = hand.scene
    for _ in range(3):
        hand.viewer.on_pointer(300, 200, "wheel up", steps=2)
    assert distance(hand.scene) < distance(before)
    hand.viewer.on_pointer(300, 200, "wheel down", steps=6)
    assert hand.scene.view.eye == pytest.approx(before.view.eye)
    hand.press("Alt+Left")
    assert hand.scene.equals(before)


# The display.


def test_the_picture_is_sent_once_when_a_viewer_opens(tmp_path: Path) -> None:
    display = Ramtek9300()
    Viewer(box_scene(), display, tmp_path)
    assert display.words_received < 1.1 * display.frame_buffer.words.size


def test_the_display_ends_with_the_present_picture_alone(hand: Hand) -> None:
    hand.press("c")
    hand.viewer.board.over = lambda: [Button("panel", area=Area(8, 8, 99, 23))]
    handle = hand.viewer.board.content.handles[0]
    hand.viewer.on_pointer(handle.element, handle.line, "move")
    hand.viewer.tell("")
    assert hand.hint.startswith("highlight of fill")
    hand.press("b")
    hand.viewer.clear()
    assert np.array_equal(hand.display.words, hand.viewer.studio.words)
    assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)
    assert not any(cursor.is_visible for cursor in hand.display.cursors.all)


class SlowDisplay:
    """A display elsewhere that draws only when a reply is awaited. Large transfers are pages."""

    configuration = GMR_9300

    def __init__(self) -> None:
        self.display = Ramtek9300()
        self.waiting: list[Words] = []
        self.most_waiting = self.pages = 0

    def send(self, words: Words) -> None:
        self.waiting.append(np.array(words))
        self.most_waiting = max(self.most_waiting, sum(len(each) > 1_000 for each in self.waiting))

    def receive(self, count: int) -> Words:
        for words in self.waiting:
            self.display.send(words)
            self.pages += len(words) > 1_000
        self.waiting.clear()
        return self.display.receive(count)


@pytest.mark.parametrize("screen", first(1, ["picture", "split"]))
def test_a_moving_pointer_is_at_most_one_page_ahead_of_a_slow_display(screen: str) -> None:
    port = SlowDisplay()
    viewer = Viewer(box_scene(), port)
    viewer.studio.edit(viewer.studio.scene.replace(ambient=0.5))
    viewer.session.turn_to(screen)
    viewer.tell("")
    port.display.joystick.move_to(300, 100)
    viewer.poll()
    viewer.poll()
    port.display.joystick.track = True
    port.pages = port.most_waiting = 0
    for number in range(1, 6):
        # The pointer moves on before the display has drawn the last page.
        port.display.joystick.move_to(300 + 20 * number, 100)
        viewer.poll()
    assert port.most_waiting == 1
    assert 4 <= port.pages <= 5
    # The pointer stops: the page of its last place is the last one.
    viewer.poll()
    drawn = port.pages
    viewer.poll()
    assert (port.pages, len(port.waiting)) == (drawn, 0)
    words = port.display.words.copy()
    viewer.tell("")
    port.receive(0)
    assert np.array_equal(port.display.words, words)
