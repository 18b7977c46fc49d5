from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor.explanation.text import rows_of_text
from autocolor.screens.picture.explain_screen import MAGNIFIER, SIDE, items_of_row, magnifier_items
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before
from tests.autocolor.screens.hand import Hand

ELEMENT, LINE = MIDDLE


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_before(ball_scene(), tmp_path)


def click_with_shift(hand: Hand, element: int, line: int) -> None:
    for action in ("move", "press", "release"):
        hand.viewer.on_pointer(element, line, action, 1, shift=True)


def shown(hand: Hand) -> object:
    return hand.viewer.board.content.items


def expected(hand: Hand, line: int, element: int) -> object:
    studio = hand.viewer.studio
    rows = rows_of_text(studio.explain(line, element))
    items = [item for number, row in enumerate(rows) for item in items_of_row(row, number)]
    return items + magnifier_items(studio.words, line, element)


def test_shift_and_a_click_explain_a_pixel_and_pick_no_highlight_there(hand: Hand) -> None:
    before, (element, line) = hand.scene, hand.handle("highlight of key")
    click_with_shift(hand, element, line)
    assert hand.viewer.page == "explain"
    assert hand.viewer.board.held is None
    assert shown(hand) == expected(hand, line, element)
    hand.press("escape")
    assert hand.viewer.page == "picture"
    assert hand.scene is before


def test_the_unit_explains_by_a_row_of_the_menu_and_a_click(hand: Hand) -> None:
    element, line = hand.handle("highlight of key")
    hand.open_menu()
    hand.pick("explain a pixel")
    assert hand.message == "click the pixel to explain"
    hand.click(element, line)
    assert (hand.viewer.page, hand.viewer.session.pixel) == ("explain", (line, element))
    # The next click in the picture is a plain one, and one after the row was taken back.
    hand.press("escape")
    hand.click(ELEMENT + 40, LINE + 40)
    assert hand.viewer.page == "picture"
    hand.open_menu()
    hand.pick("explain a pixel")
    hand.press("escape", "escape")
    hand.click(ELEMENT, LINE)
    assert hand.viewer.page == "picture"


def test_arrows_and_a_click_in_the_magnifier_explain_a_neighbor(hand: Hand) -> None:
    session = hand.viewer.session
    click_with_shift(hand, ELEMENT, LINE)
    for key, pixel in (
        ("right", (LINE, ELEMENT + 1)),
        ("down", (LINE + 1, ELEMENT + 1)),
        ("left", (LINE + 1, ELEMENT)),
        ("up", (LINE, ELEMENT)),
    ):
        hand.press(key)
        assert session.pixel == pixel
        assert shown(hand) == expected(hand, *pixel)
    hand.click(MAGNIFIER.right, MAGNIFIER.top)
    assert session.pixel == (LINE - 2, ELEMENT + 4)
    hand.click(20, 300)
    assert session.pixel == (LINE - 2, ELEMENT + 4)
    # An edit is explained at once.
    before = shown(hand)
    hand.press("2")
    assert hand.viewer.page == "explain"
    assert shown(hand) == expected(hand, LINE - 2, ELEMENT + 4) != before


def test_a_neighbor_stays_in_the_picture(hand: Hand) -> None:
    click_with_shift(hand, 0, 0)
    hand.press("up", "left")
    # The pixels beside the picture are those at its edge.
    hand.click(MAGNIFIER.left + SIDE // 2, MAGNIFIER.top + SIDE // 2)
    assert hand.viewer.session.pixel == (0, 0)


def test_the_magnifier_shows_the_words_around_the_pixel(hand: Hand) -> None:
    click_with_shift(hand, ELEMENT, LINE)
    top, left = MAGNIFIER.top + SIDE // 2, MAGNIFIER.left + SIDE // 2
    shown = hand.display.words[top : MAGNIFIER.bottom : SIDE, left : MAGNIFIER.right : SIDE]
    around = hand.viewer.studio.words[LINE - 2 : LINE + 3, ELEMENT - 4 : ELEMENT + 5]
    assert np.array_equal(shown, around)
