from __future__ import annotations

import itertools
import os
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError, Light, Mesh, Scene, Surface, View, read_picture, scene_of
from autocolor.arrays import Words
from autocolor.errors import UsageError
from autocolor.scene.changes import PartChanges
from autocolor.scene.columns import Tier
from autocolor.scene.defaults import framed
from autocolor.screens.input import Binding, Chord, Gesture
from autocolor.screens.message_line import MESSAGE
from autocolor.screens.picture.picture_edits import panned
from autocolor.screens.screen import Screen
from autocolor.screens.session import MESSAGE_SECONDS, Session
from autocolor.screens.viewer import BINDINGS, SCREENS, WHEEL, WINDOW_KEYS, Action, Viewer
from autocolor.studio import Studio
from autocolor.widgets.items import ORANGE, Area
from autocolor.widgets.menu import MESSAGE_CHARACTERS
from autocolor.widgets.sheet import Sheet
from autocolor.widgets.widget import Button
from ramtek_emu import GMR_9300, Ramtek9300
from tests.autocolor.screens.boards import Desk, desk_viewer, middle_of, point
from tests.small import cube, grid, wall_scene

KEY = Light("key", (2, -3, 4), aim=(0, 0, 0))


def box_scene() -> Scene:
    """A cube of two surfaces under two lights, and a surface that no part has."""
    mesh = Mesh(cube().coordinates, cube().node_numbers, np.array([0, 0, 0, 1, 1, 1]), ("low", "high"))
    lights = [KEY, Light("fill", (-3, -3, 1), intensity=0.5)]
    view = View((-2, -3, 2), target=(0.5, 0.5, 0.5))
    return scene_of(
        mesh,
        surfaces=[Surface(name) for name in ("unused", "low", "high")],
        lights=lights,
        view=view,
        name="box",
    )


@pytest.fixture
def viewer(tmp_path: Path) -> Viewer:
    return Viewer(box_scene(), Ramtek9300(), folder=tmp_path)


def display_of(viewer: Viewer) -> Ramtek9300:
    assert isinstance(viewer.display, Ramtek9300)
    return viewer.display


def is_true_to(viewer: Viewer, scene: Scene) -> bool:
    """Whether the display has what it has after that scene alone was sent to it, but for the message."""
    message = viewer.message
    viewer.tell("")
    fresh = Ramtek9300()
    Studio(scene, fresh)
    display = display_of(viewer)
    is_true = np.array_equal(display.words, fresh.words)
    viewer.tell(message)
    return is_true and np.array_equal(display.entries, fresh.entries)


def control(viewer: Viewer, letter: str, shift: bool = False) -> None:
    viewer.on_key(letter, control=True, shift=shift)


def press_c(viewer: Viewer) -> None:
    viewer.on_key("c", typed="c")


EDITS: dict[str, Callable[[Viewer], object]] = {
    "left": lambda viewer: viewer.on_key("left"),
    "right": lambda viewer: viewer.on_key("right"),
    "up": lambda viewer: viewer.on_key("up"),
    "down": lambda viewer: viewer.on_key("down"),
    "plus": lambda viewer: viewer.on_key("=", shift=True, typed="+"),
    "equals": lambda viewer: viewer.on_key("=", typed="="),
    "minus": lambda viewer: viewer.on_key("-", typed="-"),
    "keypad plus": lambda viewer: viewer.on_key("[+]", typed="+"),
    "comma": lambda viewer: viewer.on_key(",", typed=","),
    "point": lambda viewer: viewer.on_key(".", typed="."),
    "rescale": lambda viewer: viewer.on_key("r", typed="r"),
    "light 1": lambda viewer: viewer.on_key("1", typed="1"),
    "light 2 of a French keyboard": lambda viewer: viewer.on_key("é", shift=True, typed="2"),
    "light 2 of the keypad": lambda viewer: viewer.on_key("[2]", typed="2"),
    "bracket": lambda viewer: viewer.on_key("[", typed="["),
    "bracket of a German keyboard": lambda viewer: viewer.on_key("8", typed="["),
    "closing bracket": lambda viewer: viewer.on_key("]", typed="]"),
    "exposure": lambda viewer: viewer.on_key("e", typed="e"),
    "color": press_c,
    "color before": lambda viewer: viewer.on_key("c", shift=True, typed="C"),
}


@pytest.mark.parametrize("name", EDITS)
def test_each_edit_is_shown_undone_and_done_again(viewer: Viewer, name: str) -> None:
    before = viewer.studio.scene
    EDITS[name](viewer)
    after = viewer.studio.scene
    assert after is not before
    assert is_true_to(viewer, after)
    control(viewer, "z")
    assert viewer.studio.scene is before
    assert viewer.message.startswith("undone: ")
    assert is_true_to(viewer, before)
    control(viewer, "y")
    assert viewer.studio.scene is after
    assert viewer.message.startswith("redone: ")
    control(viewer, "z")
    control(viewer, "z", shift=True)
    assert viewer.studio.scene is after
    assert is_true_to(viewer, after)


def test_the_picture_is_sent_once_when_a_viewer_opens(tmp_path: Path) -> None:
    display = Ramtek9300()
    Viewer(box_scene(), display, tmp_path)
    assert display.words_received < 1.1 * display.frame_buffer.words.size


