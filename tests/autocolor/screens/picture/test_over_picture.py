from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor import Paint, Scene, View
from autocolor.scene.orbit import moved, panned, turned
from autocolor.screens.input import turn_between, wheel_ratio
from autocolor.screens.keys import show_other
from autocolor.screens.session import Clipboard
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before
from tests.autocolor.screens.hand import Hand
from tests.small import boxes

FLOOR = 320, 430
BACKGROUND = 20, 20


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_before(ball_scene(), tmp_path)


def level_at(hand: Hand, surface: str, element: int, line: int) -> str:
    first, levels = hand.viewer.studio.level_ranges[surface]
    return f"level {hand.viewer.studio.words[line, element] - first} of {levels - 1}"


def test_a_pick_names_and_chooses_part_and_surface(hand: Hand) -> None:
    session = hand.viewer.session
    hand.click(*FLOOR)
    # A name that is both is told once.
    assert hand.message == f"floor, {level_at(hand, 'floor', *FLOOR)}"
    assert (session.surface_name, session.part_name) == ("floor", "floor")
    hand.click(*MIDDLE)
    assert hand.message == f"ball - paint, {level_at(hand, 'paint', *MIDDLE)}"
    assert (session.surface_name, session.part_name) == ("paint", "ball")
    assert hand.scene is hand.viewer.studio.history.start
    hand.click(*BACKGROUND)
    assert hand.message == "the background"
    assert (session.surface_name, session.part_name) == ("paint", "ball")
    hand.press("tab")
    hand.viewer.tell("")
    hand.move(*MIDDLE)
    assert hand.hint == "ball, paint: drag turns, click chooses, Shift explains"
    hand.move(*BACKGROUND)
    assert hand.hint == hand.viewer.board.screen.help


def test_the_legend_is_picked_and_placed_but_not_that_of_another_state(tmp_path: Path) -> None:
    hand = hand_before(ball_scene().with_scalar(name="z"), tmp_path)
    session = hand.viewer.session
    hand.click(600, 100)
    assert hand.message == "the legend: pick its new place"
    hand.click(40, 120)
    assert hand.handle("the legend") == (40, 120)
    hand.press("Ctrl+Z")
    session.edit(session.scene.replace(scalar=None))
    before = session.scene
    show_other(hand.viewer)
    hand.drag((600, 100), (500, 150))
    assert session.scene.view != before.view
    assert not session.news.is_warning


def test_what_is_under_the_menu_or_a_message_is_not_the_picture(hand: Hand) -> None:
    scene = hand.scene
    hand.viewer.session.edit(scene.replace(view=scene.view.replace(field_of_view=8.0)))
    hand.click(*MIDDLE)
    hand.press("tab")
    for element, line in ((630, 460), (320, 475)):
        assert hand.viewer.studio.seen_at(line, element)
        hand.viewer.session.part_name = "none"
        hand.viewer.tell("a message")
        hand.click(element, line)
        assert hand.viewer.session.part_name == "none"
        assert "level" not in hand.hint


HELD: dict[str, tuple[dict[str, bool], int, Callable[[Scene], View]]] = {
    "plain": ({}, 1, lambda scene: turned(scene, *turn_between(0, 0, 30, 10))),
    "Shift": ({"shift": True}, 1, lambda scene: panned(scene, 30, 10, 480, 640)),
    "middle": ({}, 2, lambda scene: panned(scene, 30, 10, 480, 640)),
    "Ctrl": ({"control": True}, 1, lambda scene: moved(scene, wheel_ratio(-10 / 8))),
}


@pytest.mark.parametrize("name", HELD)
def test_a_drag_turns_moves_or_comes_closer(hand: Hand, name: str) -> None:
    held, button, view_of = HELD[name]
    before, viewer = hand.scene, hand.viewer
    # Only a plain drag at a highlight would move it; also a drag that begins beside its reach turns.
    element, line = hand.handle("highlight of key")
    element += 9 if name == "plain" else 0
    viewer.on_pointer(element, line, "press", button, 1, **held)
    viewer.on_pointer(element + 30, line + 10, "move", 0, 1, **held)
    viewer.on_pointer(element + 30, line + 10, "release", button, 1, **held)
    assert hand.scene.lights is before.lights
    assert viewer.studio.scene.view == view_of(before)
    assert viewer.studio.history.timeline.views_back == (before.view,)
    viewer.studio.view_back()
    viewer.on_pointer(400, 100, "wheel up", steps=2)
    assert viewer.studio.scene.view == moved(before, wheel_ratio(2))


