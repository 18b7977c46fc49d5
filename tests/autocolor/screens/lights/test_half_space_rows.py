from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import HalfSpace
from autocolor.scene.lights.carried import set_down
from tests.autocolor.screens.boxes import boxes, hand_at, hint_of, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand

LEFT = HalfSpace("left", (0.3, 0.0, 0.0), (1.0, 0.0, 0.2))

TOP = HalfSpace("top", (0.0, 0.0, 0.8), (0.0, 0.0, -1.0), edge_width=0.2)

BOX = 0.95
"""Where the box of a row is, as a share of its width."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights", boxes().with_light("key", half_spaces=(LEFT, TOP)))


def plane(hand: Hand, name: str = "left") -> HalfSpace:
    (found,) = (each for each in hand.viewer.studio.scene.light("key").half_spaces if each.name == name)
    return found


def test_each_half_space_has_a_switch_of_its_own(hand: Hand) -> None:
    hand.pick("left", BOX)
    assert plane(hand) == LEFT.replace(on=False)
    assert plane(hand, "top") == TOP
    assert words_are_those_of_the_scene(hand)
    hand.pick("left", BOX)
    assert plane(hand) == LEFT


def test_the_width_of_the_edge_is_set_along_a_bar(hand: Hand) -> None:
    before = hand.viewer.studio.scene
    hand.pull("left width", 0.0, 0.3)
    assert 0 < plane(hand).edge_width < 1
    assert plane(hand) == LEFT.replace(edge_width=plane(hand).edge_width)
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_a_half_space_that_is_carried_from_now_on_stays_where_it_is(hand: Hand) -> None:
    words = hand.viewer.studio.words.copy()
    hand.pick("left carried", BOX)
    assert plane(hand).carried
    placed = set_down(plane(hand), hand.viewer.studio.scene.light("key"))
    assert placed.point == pytest.approx(LEFT.point)
    assert placed.direction == pytest.approx(LEFT.direction)
    assert (hand.viewer.studio.words != words).mean() < 1e-3
    hand.pick("left carried", BOX)
    assert not plane(hand).carried
    assert plane(hand).point == pytest.approx(LEFT.point)


def test_turn_lights_the_other_side(hand: Hand) -> None:
    hand.pick("turn")
    assert plane(hand) == LEFT.replace(direction=(-1.0, 0.0, -0.2))
    assert words_are_those_of_the_scene(hand)


def test_remove_takes_one_away_and_says_so(hand: Hand) -> None:
    before = hand.viewer.studio.scene
    hand.pick("turn", 0.75)
    assert hand.viewer.studio.scene.light("key").half_spaces == (TOP,)
    assert told(hand) == ("half-space left removed; undo brings it back", False)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_the_verbs_of_two_half_spaces_are_told_apart(hand: Hand) -> None:
    hand.widget("turn")
    keys = [each.key for each in hand.viewer.board.widgets()]
    assert {"turn left", "turn top"} <= set(keys)
    assert len(set(keys)) == len(keys)


def test_the_message_line_says_what_a_row_does(hand: Hand) -> None:
    assert hint_of(hand, "left carried") == "Whether it moves and turns with the light, as barn doors do."
    assert hint_of(hand, "turn") == "The other side of left is lit; or take it away."


def test_the_edge_of_a_half_space_is_dragged_in_the_picture(hand: Hand) -> None:
    element, line = hand.handle("end of the half-space left of key")
    seen = hand.viewer.studio.seen_at(line, element + 30)
    assert seen is not None
    hand.drag((element, line), (element + 15, line), (element + 30, line))
    moved = plane(hand)
    assert moved.direction == LEFT.direction
    away = [a - b for a, b in zip(seen.point, moved.point, strict=True)]
    assert sum(a * b for a, b in zip(away, moved.direction, strict=True)) == pytest.approx(0, abs=1e-6)
    assert told(hand)[0].startswith("left: x ")