def test_keys_do_what_the_help_page_says(viewer: Viewer) -> None:
    def scene() -> Scene:
        return viewer.studio.scene

    EDITS["plus"](viewer)
    assert np.linalg.norm(np.subtract(scene().view.eye, 0.5)) < np.linalg.norm([2.5, 3.5, 1.5])
    EDITS["up"](viewer)
    EDITS["point"](viewer)
    assert scene().view.angle == 5
    EDITS["light 2 of the keypad"](viewer)
    assert [light.on for light in scene().lights] == [True, False]
    assert viewer.message == "light fill off"
    EDITS["bracket of a German keyboard"](viewer)
    assert scene().surface("low").paint.blend == pytest.approx(0.55)
    assert viewer.message == "blend 0.55"


def test_the_exposure_is_held_and_released(viewer: Viewer) -> None:
    words = viewer.studio.words.copy()
    viewer.on_key("e", typed="e")
    assert viewer.message == "exposure held: less light is darker"
    assert dict(viewer.studio.scene.exposure)["object"] == pytest.approx(  # type: ignore[arg-type]
        tuple(viewer.studio.picture.ranges.whole)
    )
    viewer.on_key("1", typed="1")
    assert not (viewer.studio.words > words).any()
    viewer.on_key("e", typed="e")
    assert (viewer.message, viewer.studio.scene.exposure) == ("exposure released", "auto")


def test_the_exposure_is_released_also_after_it_was_held_again(viewer: Viewer) -> None:
    def press() -> None:
        viewer.on_key("e", typed="e")

    for digit in "12":
        viewer.on_key(digit, typed=digit)
    press()
    viewer.on_key("1", typed="1")
    press()
    press()
    assert viewer.studio.scene.exposure == "auto"
    control(viewer, "z")
    assert viewer.studio.scene.exposure != "auto"
    press()
    assert viewer.studio.scene.exposure == "auto"


def test_without_a_step_there_is_nothing_to_undo_or_to_do_again(viewer: Viewer) -> None:
    control(viewer, "z")
    assert viewer.message == "nothing to undo"
    control(viewer, "y")
    assert viewer.message == "nothing to redo"


def test_a_key_of_an_absent_light_shows_a_message(viewer: Viewer) -> None:
    before = viewer.studio.scene
    viewer.on_key("9", typed="9")
    assert viewer.message == "the scene has no light 9"
    assert viewer.studio.scene is before


@pytest.mark.parametrize(("name", "typed"), [("left", ""), ("=", "+"), (",", ","), ("]", "]")])
def test_a_key_held_down_is_one_step(viewer: Viewer, name: str, typed: str) -> None:
    before = viewer.studio.scene
    viewer.on_key(name, typed=typed)
    once = viewer.studio.scene
    for _ in range(3):
        viewer.on_key(name, typed=typed, repeated=True)
    assert viewer.studio.scene is not once
    control(viewer, "z")
    assert viewer.studio.scene is before
    assert not viewer.studio.undo()


@pytest.mark.parametrize(("name", "typed"), [("f1", ""), ("f4", ""), ("1", "1"), ("e", "e")])
def test_a_switch_does_not_flip_while_its_key_is_held_down(viewer: Viewer, name: str, typed: str) -> None:
    assert viewer.on_key(name, typed=typed)
    switched = viewer.page, viewer.studio.scene
    for _ in range(3):
        assert viewer.on_key(name, typed=typed, repeated=True)
        assert (viewer.page, viewer.studio.scene) == switched


def test_escape_held_down_goes_back_one_step_only(viewer: Viewer) -> None:
    viewer.on_key("f1")
    viewer.on_key("escape", repeated=True)
    assert viewer.page == "help"
    viewer.on_key("escape")
    assert viewer.page == "picture"
    assert viewer.on_key("escape", repeated=True)


def test_undo_and_colors_go_on_while_their_key_is_held_down(viewer: Viewer) -> None:
    before = viewer.studio.scene
    press_c(viewer)
    viewer.on_key("c", typed="c", repeated=True)
    viewer.on_key("z", control=True)
    assert viewer.studio.scene is not before
    viewer.on_key("z", control=True, repeated=True)
    assert viewer.studio.scene is before


def test_a_key_pressed_again_is_a_step_of_its_own(viewer: Viewer) -> None:
    viewer.on_key("left")
    once = viewer.studio.scene
    viewer.on_key("left")
    control(viewer, "z")
    assert viewer.studio.scene is once


def test_a_key_held_down_after_another_is_not_mixed_into_its_step(viewer: Viewer) -> None:
    before = viewer.studio.scene
    press_c(viewer)
    colored = viewer.studio.scene
    # Held down while c was pressed: its own first edit is one that is marked as repeated.
    viewer.on_key("left", repeated=True)
    control(viewer, "z")
    assert viewer.studio.scene is colored
    control(viewer, "z")
    assert viewer.studio.scene is before


def test_an_edit_that_changes_nothing_is_no_step(viewer: Viewer) -> None:
    for _ in range(30):
        viewer.on_key("]", typed="]")
        viewer.on_key("up")
    viewer.on_key("r", typed="r")
    scene = viewer.studio.scene
    viewer.on_key("]", typed="]")
    viewer.on_key("up")
    viewer.on_key("r", typed="r")
    assert viewer.studio.scene is scene


def test_keys_that_do_nothing_are_not_taken(viewer: Viewer) -> None:
    assert not viewer.on_key("q", typed="q")
    assert not viewer.on_key("s", control=True, shift=True)
    assert not viewer.on_key("f1", control=True)


