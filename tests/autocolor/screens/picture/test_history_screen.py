from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.screens.picture.history_screen import BEGIN, MOST_LETTERS, MOST_ROWS, StepRow
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import LIGHT_GRAY, WHITE
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import hint_of
from tests.autocolor.screens.hand import Hand
from tests.small import boxes


def hand_after(steps: int, folder: Path) -> Hand:
    """A hand before the history of a session with some steps."""
    hand = Hand(Viewer(boxes(), Ramtek9300(), folder))
    for number in range(1, steps + 1):
        hand.viewer.session.same_step = False
        hand.viewer.session.edit(
            hand.viewer.session.scene.with_light("fill", intensity=round(0.5 + number / 100, 2))
        )
    hand.open_menu()
    hand.pick(" ", 0.5)
    return hand


def rows_of(hand: Hand) -> list[StepRow]:
    return [each for each in hand.viewer.board.widgets() if isinstance(each, StepRow)]


def test_every_step_has_a_row_with_its_difference(tmp_path: Path) -> None:
    hand = hand_after(3, tmp_path)
    assert [row.shown[5:] for row in rows_of(hand)] == [
        BEGIN,
        "fill: intensity 0.5 -> 0.51",
        "fill: intensity 0.51 -> 0.52",
        "fill: intensity 0.52 -> 0.53",
    ]
    assert [row.is_chosen for row in rows_of(hand)] == [False, False, False, True]
    assert hint_of(hand, "step 1") == "Go to step 1: fill: intensity 0.5 -> 0.51"
    assert hint_of(hand, "step 3").startswith("The present state")


def test_a_click_goes_to_a_step_and_one_on_an_undone_step_goes_forward(tmp_path: Path) -> None:
    hand = hand_after(4, tmp_path)
    scenes = (*hand.viewer.studio.history.to_undo, hand.scene)
    hand.pick("step 1")
    assert hand.scene is scenes[1]
    assert hand.message == "3 steps undone: fill: intensity 0.51 -> 0.54"
    assert [row.ink for row in rows_of(hand)] == [WHITE, WHITE, LIGHT_GRAY, LIGHT_GRAY, LIGHT_GRAY]
    hand.pick("step 3")
    assert hand.scene is scenes[3]
    assert hand.message == "2 steps redone: fill: intensity 0.51 -> 0.53"
    hand.pick("step 3")
    assert hand.scene is scenes[3]
    hand.pick("step 0")
    assert hand.scene is scenes[0]
    assert hand.viewer.page == "history"
    hand.press("Ctrl+Y")
    assert [row.is_chosen for row in rows_of(hand)] == [False, True, False, False, False]
    # Another edit forgets the undone steps.
    hand.viewer.session.edit(hand.viewer.session.scene.replace(ambient=0.4))
    hand.viewer.tell("")
    assert [row.label for row in rows_of(hand)] == ["step 0", "step 1", "step 2"]
    assert rows_of(hand)[-1].shown.endswith("ambient 0.1 -> 0.4")


@pytest.mark.parametrize("steps", [MOST_ROWS - 1, MOST_ROWS, 3 * MOST_ROWS])
def test_of_many_steps_those_around_the_present_one_are_shown(steps: int, tmp_path: Path) -> None:
    hand = hand_after(steps, tmp_path)
    labels = [row.label for row in rows_of(hand)]
    assert len(labels) == min(MOST_ROWS, steps + 1)
    assert labels[-1] == f"step {steps}"
    has_more = steps + 1 > MOST_ROWS
    assert any(each.label == "older" for each in hand.viewer.board.widgets()) == has_more


def test_older_and_newer_steps_are_reached(tmp_path: Path) -> None:
    steps = 3 * MOST_ROWS
    hand = hand_after(steps, tmp_path)
    seen = {row.label for row in rows_of(hand)}
    for _ in range(5):
        hand.pick("older")
        seen |= {row.label for row in rows_of(hand)}
    assert seen == {f"step {number}" for number in range(steps + 1)}
    hand.pick("step 2")
    assert hand.scene.lights["fill"].intensity == 0.52
    # The list stays where the user clicked.
    assert rows_of(hand)[2].is_chosen
    for _ in range(5):
        hand.pick("older", 0.9)
    assert rows_of(hand)[-1].label == f"step {steps}"


def test_a_row_is_as_wide_as_the_list(tmp_path: Path) -> None:
    hand = hand_after(2, tmp_path)
    session = hand.viewer.session
    session.same_step = False
    session.edit(session.scene.with_surface("low", diffuse=0.123456, specular=0.1, blend=0.3, exponent=9.5))
    hand.viewer.board.forget()
    last = rows_of(hand)[-1]
    assert last.shown.endswith("surface low")
    assert len(last.shown) <= MOST_LETTERS + 5
    assert hint_of(hand, last.label).endswith("low: diffuse, specular, exponent, blend")
