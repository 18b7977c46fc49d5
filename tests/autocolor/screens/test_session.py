from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from autocolor import HalfSpace, Light, Scene, Studio, read_scene, write_rig, write_scene
from autocolor.files.paths import SCENE_FILE
from autocolor.files.store.store_file import write_store
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.scene.lights import Links
from autocolor.screens.comparing import BEFORE, NOW
from autocolor.screens.file_actions import SECONDS_BETWEEN, ask_to_leave, open_file, save
from autocolor.screens.keys import toggle
from autocolor.screens.session import LEAST_SECONDS, MESSAGE_SECONDS
from autocolor.screens.steps import undo
from autocolor.screens.viewer import Viewer
from autocolor.sending import shown_colors
from ramtek_emu import Ramtek9300
from tests.autocolor.files.store.stores import run, small_scene
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before, seen_on
from tests.autocolor.screens.boxes import told
from tests.autocolor.screens.hand import Hand
from tests.small import boxes, held, wall_scene
from tests.tables import first


def test_a_rig_loses_links_to_absent_rows_and_says_so(tmp_path: Path) -> None:
    lamp = Light("lamp", (0, -2, 1), links=Links(only_surfaces=("wall",)))
    write_rig(tmp_path / "lamps.toml", wall_scene(lights=[lamp]))
    hand = hand_before(boxes(), tmp_path)
    hand.viewer.on_drop(tmp_path / "lamps.toml")
    assert [light.name for light in hand.scene.lights] == ["lamp"]
    assert hand.scene.lights["lamp"].links == Links()
    assert hand.message == (
        "the lights of lamps.toml, fitted to boxes, without links to what it lacks; undo goes back"
    )


def test_a_rig_that_does_not_fit_is_refused_by_the_name_of_its_file(tmp_path: Path) -> None:
    lamp = '[[lights]]\nname = "lamp"\nposition = [0, 0, 1]\naim = [0, 0, 0]\n'
    (tmp_path / "huge.toml").write_text(f"minimum = [0, 0, 0]\nmaximum = [1e30, 1, 1]\n{lamp}")
    hand = hand_before(boxes(), tmp_path)
    hand.viewer.on_drop(tmp_path / "huge.toml")
    assert hand.message.startswith("huge.toml, light 'lamp': the aim must differ from the position, ")


def test_leaving_first_names_the_changes_that_it_would_lose(tmp_path: Path) -> None:
    session = hand_before(boxes(), tmp_path).viewer.session

    def asked() -> str:
        ask_to_leave(session)
        assert not session.leaves
        return session.message.removesuffix(", or leave once more to discard the changes")

    session.edit(session.scene.replace(ambient=0.6))
    assert asked() == "not saved: save it"
    session.studio.keep_variant("dusk")
    undo(session)
    assert asked() == "variant dusk is not saved: come back to it and save it"
    session.studio.show_variant("dusk")
    save(session)
    session.edit(session.scene.replace(ambient=0.8))
    write_scene(tmp_path / "other", boxes().replace(name="other"))
    open_file(session, tmp_path / "other")
    assert asked().endswith(" is not saved: undo goes back to it")
    ask_to_leave(session)
    assert session.leaves


# Comparing.