@pytest.mark.parametrize("page", ["f1", "f4"])
@pytest.mark.parametrize("back", ["the same key", "escape"])
def test_a_page_and_back_gives_the_words_byte_for_byte(viewer: Viewer, page: str, back: str) -> None:
    display = display_of(viewer)
    viewer.tell("")
    words, entries = display.words.copy(), display.entries.copy()
    assert viewer.on_key(page)
    assert not np.array_equal(display.words, words)
    assert np.array_equal(display.entries, entries)
    assert viewer.on_key(page if back == "the same key" else "escape")
    assert np.array_equal(display.words, words)
    assert np.array_equal(display.entries, entries)
    assert viewer.page == "picture"


def test_help_and_entries_lead_to_each_other_and_back_to_the_picture(viewer: Viewer) -> None:
    display = display_of(viewer)
    viewer.tell("")
    words = display.words.copy()
    viewer.on_key("f1")
    viewer.on_key("f4")
    other = Viewer(viewer.studio.scene, Ramtek9300())
    other.tell("")
    other.on_key("f4")
    assert np.array_equal(display.words, display_of(other).words)
    viewer.on_key("f1")
    viewer.on_key("f1")
    assert np.array_equal(display.words, words)


def test_recoloring_writes_no_word_but_the_message_on_any_page(viewer: Viewer) -> None:
    display = display_of(viewer)
    line = 16 * 640
    for page in (None, "f1", "f4"):
        if page:
            viewer.on_key(page)
        viewer.tell("")
        written, entries = display.frame_buffer.written, display.entries.copy()
        words = display.words.copy()
        press_c(viewer)
        viewer.on_key("[", typed="[")
        assert np.array_equal(display.words[:464], words[:464])
        assert display.frame_buffer.written < written + 4 * line
        assert not np.array_equal(display.entries, entries)
    viewer.on_key("escape")
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.parametrize("name", [name for name in EDITS if "color" not in name and "bracket" not in name])
@pytest.mark.parametrize("page", ["f1", "f4"])
def test_an_edit_of_the_picture_leads_back_to_it(viewer: Viewer, page: str, name: str) -> None:
    viewer.on_key(page)
    EDITS[name](viewer)
    assert viewer.page == "picture"
    assert is_true_to(viewer, viewer.studio.scene)


def test_undo_on_a_page_leads_back_to_the_picture(viewer: Viewer) -> None:
    before = viewer.studio.scene
    press_c(viewer)
    viewer.on_key("f4")
    control(viewer, "z")
    assert is_true_to(viewer, before)


def test_the_message_names_the_surface_that_was_chosen(viewer: Viewer) -> None:
    # In full screen, the message is all that tells which one it is.
    viewer.on_key("s")
    assert viewer.message == f"surface {viewer.session.surface_name}"


def test_the_chosen_surface_is_recolored(viewer: Viewer) -> None:
    names = ["low", "high"]
    seen = []
    for _ in names:
        seen.append(viewer.session.surface_name)
        assert f"[{viewer.session.surface_name}]" in viewer.caption
        viewer.on_key("s", typed="s")
    assert seen == names
    assert viewer.session.surface_name == names[0]
    viewer.on_key("s", shift=True, typed="S")
    assert viewer.session.surface_name == names[-1]
    before = viewer.studio.scene
    press_c(viewer)
    changed = [
        old.name for old, new in zip(before.surfaces, viewer.studio.scene.surfaces, strict=True) if old != new
    ]
    assert changed == [names[-1]]


def test_the_colors_come_round_in_both_directions(viewer: Viewer) -> None:
    def color() -> tuple[int, int, int]:
        return viewer.studio.scene.surface("low").paint.object_color

    press_c(viewer)
    first = color()
    press_c(viewer)
    assert color() != first
    viewer.on_key("c", shift=True, typed="C")
    assert color() == first


def test_a_refused_edit_shows_a_message_and_changes_nothing(viewer: Viewer) -> None:
    far = View((0, -9.9e35, 0), target=(0, 0, 0))
    viewer.studio.edit(viewer.studio.scene.replace(view=far))
    before = viewer.studio.scene
    assert viewer.on_key("-", typed="-")
    assert viewer.studio.scene is before
    assert "must be three finite numbers" in viewer.message
    assert viewer.message in viewer.caption


def test_a_mesh_without_anything_can_be_looked_at(tmp_path: Path) -> None:
    nothing = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    scene = Scene(nothing, (), (), (), View((0, -1, 0), target=(0, 0, 0)))
    viewer = Viewer(scene, Ramtek9300(), folder=tmp_path)
    for press in EDITS.values():
        press(viewer)
    for key in ("s", "f1", "f4", "escape"):
        viewer.on_key(key)
    control(viewer, "s")
    assert viewer.caption.startswith("autocolor - scene - saved ")


# Saving, leaving, opening.


def test_the_caption_marks_unsaved_changes(viewer: Viewer) -> None:
    assert viewer.caption == "autocolor - box - [low] - F1: help; Tab or the right edge: the menu"
    press_c(viewer)
    assert viewer.caption.startswith("autocolor - box* - [low]")
    control(viewer, "z")
    assert viewer.caption == "autocolor - box - [low] - undone: low: object color #f4a39b"