KEYS: dict[str, tuple[str, Callable[[Scene], Scene]]] = {
    "1": ("light key off", lambda scene: scene.with_light("key", on=False)),
    "2": ("light fill off", lambda scene: scene.with_light("fill", on=False)),
    "3": ("the scene has no light 3", lambda scene: scene),
    "s": ("surface floor", lambda scene: scene),
    "Shift+S": ("surface floor", lambda scene: scene),
    "[": ("blend 0.55", lambda scene: scene.with_paint("paint", blend=0.55)),
    "]": ("blend 0.65", lambda scene: scene.with_paint("paint", blend=0.65)),
    ".": ("angle 5 degrees", lambda scene: scene.with_view(angle=5.0)),
    "home": ("the view as opened", lambda scene: scene),
}


@pytest.mark.parametrize("key", KEYS)
def test_a_key_edits_lights_or_paint_in_one_step_or_turns_the_view_once(hand: Hand, key: str) -> None:
    message, after = KEYS[key]
    before = hand.scene
    hand.press(key)
    assert hand.message == message
    assert hand.scene.equals(after(before))
    hand.press("Ctrl+Z", "Alt+Left")
    assert hand.scene.equals(before)


def test_a_key_holds_the_exposure_and_releases_it(hand: Hand) -> None:
    before = hand.scene
    hand.press("e")
    assert hand.message == "exposure held: less light is darker"
    entries = hand.viewer.studio.entries
    assert hand.scene.exposure != before.exposure
    hand.press("e")
    assert hand.message == "exposure released"
    assert hand.scene.equals(before)
    assert np.array_equal(hand.viewer.studio.entries, entries)
    hand.press("1", "2")
    hand.viewer.session.edit(hand.scene.replace(ambient=0.0))
    hand.press("e")
    assert hand.message.startswith("to hold the exposure, a surface must have different intensities")


@pytest.mark.parametrize(
    ("screen", "left", "right"), [("scalar", 8, 100), ("mapping", 350, 500), ("picture", 500, 640)]
)
def test_it_stands_where_a_screen_has_room(tmp_path: Path, screen: str, left: int, right: int) -> None:
    viewer = Viewer(boxes().with_scalar(name="z"), Ramtek9300(), tmp_path)
    viewer.session.turn_to(screen)
    viewer.tell("")
    area = viewer.board.content.items[0].area
    assert left <= area.left <= area.right < right
    viewer.session.turn_to("blending")
    viewer.tell("")
    assert not viewer.board.content.items


def color_seen(hand: Hand, element: int, line: int) -> tuple[int, ...]:
    studio = hand.viewer.studio
    return tuple(studio.entries[studio.words[line, element]].tolist())


def paint_of(hand: Hand, surface: str) -> Paint:
    return hand.scene.surfaces[surface].paint


def test_a_key_takes_the_paint_under_the_pointer_for_the_chosen_surface(hand: Hand) -> None:
    hand.viewer.studio.recolor("paint", object_color="#123456", blend=0.25)
    before, words = hand.scene, hand.viewer.studio.words
    paint = paint_of(hand, "paint")
    assert paint_of(hand, "floor") != paint
    hand.click(*FLOOR)
    hand.move(*MIDDLE)
    hand.press("p")
    assert hand.message == "floor: the paint of paint; undo goes back"
    assert (paint_of(hand, "floor"), paint_of(hand, "paint")) == (paint, paint)
    assert np.array_equal(hand.viewer.studio.words, words)
    hand.press("Ctrl+Z")
    assert hand.scene is before
    # With Shift it takes the color that is seen.
    color, own = color_seen(hand, *MIDDLE), paint_of(hand, "floor")
    hand.press("Shift+P")
    assert hand.message == "floor: object color #{:02x}{:02x}{:02x}".format(*color)
    assert paint_of(hand, "floor") == own.replace(object_color=color)


@pytest.mark.parametrize("key", ["p", "Shift+P"])
def test_nothing_is_taken_from_the_background_the_menu_or_the_chosen_surface(hand: Hand, key: str) -> None:
    scene = hand.scene
    hand.click(*FLOOR)
    hand.move(*BACKGROUND)
    hand.press(key)
    nowhere = "no surface is under the pointer; point at it in the picture"
    assert hand.message == nowhere
    hand.open_menu()
    hand.move(570, 430)
    hand.press(key)
    assert hand.message == nowhere
    hand.move(*FLOOR)
    hand.press("p")
    assert hand.message == "floor is the chosen surface; point at another, whose paint it takes"
    assert hand.scene is scene


def test_the_color_under_the_pointer_is_copied_and_pasted_as_the_object_color(hand: Hand) -> None:
    held: list[str] = []

    def copy(text: str) -> bool:
        held.append(text)
        return True

    hand.viewer.session.clipboard = Clipboard(copy, lambda: held[0])
    hand.click(*FLOOR)
    hand.move(*MIDDLE)
    hand.press("Ctrl+C")
    color = color_seen(hand, *MIDDLE)
    assert held == ["#{:02x}{:02x}{:02x}".format(*color)]
    hand.press("Ctrl+V")
    assert paint_of(hand, "floor").object_color == color
    hand.move(*BACKGROUND)
    hand.press("Ctrl+C")
    assert hand.message == "nothing is there to copy; point at a color"