PLACE = 335, 205
"""An element and line of the ball to which the highlight is put."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    """A hand that has dragged the highlight."""
    hand = hand_before(ball(), tmp_path)
    hand.drag(hand.handle("highlight of key"), PLACE)
    return hand


@cache
def ball() -> Scene:
    return ball_scene()


@cache
def ball_alone() -> tuple[bytes, bytes]:
    return alone(ball())


def alone(scene: Scene) -> tuple[bytes, bytes]:
    """The words and the entries of a scene by itself."""
    display = Ramtek9300()
    Studio(scene, display)
    return held(display)


def shown(hand: Hand) -> tuple[bytes, bytes]:
    """The words and the entries of the picture, without a menu and a message over it."""
    hand.move(60, 60)
    hand.viewer.tell("")
    return seen_on(hand)


def pick_row(hand: Hand, label: str, share: float = 0.25) -> None:
    hand.open_menu()
    hand.pick(label, share)


def test_the_state_before_is_shown_while_the_key_is_held(hand: Hand, wait: Callable[[float], None]) -> None:
    now = shown(hand)
    for _ in range(2):
        hand.press("b")
        hand.press("b", repeated=True)
        # The message stands as long as the other state does.
        wait(10 * MESSAGE_SECONDS)
        hand.viewer.on_tick()
        assert hand.hint == f"shown: {BEFORE}; now: key: position, aim"
        assert shown(hand) == ball_alone()
        assert hand.scene is not ball()
        hand.viewer.on_release("b")
        assert hand.message == f"shown: {NOW}"
        assert shown(hand) == now
    assert now == alone(hand.scene)


def test_after_undo_the_pointer_names_the_surface_below_it_again(
    hand: Hand, wait: Callable[[float], None]
) -> None:
    hand.open_menu()
    hand.press("tab")
    hand.move(320, 240)
    hand.press("Ctrl+Z")
    board = hand.viewer.board
    assert board.messages[0].text.startswith("undone: key: position")
    hand.move(320, 430)
    wait(LEAST_SECONDS)
    hand.viewer.on_tick()
    assert board.messages[0].text.startswith("floor: drag turns")


def test_each_pick_of_the_row_shows_the_other_state_and_a_pick_in_the_picture_the_present_one(
    hand: Hand,
) -> None:
    now, chosen = shown(hand), hand.viewer.caption.split(" - ")[2]
    for message, wanted in ((f"shown: {BEFORE}; now: ", ball_alone()), (f"shown: {NOW}", now)):
        pick_row(hand, "compare")
        assert hand.message.startswith(message)
        assert shown(hand) == wanted
    pick_row(hand, "compare")
    hand.click(320, 430)
    assert hand.message == f"shown: {NOW}"
    assert shown(hand) == now
    # The pick in the picture does nothing else; the next one chooses the surface.
    assert chosen in hand.viewer.caption
    hand.click(320, 430)
    assert chosen not in hand.viewer.caption


ENDINGS: dict[str, Callable[[Hand], object]] = {
    "a drag over the picture": lambda hand: hand.drag((60, 60), (90, 60)),
    "an undo": lambda hand: pick_row(hand, " ", 0.1),
    "a drag where the highlight is": lambda hand: hand.drag(PLACE, (300, 200)),
    "a switch": lambda hand: pick_row(hand, "fill", 0.95),
    "an undo with a redo": lambda hand: hand.press("Ctrl+Z", "Ctrl+Y"),
    "a key": lambda hand: hand.press("c"),
    "another screen": lambda hand: hand.press("Ctrl+2", "Ctrl+1"),
    "watching": lambda hand: hand.press("w", "escape"),
}


@pytest.mark.parametrize("name", first(4, ENDINGS))
def test_whatever_is_done_meanwhile_is_done_with_the_present_state(hand: Hand, name: str) -> None:
    pick_row(hand, "compare")
    ENDINGS[name](hand)
    assert shown(hand) == alone(hand.scene)


def test_handles_and_marks_of_the_present_light_are_not_there_meanwhile(hand: Hand) -> None:
    hand.turn_to("lights")
    board = hand.viewer.board
    assert board.content.handles
    hand.press("b")
    assert not board.content.handles
    assert not board.content.items


def test_where_colors_alone_differ_no_word_does(hand: Hand) -> None:
    hand.press("b")
    hand.viewer.on_release("b")
    dragged = hand.scene
    hand.press("c")
    words, entries = shown(hand)
    hand.press("b")
    assert shown(hand) == alone(dragged)
    assert shown(hand)[0] == words
    assert shown(hand)[1] != entries


def test_without_a_step_there_is_nothing_to_compare_with(tmp_path: Path) -> None:
    hand = hand_before(ball(), tmp_path)
    pick_row(hand, "compare")
    assert told(hand) == ("compare: there is no step to undo", True)
    hand.press("b")
    assert told(hand) == (
        "to compare, there must be a step to undo or a kept variant; edit something first",
        True,
    )


@pytest.mark.parametrize("screen", ["help", "entries", "variants"])
def test_over_a_screen_without_the_picture_the_picture_comes_and_then_the_screen_again(
    hand: Hand, screen: str
) -> None:
    toggle(hand.viewer, screen)
    for _ in range(2):
        hand.press("b")
        assert hand.viewer.page == "picture"
        assert shown(hand) == ball_alone()
        hand.viewer.on_release("b")
        assert hand.viewer.page == screen
        assert hand.message == f"shown: {NOW}"
    # The screen that the user turns to meanwhile stays, and a later release leads nowhere.
    hand.press("b", "f4" if screen != "entries" else "f1")
    page = hand.viewer.page
    hand.viewer.on_release("b")
    assert hand.viewer.page == page
    hand.press("escape")
    hand.viewer.on_release("b")
    assert hand.viewer.page == "picture"


def test_the_state_before_is_shown_in_the_present_view(hand: Hand) -> None:
    hand.drag((60, 60), (90, 60))
    view = hand.scene.view
    assert view != ball().view
    before = alone(ball().replace(view=view))
    hand.press("b")
    assert shown(hand) == before
    hand.viewer.on_release("b")
    hand.press("Ctrl+Z")
    assert shown(hand) == before
    hand.press("Left", "Ctrl+Y")
    assert hand.scene.view != view
    hand.press("Alt+Left", "Alt+Left")
    assert hand.scene.view == ball().view
    hand.press("Alt+Left")
    assert hand.message == "there is no view before this one"
    hand.press("Alt+Right")
    assert hand.scene.view == view
    assert "undo 1, to redo 0" in repr(hand.viewer.studio)


def test_a_variant_is_compared_until_comparing_ends_or_it_is_dropped(hand: Hand) -> None:
    variant = hand.scene
    hand.turn_to("variants")
    hand.pick("keep")
    hand.pick("compare")
    assert hand.message == "shown: variant A; now the same"
    hand.drag((60, 60), (90, 60))
    pick_row(hand, "fill", 0.95)
    now, before = shown(hand), hand.viewer.studio.history.to_undo[-1]
    hand.turn_to("variants")
    hand.pick("compare")
    assert hand.viewer.page == "picture"
    assert hand.message.startswith("shown: variant A; now: ")
    view = hand.scene.view
    assert shown(hand) == alone(variant.replace(view=view))
    pick_row(hand, "compare")
    assert shown(hand) == now
    hand.turn_to("variants")
    hand.pick("compare", 0.9)
    assert hand.message == f"compared from now on: {BEFORE}"
    hand.turn_to("picture")
    hand.press("b")
    assert shown(hand) == alone(before.replace(view=view))
    hand.viewer.on_release("b")
    # A variant that was dropped is compared no longer.
    hand.turn_to("variants")
    hand.pick("compare")
    hand.turn_to("variants")
    hand.pick("drop")
    hand.turn_to("picture")
    hand.press("b")
    assert hand.message.startswith(f"shown: {BEFORE}; now: ")


# Changes of another program.

BRIGHTER = "UPDATE lights SET intensity = 3 WHERE name = 'key'"


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "small.sqlite"
    write_store(path, small_scene())
    return path


def hand_at_file(path: Path) -> Hand:
    """A hand before the scene of a file, as `autocolor view` shows it."""
    place = place_of(Source(str(path)))
    return Hand(Viewer(History(read_scene(path), place), Ramtek9300(), folder=path.parent))


@pytest.fixture
def look(wait: Callable[[float], None]) -> Callable[[Hand], None]:
    """Lets the window come to its next look at the file."""

    def look(hand: Hand) -> None:
        wait(SECONDS_BETWEEN)
        hand.viewer.on_tick()

    return look


Look = Callable[[Hand], None]


def test_a_change_of_another_program_is_shown_as_one_step_to_undo(store: Path, look: Look) -> None:
    hand = hand_at_file(store)
    before = hand.scene
    look(hand)
    assert hand.message.startswith("F1")
    run(store, BRIGHTER, "UPDATE scene SET background = '#102030'")
    hand.viewer.on_tick()
    assert hand.scene is before
    look(hand)
    assert hand.scene.lights["key"].intensity == 3
    # The mesh did not change, and nor do the visible points.
    assert hand.scene.mesh is before.mesh
    assert hand.message == "small.sqlite was changed elsewhere; undo goes back"
    assert hand.shows(read_scene(store))
    assert "*" not in hand.viewer.caption
    hand.press("Ctrl+Z")
    look(hand)
    assert hand.scene is before


def test_a_change_of_another_program_lets_go_of_a_picked_handle(tmp_path: Path, look: Look) -> None:
    write_scene(tmp_path / "ball", ball())
    hand = hand_at_file(tmp_path / "ball")
    hand.click(*hand.handle("highlight of key"))
    look(hand)
    hand.viewer.tell("")
    assert hand.hint.endswith("pick its new place")
    file = tmp_path / "ball" / SCENE_FILE
    file.write_text(file.read_text().replace('"key"', '"main"'))
    look(hand)
    assert "changed elsewhere" in hand.message
    hand.click(*MIDDLE)
    assert hand.message.startswith("ball - paint, ")


def test_with_unsaved_edits_the_user_is_asked_and_may_save_beside(store: Path, look: Look) -> None:
    hand = hand_at_file(store)
    hand.viewer.studio.light("rim", intensity=0.25)
    mine = hand.scene
    run(store, BRIGHTER)
    look(hand)
    assert hand.scene is mine
    assert hand.message == "small.sqlite was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
    hand.press("Ctrl+r")
    assert hand.scene.lights["key"].intensity == 3
    assert hand.message == "read again; undo goes back"
    hand.press("Ctrl+Z")
    assert hand.scene is mine
    run(store, "UPDATE lights SET intensity = 4 WHERE name = 'key'")
    look(hand)
    hand.press("Ctrl+s")
    assert "small.sqlite was changed since, and is left alone" in hand.message
    assert read_scene(store).lights["key"].intensity == 4
    assert read_scene(store.parent / "small").lights["rim"].intensity == 0.25


def test_ctrl_s_saves_to_the_store_and_that_is_no_change_of_another(store: Path, look: Look) -> None:
    hand = hand_at_file(store)
    before, message = hand.scene, hand.message
    # A file that only looks changed is no step.
    run(store, "CREATE TABLE notes (text)")
    look(hand)
    assert (hand.scene, hand.message) == (before, message)
    assert not hand.viewer.studio.undo()
    hand.viewer.studio.light("rim", intensity=0.25)
    hand.press("Ctrl+s")
    assert hand.message.startswith("saved small.sqlite and small.npz")
    scene = hand.scene
    look(hand)
    assert hand.scene is scene
    assert hand.message.startswith("saved")
    run(store, BRIGHTER)
    look(hand)
    assert hand.scene.lights["key"].intensity == 3


def test_an_error_in_the_store_shows_a_message_once_and_the_scene_stays(store: Path, look: Look) -> None:
    hand = hand_at_file(store)
    before = hand.scene
    run(store, "UPDATE polygons SET node3 = 40 WHERE polygon = 2")
    look(hand)
    assert hand.scene is before
    assert told(hand)[1]
    assert hand.message.startswith("not shown: small.sqlite: polygons, row 2: ")
    hand.viewer.tell("")
    look(hand)
    assert hand.message == ""
    run(store, "UPDATE polygons SET node3 = 3 WHERE polygon = 2")
    look(hand)
    assert hand.scene.mesh.node_numbers[1].tolist() == [0, 1, 2, 2]


def test_a_scene_file_is_looked_at_as_well(tmp_path: Path, look: Look) -> None:
    folder = tmp_path / "small"
    write_scene(folder, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    hand = hand_at_file(folder)
    file = folder / "scene.toml"
    correct = file.read_text()
    file.write_text("[[mesh]\n")
    look(hand)
    assert hand.message.startswith("not shown: scene.toml")
    file.write_text(correct)
    look(hand)
    assert hand.message == "scene.toml holds this scene again"


def test_a_scene_in_no_file_has_nothing_to_read_again(tmp_path: Path, look: Look) -> None:
    hand = Hand(Viewer(small_scene(), Ramtek9300(), folder=tmp_path))
    look(hand)
    hand.press("Ctrl+r")
    assert told(hand) == ("the scene must be in a file to be read again, and it is in none; save it", True)


# An edit of a light that changes nothing that is seen.

EXPOSED = "exposed again: {} light looks the same"
ALONE = boxes().only_lights("key").replace(ambient=0)
LIT = boxes()
DIM, BEHIND = LIT.with_light("fill", intensity=0), LIT.with_light("fill", position=(0.5, 9, 0.5))
DARK, HELD = ALONE.only_lights(), ALONE.replace(exposure={"object": (0, 1000)})
UNSEEN = [
    (ALONE, ALONE.with_light("key", intensity=2), EXPOSED.format("more")),
    (DIM, DIM.with_light("fill", position=(0, -5, 0)), "no change: light fill has the intensity 0"),
    (
        LIT,
        LIT.with_new_light("far", position=(0.5, 9, 0.5)),
        "no change: light far shines on nothing that is seen",
    ),
    (BEHIND, BEHIND.with_light("fill", on=False), "no change: light fill shines on nothing that is seen"),
    (ALONE, ALONE.with_light("fill", intensity=2), "no change: light fill is off"),
    (
        DARK,
        DARK.replace(lights=[light.replace(intensity=3) for light in DARK.lights]),
        "no change: every edited light is off",
    ),
    (HELD, HELD.with_light("key", intensity=1.000001), "no change: no point that is seen gets another level"),
]


@pytest.mark.parametrize(("scene", "edited", "message"), UNSEEN)
def test_an_edit_of_a_light_that_changes_nothing_says_why(
    tmp_path: Path, scene: Scene, edited: Scene, message: str
) -> None:
    hand = hand_before(scene, tmp_path)
    hand.press("escape")
    hand.viewer.session.edit(edited)
    hand.viewer.on_tick()
    assert told(hand) == (message, message.startswith("no change"))
    hand.viewer.tell("")
    hand.viewer.on_tick()
    assert hand.message == ""


SEEN: dict[str, Callable[[Scene], Scene]] = {
    "a light moved": lambda scene: scene.with_light("key", position=(-2, -3, 4)),
    "a light removed": lambda scene: scene.without_light("fill"),
    "no light": lambda scene: scene.with_surface("low", blend=0.123),
    "a light and the view": lambda scene: scene.with_light("fill", intensity=2).with_saved_view(),
    "the name": lambda scene: scene.replace(name="other"),
    "a light renamed": lambda scene: scene.with_light("key", name="main"),
    "a light follows": lambda scene: scene.with_light_following("key", "eye"),
    "a light copied that is off": lambda scene: scene.with_copied_light("fill"),
    "a half-space carried": lambda scene: scene.with_light("fill", half_spaces={"cut": {"carried": True}}),
}


def test_other_edits_do_not_say_that_nothing_changed(tmp_path: Path) -> None:
    plane = HalfSpace("cut", point=(0, 0, -9), direction=(0, 0, 1))
    scene = ALONE.with_light("fill", half_spaces=[plane])
    viewer = hand_before(scene, tmp_path).viewer
    for edit in SEEN.values():
        viewer.session.edit(edit(scene))
        viewer.tell("edited")
        viewer.on_tick()
        assert viewer.message == "edited"
        undo(viewer.session)
        viewer.on_tick()


def test_the_whole_drag_is_compared_when_it_ends(tmp_path: Path) -> None:
    hand = hand_before(ALONE, tmp_path)
    hand.turn_to("lights")
    left, top, *_ = hand.widget("intensity").area
    hand.grab(left + 20, top + 8)
    for element in (40, 60):
        hand.move(left + element, top + 8)
        hand.viewer.on_tick(is_at_rest=False)
        assert not hand.message.startswith("no change")
    hand.drop()
    assert hand.message.endswith(EXPOSED.format("less"))
    hand.pick(" ", 0.1)
    hand.viewer.on_tick()
    assert hand.message.startswith("undone: key: intensity")
    assert hand.scene is ALONE


def test_the_offer_beside_the_message_holds_the_ranges_before_the_edit(tmp_path: Path) -> None:
    hand = hand_before(ALONE, tmp_path)
    before = shown_colors(hand.viewer.studio.display_image)
    hand.press("escape")
    hand.viewer.session.edit(ALONE.with_light("key", intensity=0.5))
    hand.viewer.on_tick()
    assert np.array_equal(shown_colors(hand.viewer.studio.display_image), before)
    hand.pick("hold all")
    assert shown_colors(hand.viewer.studio.display_image).sum() < 0.8 * before.sum()
    # The light of before is as bright as it was.
    hand.viewer.session.edit(hand.scene.with_light("key", intensity=1.0))
    assert np.array_equal(shown_colors(hand.viewer.studio.display_image), before)