def test_saving_names_its_files_and_overwrites_none(viewer: Viewer, tmp_path: Path) -> None:
    (tmp_path / "box.npz").write_bytes(b"mine")
    press_c(viewer)
    control(viewer, "s")
    assert viewer.message.startswith("saved ")
    assert not viewer.studio.is_changed
    assert b"mine" in [path.read_bytes() for path in tmp_path.iterdir() if path.is_file()]
    viewer.on_key("left")
    control(viewer, "s")
    assert not viewer.studio.is_changed
    pictures = [read_picture(path) for path in tmp_path.glob("*.npz") if path.read_bytes() != b"mine"]
    assert viewer.studio.scene.view in [picture.scene.view for picture in pictures]


@pytest.mark.parametrize("name", ["a/b\0c", "..", "", "x" * 300, "\udcff"])
def test_a_scene_of_any_name_can_be_saved(name: str, tmp_path: Path) -> None:
    viewer = Viewer(box_scene().replace(name=name), Ramtek9300(), folder=tmp_path)
    control(viewer, "s")
    assert viewer.message.startswith("saved ")
    assert os.listdir(tmp_path)


def test_a_refused_save_shows_a_message_and_stays_unsaved(viewer: Viewer, tmp_path: Path) -> None:
    viewer.session.folder = tmp_path / "none"
    press_c(viewer)
    control(viewer, "s")
    assert viewer.session.news.is_warning
    assert viewer.studio.is_changed
    assert os.listdir(tmp_path) == []


def test_closing_without_changes_asks_nothing(viewer: Viewer) -> None:
    assert not viewer.on_key("escape")
    assert viewer.on_close()


def test_closing_with_unsaved_work_takes_two_times_in_a_row(viewer: Viewer) -> None:
    press_c(viewer)
    assert not viewer.on_close()
    assert viewer.message == "not saved: Ctrl+S saves, close again to discard the changes"
    viewer.on_key("f1")
    assert not viewer.on_close()
    assert viewer.on_close()


