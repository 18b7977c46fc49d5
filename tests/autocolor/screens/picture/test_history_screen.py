from __future__ import annotations

from pathlib import Path

from autocolor.screens.picture.history_screen import BEGIN, LIST, MOST_ROWS, StepRow
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import CHARACTER, LIGHT_GRAY, WHITE
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


def rows_of(hand: Hand) -> dict[int, StepRow]:
    """The rows of the steps that are shown, by the numbers of the steps."""
    rows = [each for each in hand.viewer.board.widgets() if isinstance(each, StepRow)]
    return {int(row.label.split()[0]): row for row in rows}


def go_to(hand: Hand, step: int) -> None:
    hand.pick(rows_of(hand)[step].label)


def test_every_step_has_a_row_with_its_difference(tmp_path: Path) -> None:
    hand = hand_after(3, tmp_path)
    rows = rows_of(hand)
    assert [row.label[5:] for row in rows.values()] == [
        BEGIN,
        "fill: intensity 0.5 -> 0.51",
        "fill: intensity 0.51 -> 0.52",
        "fill: intensity 0.52 -> 0.53",
    ]
    assert [step for step, row in rows.items() if row.is_chosen] == [3]
    assert hint_of(hand, rows[1].label) == "Go to step 1: fill: intensity 0.5 -> 0.51"
    assert hint_of(hand, rows[3].label).startswith("The present state")


def test_a_click_goes_to_a_step_and_one_on_an_undone_step_goes_forward(tmp_path: Path) -> None:
    hand = hand_after(4, tmp_path)
    scenes = (*hand.viewer.studio.history.to_undo, hand.scene)
    go_to(hand, 1)
    assert hand.scene is scenes[1]
    assert hand.message == "3 steps undone: fill: intensity 0.51 -> 0.54"
    assert [row.ink for row in rows_of(hand).values()] == [WHITE, WHITE, LIGHT_GRAY, LIGHT_GRAY, LIGHT_GRAY]
    go_to(hand, 3)
    assert hand.scene is scenes[3]
    assert hand.message == "2 steps redone: fill: intensity 0.51 -> 0.53"
    for step in (3, 0):
        go_to(hand, step)
        assert hand.scene is scenes[step]
    assert hand.viewer.page == "history"
    hand.press("Ctrl+Y")
    assert [step for step, row in rows_of(hand).items() if row.is_chosen] == [1]
    # Another edit forgets the undone steps.
    hand.viewer.session.edit(hand.viewer.session.scene.replace(ambient=0.4))
    hand.viewer.tell("")
    assert list(rows_of(hand)) == [0, 1, 2]
    assert rows_of(hand)[2].label.endswith("ambient 0.1 -> 0.4")


def test_older_and_newer_steps_are_reached_by_rows_and_the_wheel(tmp_path: Path) -> None:
    # The state that was opened is a row, too.
    hand = hand_after(MOST_ROWS - 1, tmp_path)
    assert list(rows_of(hand)) == [*range(MOST_ROWS)]
    assert "older" not in hand.labels
    steps = 3 * MOST_ROWS
    hand = hand_after(steps, tmp_path)
    assert len(rows_of(hand)) == MOST_ROWS
    assert all(LIST.covers(row.area) for row in rows_of(hand).values())
    seen = set(rows_of(hand))
    for _ in range(5):
        hand.pick("older")
        seen |= set(rows_of(hand))
    assert seen == set(range(steps + 1))
    go_to(hand, 2)
    assert hand.scene.lights["fill"].intensity == 0.52
    # The list stays where the user clicked.
    assert rows_of(hand)[2].is_chosen
    hand.viewer.on_pointer(LIST.left, LIST.top, "wheel down", steps=8)
    assert min(rows_of(hand)) == MOST_ROWS - 2
    for _ in range(5):
        hand.pick("older", 0.9)
    assert max(rows_of(hand)) == steps


def test_a_row_is_as_wide_as_the_list(tmp_path: Path) -> None:
    hand = hand_after(2, tmp_path)
    session = hand.viewer.session
    session.same_step = False
    session.edit(session.scene.with_surface("low", diffuse=0.123456, specular=0.1, blend=0.3, exponent=9.5))
    hand.viewer.board.forget()
    last = rows_of(hand)[3].label
    assert last.endswith("surface low")
    assert len(last) * CHARACTER <= LIST.width
    assert hint_of(hand, last).endswith("low: diffuse, specular, exponent, blend")
