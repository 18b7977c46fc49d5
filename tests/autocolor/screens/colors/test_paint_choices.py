from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.files.state.recent import recent_colors
from autocolor.scene.paints.finishes import FINISHES, finished
from autocolor.scene.paints.swatches import COLUMNS, swatches
from autocolor.screens.colors.paint_choices import RECENT, SWATCH_LINES, SWATCHES
from autocolor.widgets.areas import Area
from tests.autocolor.screens.mixing import ZERO, bar_is_right, line_of, mixing, ramps_are_right
from tests.autocolor.screens.painting_hand import PaintingHand, boxes_scene


@pytest.fixture
def hand(tmp_path: Path) -> PaintingHand:
    return mixing(boxes_scene(), tmp_path)


def test_a_swatch_is_a_paint_for_the_chosen_color(hand: PaintingHand) -> None:
    hand.pick("swatches")
    hand.click(SWATCHES.left + 16 * 3 + 4, SWATCHES.top + SWATCH_LINES * 4 + 4)
    assert hand.paint.object_color == tuple(swatches()[4 * COLUMNS + 3])
    hand.pick("light source heading")
    hand.click(SWATCHES.left + 16 * 19 + 4, SWATCHES.top + 4)
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])
    # A click on the ramp chooses, too.
    hand.click(30, 220)
    hand.drag((SWATCHES.left + 4, SWATCHES.top + 4), (SWATCHES.left + 40, SWATCHES.top + 20))
    assert hand.paint.object_color == tuple(swatches()[COLUMNS + 2])
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])


def test_every_swatch_is_shown_in_its_color(hand: PaintingHand) -> None:
    hand.pick("swatches")
    for number, color in enumerate(swatches()):
        row, column = divmod(number, COLUMNS)
        left, top = SWATCHES.left + 16 * column, SWATCHES.top + SWATCH_LINES * row
        cell = Area(left, top, left + 14, top + SWATCH_LINES - 2)
        assert (hand.colors(cell) == color).all()
    assert ramps_are_right(hand)
    assert bar_is_right(hand)


@pytest.mark.parametrize("name", FINISHES)
def test_a_finish_keeps_the_object_color(hand: PaintingHand, name: str) -> None:
    before = hand.viewer.studio.scene.surface("box 0")
    hand.pick(name)
    after = hand.viewer.studio.scene.surface("box 0")
    assert after == before.replace(**finished(before, name))
    assert ramps_are_right(hand)
    assert bar_is_right(hand)


def test_what_was_mixed_is_among_the_recent_colors_when_the_mixing_ends(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "object, green"))
    hand.click(ZERO + 100, line_of(hand, "object, green"))
    assert recent_colors() == ()
    hand.leave()
    assert recent_colors() == ((176, 100, 32),)
    hand.turn_to("color mixing")
    # Another surface takes it over.
    hand.pick("surface")
    assert (
        hand.colors(Area(RECENT.left, RECENT.top, RECENT.left + 20, RECENT.top + 20)) == [176, 100, 32]
    ).all()
    hand.click(RECENT.left + 5, RECENT.top + 5)
    assert hand.paint.object_color == (176, 100, 32)


def test_a_color_that_was_undone_is_not_a_recent_one(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "object, green"))
    hand.pick(" ", 0.1)
    hand.leave()
    assert recent_colors() == ()


def test_choosing_another_surface_ends_the_mixing_of_one(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "light source, green"))
    hand.pick("surface")
    assert recent_colors() == ((255, 99, 240),)
    hand.leave()
    assert recent_colors() == ((255, 99, 240),)