def test_changes_of_a_scene_that_another_was_opened_after_are_not_lost_by_closing(
    viewer: Viewer, tmp_path: Path
) -> None:
    (tmp_path / "other.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    press_c(viewer)
    viewer.on_drop(tmp_path / "other.obj")
    assert not viewer.studio.is_changed
    assert not viewer.on_close()
    assert viewer.message == "box is not saved: undo goes back to it, close again to discard the changes"
    assert viewer.on_close()
    control(viewer, "z")
    viewer.session.save()
    control(viewer, "y")
    assert viewer.on_close()


def test_closing_after_undoing_everything_needs_no_question(viewer: Viewer) -> None:
    press_c(viewer)
    control(viewer, "z")
    assert viewer.on_close()


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 0 1\ng roof\nf 1 2 3\n"


def test_a_dropped_mesh_is_opened(viewer: Viewer, tmp_path: Path) -> None:
    (tmp_path / "roof.obj").write_text(TRIANGLE)
    viewer.on_key("s", typed="s")
    viewer.on_key("f1")
    viewer.on_drop(tmp_path / "roof.obj")
    assert viewer.message == "opened roof.obj; undo goes back"
    assert viewer.studio.scene.name == "roof"
    assert viewer.page == "picture"
    assert is_true_to(viewer, viewer.studio.scene)
    control(viewer, "z")
    assert viewer.studio.scene.name == "box"


def test_a_dropped_file_of_another_kind_shows_a_message_and_changes_nothing(
    viewer: Viewer, tmp_path: Path
) -> None:
    display = display_of(viewer)
    viewer.tell("")
    words, scene = display.words.copy(), viewer.studio.scene
    (tmp_path / "bad.obj").write_text("v 0 0 zero\n")
    for name, sentence in (("bad.obj", "bad.obj, line 1"), ("none.obj", "there is no such file")):
        viewer.on_drop(tmp_path / name)
        assert sentence in viewer.message
        assert "\n" not in viewer.message
        assert (display.words[MESSAGE.top :] == ORANGE).any()
    assert viewer.studio.scene is scene
    viewer.tell("")
    assert np.array_equal(display.words, words)


def test_a_file_dropped_on_unsaved_work_loses_nothing(viewer: Viewer, tmp_path: Path) -> None:
    (tmp_path / "roof.obj").write_text(TRIANGLE)
    press_c(viewer)
    scene = viewer.studio.scene
    viewer.on_drop(tmp_path / "roof.obj")
    assert viewer.studio.scene.name == "roof"
    control(viewer, "z")
    assert viewer.studio.scene is scene


def test_a_dropped_scene_is_saved_under_its_own_name(viewer: Viewer, tmp_path: Path) -> None:
    (tmp_path / "roof.obj").write_text(TRIANGLE)
    control(viewer, "s")
    viewer.on_drop(tmp_path / "roof.obj")
    control(viewer, "s")
    assert {"box.npz", "roof.npz"} <= set(os.listdir(tmp_path))


def test_rescale_frames_the_object_and_leaves_the_stage_out(tmp_path: Path) -> None:
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    view = View((-9, -9, 6), target=(0.5, 0.5, 0.5))
    parts: dict[str, PartChanges] = {"floor": {"stage": True}}
    scene = scene_of(Mesh.joined([cube(), floor]), view=view, parts=parts, lights=[KEY])
    shown = Viewer(scene, Ramtek9300(), folder=tmp_path)
    shown.on_key("r", typed="r")
    assert shown.studio.scene.view == framed(view, cube().coordinates)
    control(shown, "z")
    shown.studio.edit(scene.with_part("floor", stage=False))
    shown.on_key("r", typed="r")
    assert shown.studio.scene.view == framed(view, Mesh.joined([cube(), floor]).coordinates)


# Movements, the mouse, full screen.


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock on which every picture takes a second."""
    ticks = itertools.count()
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: float(next(ticks)))


@pytest.mark.usefixtures("slow")
def test_a_picture_is_coarse_while_a_key_is_held_and_refined_when_it_rests(viewer: Viewer) -> None:
    viewer.on_key("left")
    viewer.on_key("left", repeated=True)
    viewer.on_tick(is_at_rest=False)
    assert viewer.studio.is_coarse
    assert not is_true_to(viewer, viewer.studio.scene)
    viewer.on_tick(is_at_rest=True)
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.usefixtures("slow")
def test_a_picture_is_refined_while_a_key_is_held_that_changes_nothing_more(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer.on_key("left")
    now = time.monotonic()
    monkeypatch.setattr("time.monotonic", lambda: now + 1)
    viewer.on_tick(is_at_rest=False)
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.usefixtures("slow")
def test_between_steps_of_the_wheel_a_picture_stays_coarse(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer.on_pointer(300, 200, "wheel up")
    viewer.on_tick(is_at_rest=True)
    assert viewer.studio.is_coarse
    now = time.monotonic()
    monkeypatch.setattr("time.monotonic", lambda: now + 1)
    viewer.on_tick(is_at_rest=True)
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.usefixtures("slow")
@pytest.mark.parametrize("name", ["r", "1", "e"])
def test_an_edit_without_a_movement_is_fine_at_once(viewer: Viewer, name: str) -> None:
    viewer.on_key("left")
    viewer.on_key(name, typed=name)
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.usefixtures("slow")
@pytest.mark.parametrize("page", ["f1", "f4"])
def test_a_page_is_left_to_a_fine_picture(viewer: Viewer, page: str) -> None:
    viewer.on_key("left")
    viewer.on_key(page)
    viewer.on_key(page)
    assert is_true_to(viewer, viewer.studio.scene)


@pytest.mark.usefixtures("slow")
def test_a_movement_whose_fine_picture_is_refused_is_taken_back(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = viewer.studio.scene
    viewer.on_key("left")

    def refuse() -> None:
        raise InputError("an intensity must be finite, not inf")

    monkeypatch.setattr(viewer.studio, "refine", refuse)
    viewer.on_tick()
    assert viewer.message == "an intensity must be finite, not inf"
    assert is_true_to(viewer, before)


def drag(viewer: Viewer, *places: tuple[int, int], released: bool = True) -> None:
    viewer.on_pointer(*places[0], "press", 1)
    for place in places[1:]:
        viewer.on_pointer(*place, "move")
    if released:
        viewer.on_pointer(*places[-1], "release", 1)


def test_a_drag_turns_around_the_object_and_is_one_step(viewer: Viewer) -> None:
    before = viewer.studio.scene
    drag(viewer, (300, 200), (320, 200), (340, 190))
    eye, target = viewer.studio.scene.view.eye, np.array([0.5, 0.5, 0.5])
    assert eye != before.view.eye
    assert np.linalg.norm(eye - target) == pytest.approx(np.linalg.norm(before.view.eye - target))
    drag(viewer, (340, 190), (360, 190))
    control(viewer, "z")
    assert viewer.studio.scene.view.eye == eye
    control(viewer, "z")
    assert viewer.studio.scene is before
    assert not viewer.studio.undo()


def test_a_drag_with_the_middle_button_moves_the_picture_and_is_one_step(viewer: Viewer) -> None:
    before = viewer.studio.scene
    viewer.on_pointer(300, 200, "press", 2)
    # The release of another button does not end it.
    viewer.on_pointer(310, 210, "move")
    viewer.on_pointer(310, 210, "release", 1)
    viewer.on_pointer(330, 190, "move")
    viewer.on_pointer(330, 190, "release", 2)
    viewer.on_pointer(400, 400, "move")
    once = panned(before, 30, -10, 480, 640)
    assert viewer.studio.scene.view.eye == pytest.approx(once.eye)
    assert is_true_to(viewer, viewer.studio.scene)
    control(viewer, "z")
    assert viewer.studio.scene is before


def test_a_key_with_shift_turns_finely(viewer: Viewer) -> None:
    before = viewer.studio.scene
    for _ in range(5):
        viewer.on_key("left", shift=True)
    finely = viewer.studio.scene.view.eye
    viewer.studio.edit(before)
    viewer.on_key("left")
    assert finely == pytest.approx(viewer.studio.scene.view.eye)


def test_named_views_look_from_the_sides(viewer: Viewer) -> None:
    seen = []
    for number in range(5, 10):
        viewer.on_key(f"f{number}")
        assert is_true_to(viewer, viewer.studio.scene)
        seen.append((viewer.message, np.round(viewer.studio.scene.view.axes[2], 2).tolist()))
    assert seen[:4] == [
        ("view: from -y", [0, 1, 0]),
        ("view: from x", [-1, 0, 0]),
        ("view: from y", [0, -1, 0]),
        ("view: top", [0, 0, -1]),
    ]
    assert seen[4][0] == "view: three quarters"


def test_a_movement_without_a_button_and_a_click_change_nothing(viewer: Viewer) -> None:
    before = viewer.studio.scene
    viewer.on_pointer(10, 10, "move")
    drag(viewer, (300, 200))
    viewer.on_pointer(400, 10, "move")
    assert viewer.studio.scene is before


def test_escape_takes_a_drag_back(viewer: Viewer) -> None:
    viewer.on_key("left")
    before = viewer.studio.scene
    drag(viewer, (300, 200), (320, 220), released=False)
    assert viewer.studio.scene is not before
    assert viewer.on_key("escape")
    assert viewer.studio.scene is before
    viewer.on_pointer(400, 300, "move")
    assert viewer.studio.scene is before
    # A drag that changed nothing takes nothing back.
    drag(viewer, (300, 200), released=False)
    viewer.on_key("escape")
    assert viewer.studio.scene is before


def test_the_wheel_moves_closer_and_its_steps_are_one_step_to_undo(viewer: Viewer) -> None:
    before = viewer.studio.scene
    for _ in range(3):
        viewer.on_pointer(300, 200, "wheel up", steps=2)
    target = np.array([0.5, 0.5, 0.5])
    assert np.linalg.norm(viewer.studio.scene.view.eye - target) < np.linalg.norm(before.view.eye - target)
    viewer.on_pointer(300, 200, "wheel down", steps=6)
    assert viewer.studio.scene.view.eye == pytest.approx(before.view.eye)
    control(viewer, "z")
    assert viewer.studio.scene is before


@pytest.mark.parametrize("page", ["f1", "f4"])
def test_on_a_page_the_mouse_changes_nothing(viewer: Viewer, page: str) -> None:
    before = viewer.studio.scene
    viewer.on_key(page)
    viewer.tell("")
    words = display_of(viewer).words.copy()
    drag(viewer, (300, 200), (320, 220))
    assert np.array_equal(display_of(viewer).words, words)
    viewer.on_pointer(300, 200, "wheel up")
    assert viewer.studio.scene is before


def test_a_message_stands_over_the_picture_for_a_while(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    picture = viewer.studio.words
    assert np.array_equal(display_of(viewer).words[:464], picture[:464])
    assert not np.array_equal(display_of(viewer).words, picture)
    viewer.tell("")
    assert np.array_equal(display_of(viewer).words, picture)
    control(viewer, "s")
    assert not np.array_equal(display_of(viewer).words, picture)
    now = time.monotonic()
    monkeypatch.setattr("autocolor.screens.session.time.monotonic", lambda: now + MESSAGE_SECONDS + 1)
    viewer.on_tick()
    assert np.array_equal(display_of(viewer).words, picture)


def test_the_first_message_stands_until_the_menu_comes_or_something_is_done(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    welcome = "F1: help; Tab or the right edge: the menu"
    now = time.monotonic()
    monkeypatch.setattr("autocolor.screens.session.time.monotonic", lambda: now + 100 * MESSAGE_SECONDS)
    viewer.on_tick()
    viewer.on_pointer(100, 100, "move")
    assert viewer.board.messages[-1].text == welcome
    viewer.on_pointer(638, 0, "move")
    assert viewer.board.messages[-1].text == viewer.screens["light and view"].help
    viewer.tell(welcome, persistent=True)
    viewer.on_key("c", typed="c")
    assert viewer.message != welcome


@pytest.mark.parametrize("name", ["blending", "help"])
def test_a_screen_without_a_menu_tells_how_to_bring_it(viewer: Viewer, name: str) -> None:
    viewer.tell("")
    viewer.session.turn_to(name)
    viewer.on_pointer(100, 100, "move")
    assert viewer.message == f"{viewer.screens[name].help}; the right edge: the menu"
    assert len(viewer.message) <= MESSAGE_CHARACTERS


@pytest.mark.parametrize("page", ["f1", "f4"])
def test_a_message_on_a_page_leaves_it_as_it_was(viewer: Viewer, page: str) -> None:
    viewer.on_key(page)
    viewer.tell("")
    words = display_of(viewer).words.copy()
    viewer.tell("saved somewhere")
    assert not np.array_equal(display_of(viewer).words, words)
    viewer.tell("")
    assert np.array_equal(display_of(viewer).words, words)


def test_a_light_switched_off_and_on_leaves_nothing_to_save(viewer: Viewer) -> None:
    for is_changed in (True, False):
        viewer.on_key("1", typed="1")
        assert viewer.studio.is_changed is is_changed
        assert ("*" in viewer.caption) is is_changed
    assert not viewer.session.unsaved


def test_the_color_before_the_next_color_is_the_surfaces_own(viewer: Viewer) -> None:
    viewer.studio.recolor("low", object_color="#123456")
    for there, back in ((False, True), (True, False)):
        for shift in (there, back):
            viewer.on_key("c", shift=shift, typed="C" if shift else "c")
        assert viewer.studio.scene.surface("low").paint.object_color == (0x12, 0x34, 0x56)


def test_rescale_fills_the_picture_with_the_chosen_surface(tmp_path: Path) -> None:
    window = grid(1, 1, (0.4, 0, 0.6), (0.1, 0, 0), (0, 0, 0.1), "window")
    view = View((-2, -3, 2), target=(0.5, 0.5, 0.5))
    scene = scene_of(Mesh.joined([cube(), window]), view=view, surfaces="parts", lights=[KEY])
    shown = Viewer(scene, Ramtek9300(), folder=tmp_path)
    shown.on_key("s", typed="s")
    assert shown.session.surface_name == "window"
    shown.on_key("r", shift=True, typed="R")
    assert shown.studio.scene.view == framed(view, window.coordinates)
    shown.on_key("r", typed="r")
    assert shown.studio.scene.view == framed(view, Mesh.joined([cube(), window]).coordinates)


def test_closing_asks_also_for_a_scene_with_changes_that_was_open_before(
    viewer: Viewer, tmp_path: Path
) -> None:
    press_c(viewer)
    (tmp_path / "roof.obj").write_text(TRIANGLE)
    viewer.on_drop(tmp_path / "roof.obj")
    assert not viewer.studio.is_changed
    assert not viewer.on_close()
    assert "not saved" in viewer.message
    assert viewer.on_close()


def test_the_display_ends_with_the_present_state_though_another_was_compared(viewer: Viewer) -> None:
    viewer.on_key("left")
    viewer.compare()
    assert not is_true_to(viewer, viewer.studio.scene)
    viewer.clear()
    assert is_true_to(viewer, viewer.studio.scene)


def test_the_display_ends_without_panels_and_without_the_hint_of_a_handle(viewer: Viewer) -> None:
    handle = viewer.board.layout.handles[0]
    viewer.board.over = lambda: [Button("panel", area=Area(8, 8, 99, 23))]
    viewer.on_pointer(handle.element, handle.line, "move")
    viewer.tell("")
    assert viewer.board.messages[0].text.startswith("highlight of fill")
    viewer.clear()
    assert np.array_equal(display_of(viewer).words, viewer.studio.words)


def test_a_pointer_that_was_not_moved_yet_reaches_no_handle(viewer: Viewer) -> None:
    viewer.screens["desk"] = Desk(viewer.session)
    viewer.session.edit(viewer.studio.scene.with_view(eye=(-19.8, -19.8, 2)))
    viewer.session.turn_to("desk")
    viewer.tell("")
    assert viewer.board.handle_at(2, 2) is not None
    assert viewer.board.handle_at(-1, -1) is None


def test_every_screen_has_a_name_and_a_title_of_its_own_and_help() -> None:
    for told in ([each.name for each in SCREENS], [each.title for each in SCREENS]):
        assert all(told)
        assert len(set(told)) == len(told)
    assert all(each.help for each in SCREENS)


@pytest.mark.parametrize("lights", [None, []], ids=["a light", "no light"])
@pytest.mark.parametrize("screen", SCREENS, ids=[each.name for each in SCREENS])
def test_every_screen_is_drawn_hovered_and_left_without_a_trace(
    screen: type[Screen], lights: list[object] | None, tmp_path: Path
) -> None:
    display = Ramtek9300()
    scene = wall_scene() if lights is None else wall_scene(lights=lights)
    viewer = Viewer(scene, display, folder=tmp_path)
    viewer.tell("")
    words, entries = display.words.copy(), display.entries.copy()
    viewer.session.turn_to(screen.name)
    viewer.tell("")
    for element, line in ((560, 40), (560, 200), (300, 200), (100, 400), (5, 475)):
        point(viewer, "hover", element, line)
        fresh = Ramtek9300()
        Sheet(fresh).show(viewer.board.page())
        assert np.array_equal(display.words, fresh.words)
        assert np.array_equal(display.entries, fresh.entries)
    viewer.session.turn_to("picture")
    viewer.tell("")
    assert np.array_equal(display.words, words)
    assert np.array_equal(display.entries, entries)
    assert viewer.studio.scene is scene


def test_the_wheel_makes_one_step_on_each_widget(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    element, line = middle_of(viewer.board, "ambient")
    for _ in range(3):
        viewer.point(Gesture("wheel", element, line, steps=2))
    assert viewer.studio.scene.ambient == 0.06
    assert viewer._action.kind == WHEEL
    viewer.on_key("z", control=True)
    assert viewer.studio.scene.ambient == 0.0


def test_two_drags_are_two_steps(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    element, line = middle_of(viewer.board, "ambient")
    seen = []
    for shift in (10, 30):
        seen.append(viewer.studio.scene)
        point(viewer, "grab", element, line)
        point(viewer, "drag", element + shift - 5, line)
        point(viewer, "drag", element + shift, line)
        point(viewer, "drop", element + shift, line)
    for scene in reversed(seen):
        viewer.on_key("z", control=True)
        assert viewer.studio.scene is scene


def test_a_key_goes_to_the_typed_text_then_to_the_screen_then_to_its_binding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer = desk_viewer(tmp_path)
    before: list[str] = []

    def key(desk: Desk, name: str, typed: str) -> bool:
        before.append(name)
        return name == "c"

    monkeypatch.setattr(Desk, "key", key)
    scene = viewer.studio.scene
    viewer.on_key("c", typed="c")
    assert viewer.studio.scene is scene
    viewer.on_key("e", typed="e")
    assert before == ["c", "e"]
    assert viewer.studio.scene is not scene
    point(viewer, "hover", *middle_of(viewer.board, "ambient"))
    viewer.on_key("1", typed="1")
    viewer.on_key("e", typed="e")
    assert before == ["c", "e"]
    assert viewer.board.messages[-1].text == "ambient: 1e_"


def test_a_key_with_control_is_never_typed(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    viewer.session.edit(viewer.studio.scene.replace(ambient=0.5))
    point(viewer, "hover", *middle_of(viewer.board, "ambient"))
    viewer.on_key("1", typed="1")
    viewer.on_key("z", control=True, typed="\x1a")
    assert viewer.studio.scene.ambient == 0.0
    assert not viewer.board.typing.is_on


@pytest.fixture
def session(tmp_path: Path) -> Session:
    return desk_viewer(tmp_path).session


def test_continued_edits_are_one_step_and_other_edits_another(session: Session) -> None:
    action, before = Action(session), session.scene
    for value, source, continues in ((0.1, "a", True), (0.2, "a", True), (0.3, "b", True), (0.4, "b", False)):
        change = partial(session.edit, session.scene.replace(ambient=value))
        assert action.do((source, 0), change, continues, False)
        assert action.was_by((source, 0))
        assert action.kind == source
        assert action.costs is Tier.MIX
    seen = []
    while session.studio.undo():
        seen.append(session.scene.ambient)
    assert seen == [0.3, 0.2, 0.0]
    assert session.scene is before


def test_an_error_is_a_message_and_what_does_nothing_leaves_the_last_one(session: Session) -> None:
    action = Action(session)

    def refuse() -> None:
        raise UsageError(("a number must be one", "choose it"))

    assert action.do(None, refuse, False, False)
    assert (session.message, session.news.is_warning) == ("a number must be one; choose it", True)
    assert not action.do(None, lambda: False, False, False)
    assert session.message == "a number must be one; choose it"
    assert action.do(None, lambda: None, False, False)
    assert session.message == ""
    assert action.kind is None


def test_unsaved_changes_are_announced_once(session: Session) -> None:
    action = Action(session)
    session.has_keyboard = True
    assert not action.warns_of_changes("again")
    session.edit(session.scene.replace(ambient=0.5))
    assert action.warns_of_changes("again")
    assert session.message == "not saved: Ctrl+S saves, again"
    assert not action.warns_of_changes("again")
    action.do(None, lambda: None, False, False)
    assert action.warns_of_changes("again")


PRESSES = [(binding, number, chord) for binding in BINDINGS for number, chord in enumerate(binding.chords)]


def test_no_two_keys_are_the_same() -> None:
    chords = Counter(chord for binding in BINDINGS for chord in binding.chords)
    assert not [chord for chord, count in chords.items() if count > 1]


class SlowDisplay:
    """A display elsewhere that draws only when a reply is awaited, while the pointer moves on.

    Transfers of more words than LARGE are counted as pages.
    """

    LARGE = 4_000
    configuration = GMR_9300

    def __init__(self) -> None:
        self.display = Ramtek9300()
        self.waiting: list[Words] = []
        self.most_waiting = self.pages = 0
        self.step = 0
        """How far the pointer moves while a page is drawn, in 50 movements."""

    def send(self, words: Words) -> None:
        self.waiting.append(np.array(words))
        self.most_waiting = max(self.most_waiting, sum(len(each) > self.LARGE for each in self.waiting))

    def receive(self, count: int) -> Words:
        for words in self.waiting:
            self.display.send(words)
            if len(words) > self.LARGE:
                self.pages += 1
                element, line = self.place
                for number in range(50):
                    self.display.joystick.move_to(element + self.step * number // 50, line)
        self.waiting.clear()
        return self.display.receive(count)

    @property
    def place(self) -> tuple[int, int]:
        cursor = self.display.cursors.all[0]
        return cursor.element, cursor.line


@pytest.mark.parametrize("screen", ["picture", "light and view", "split"])
def test_a_moving_pointer_is_at_most_one_page_ahead_of_a_slow_display(screen: str) -> None:
    port = SlowDisplay()
    viewer = Viewer(box_scene(), port)
    viewer.studio.edit(viewer.studio.scene.replace(ambient=0.5))
    viewer.session.turn_to(screen)
    viewer.tell("")
    viewer.poll()
    port.display.joystick.move_to(300, 100)
    viewer.poll()
    port.display.joystick.track = True
    before, port.pages, port.most_waiting, port.step = port.place, 0, 0, 20
    port.display.joystick.move_to(310, 100)
    for _ in range(6):
        viewer.poll()
    assert port.most_waiting == 1
    assert 4 <= port.pages <= 6
    # The pointer stops: the page of its last place is the last one.
    port.step = 0
    port.receive(0)
    drawn = port.pages
    for _ in range(6):
        viewer.poll()
    port.receive(0)
    assert port.pages <= drawn + 1
    assert viewer.board._pointer == port.place != before
    shown = port.display.words.copy()
    viewer._sheet.forget()
    viewer.tell("")
    port.receive(0)
    assert np.array_equal(port.display.words, shown)


@pytest.mark.parametrize(("binding", "number", "chord"), PRESSES, ids=[str(chord) for _, _, chord in PRESSES])
def test_every_key_reaches_what_it_does(
    binding: Binding[Viewer], number: int, chord: Chord, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[object] = []

    def do(viewer: Viewer, source: object, *rest: object) -> bool:
        # The menu and the screen are asked first, and do not take it.
        ran.append(source)
        return source == (binding, number)

    monkeypatch.setattr(Viewer, "_do", do)
    viewer = Viewer(wall_scene(lights=[]), Ramtek9300())
    viewer.on_key(chord.name, chord.control, chord.shift)
    assert ran[-1] == (binding, number)
    assert ran[:-1] == ([] if chord.control else [("key", chord.name)] * 2)


def test_every_key_says_what_it_does_in_words_of_its_own() -> None:
    said = [binding.does for binding in BINDINGS] + [does for _, does in WINDOW_KEYS]
    assert all(said)
    assert len(set(said)) == len(said)


def test_the_keys_of_the_window_are_not_taken_by_the_viewer() -> None:
    taken = {str(chord) for binding in BINDINGS for chord in binding.chords}
    assert not taken & {"F10", "F11", "Ctrl+Q"}
    assert {keys for keys, _ in WINDOW_KEYS} >= {"F10", "Ctrl+Q"}
