from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from autocolor import Scene, UsageError, View
from autocolor.scene.orbit import moved, panned, seen_from, sides_of, turned
from autocolor.scene.stage import shape_of
from autocolor.screens.picture import picture_edits as edits
from autocolor.screens.picture.picture_edits import CLOSER, TURN
from autocolor.screens.picture.picture_screen import PAN
from autocolor.screens.steps import undo
from autocolor.widgets.widget import Choice, Entry, Switch
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    hand = hand_before(ball_scene(), tmp_path)
    hand.open_menu()
    return hand


ROWS: dict[str, tuple[float, Callable[[Scene], View]]] = {
    "turn": (0.9, lambda scene: turned(scene, TURN, 0)),
    "rise": (0.1, lambda scene: turned(scene, 0, -TURN)),
    "closer": (0.9, lambda scene: moved(scene, CLOSER)),
    "move": (0.9, lambda scene: panned(scene, PAN, 0, 480, 640)),
    "lift": (0.9, lambda scene: panned(scene, 0, -PAN, 480, 640)),
}


def present(hand: Hand, label: str) -> str:
    """The name that a row shows."""
    row = hand.widget(label)
    assert isinstance(row, Choice)
    return row.present


def test_every_side_is_in_the_list_of_the_row_of_the_view(hand: Hand) -> None:
    start = hand.scene
    for side in sides_of(start):
        hand.open_menu()
        hand.choose("view", side)
        assert hand.scene.view == seen_from(start, side)
        assert present(hand, "view") == side
    hand.pick("turn", 0.9)
    assert present(hand, "view") == ""


@pytest.mark.parametrize("label", ROWS)
def test_a_row_changes_the_view_which_can_be_gone_back_from(hand: Hand, label: str) -> None:
    share, view_of = ROWS[label]
    before = hand.scene
    hand.pick(label, share)
    assert hand.scene.view == view_of(before) != before.view
    hand.press("Alt+Left")
    assert hand.scene.equals(before)


def test_at_the_stage_a_turn_ends_and_the_message_says_why(hand: Hand) -> None:
    session = hand.viewer.session
    session.edit(session.scene.replace(stage="floor").with_view(eye=(0.0, -8.0, 4.0)))
    floor, told = shape_of(session.scene.mesh, session.scene.parts).floor, []
    for up in (-80, -5, 5):
        session.tell("")
        edits.turn(session, 3, up)
        assert session.scene.view.eye[2] > floor
        told.append(session.message)
    assert told == ["", "the eye stays above the stage", ""]
    edits.as_opened(session)
    assert session.scene.view == session.studio.history.saved.scene.view


def test_a_light_is_switched_by_its_box_and_chosen_beside_it(hand: Hand) -> None:
    before = hand.scene

    def chosen() -> list[str]:
        rows = hand.viewer.board.layout.rows
        return [row.label for row in rows if isinstance(row, Switch) and row.is_chosen]

    assert chosen() == ["key"]
    hand.pick("fill", 0.2)
    assert chosen() == ["fill"]
    assert hand.scene is before
    hand.pick("key", 0.95)
    assert [light.on for light in hand.scene.lights] == [False, True]
    assert chosen() == ["fill"]
    for share, on in ((0.9, [True, True]), (0.2, [False, True]), (0.2, [True, True])):
        hand.pick("alone", share)
        assert [light.on for light in hand.scene.lights] == on
    hand.pick("what was sent")
    assert hand.viewer.page == "sent"


def test_a_view_is_saved_taken_and_removed_as_a_camera(hand: Hand) -> None:
    session, start = hand.viewer.session, hand.scene

    hand.pick("save view")
    assert session.message == "view saved: view 1"
    assert present(hand, "camera") == "view 1"
    hand.pick("save view", 0.2)
    assert session.message == "this view is saved already: view 1"
    hand.pick("turn", 0.9)
    hand.pick("save view", 0.2)
    hand.pick("turn", 0.9)
    assert present(hand, "camera") == ""
    turned = hand.scene
    hand.pick("save view", 0.9)
    assert session.message == "only the camera that is shown can be removed; take one from the row camera"
    hand.pick("camera", 0.9)
    assert session.message == "camera: view 1"
    assert present(hand, "camera") == "view 1"
    assert hand.scene.view == start.view
    hand.press("Alt+Left")
    assert hand.scene.equals(turned)
    hand.pick("camera", 0.02)
    assert present(hand, "camera") == "view 2"
    hand.pick("save view", 0.9)
    assert session.message == "camera view 2 removed; undo brings it back"
    assert [view.name for view in hand.scene.views] == ["view 1"]


def test_a_camera_is_named_when_it_is_saved_and_renamed_from_its_list(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    hand.pick("save view", 0.25)
    hand.type("hero")
    hand.press("return")
    assert [view.name for view in hand.scene.views] == ["hero"]
    for number in range(3):
        hand.viewer.session.edit(hand.scene.with_saved_view(f"view {number}"))
    hand.open_menu()
    hand.choose("camera", "hero")
    hand.type("side")
    hand.press("return")
    assert [view.name for view in hand.scene.views] == ["side", "view 0", "view 1", "view 2"]
    assert hand.message == "camera side"


def test_object_surface_and_part_fill_the_picture(hand: Hand) -> None:
    start = hand.scene
    hand.open_menu()
    hand.pick("as opened", 0.9)
    assert hand.message == "no part was clicked yet; click a part in the picture first"
    assert hand.scene is start
    hand.click(*MIDDLE)
    views = []
    for label, share in (("rescale", 0.2), ("rescale", 0.9), ("as opened", 0.9)):
        hand.open_menu()
        hand.pick(label, share)
        views.append(hand.scene.view)
        undo(hand.viewer.session)
    # The ball is a surface of its own, and nearer than with the floor.
    assert views[1] == views[2] != views[0]
    middle, (x, y, z) = start.view.eye, views[2].eye
    assert (x, z) == pytest.approx((0, 0), abs=1e-6)
    assert middle[1] < y < -1


def test_a_stage_is_a_row_and_its_backdrop_has_two_colors(hand: Hand) -> None:
    start = hand.scene
    assert "backdrop" not in hand.labels
    hand.pick("stage", 0.9)
    assert hand.scene.equals(start.replace(stage="floor"))
    hand.open_menu()
    row = hand.widget("  bottom")
    assert isinstance(row, Entry)
    row.take("#123456")
    assert hand.scene.backdrop_colors == (start.replace(stage="floor").backdrop_colors[0], (18, 52, 86))
    hand.viewer.session.choose_surface("stage")
    with pytest.raises(UsageError, match="the view fills with the object, not with its stage"):
        edits.rescale(hand.viewer.session, "stage")


def test_highlights_are_marked_while_the_pointer_rests_on_the_object(tmp_path: Path) -> None:
    hand = hand_before(ball_scene(), tmp_path)
    hand.viewer.tell("")
    bare = hand.viewer.board.page().items
    hand.move(*MIDDLE)
    hand.viewer.on_tick()
    assert len(hand.viewer.board.page().items) > len(bare)
    assert hand.hint == "ball, paint: drag turns, click chooses, Shift explains"
    received = hand.display.words_received
    hand.viewer.on_tick()
    assert hand.display.words_received == received
    hand.move(20, 20)
    hand.viewer.on_tick()
    hand.viewer.tell("")
    assert list(hand.viewer.board.page().items) == []
