from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from autocolor import Scene, Studio
from autocolor.mapping.display_image import DisplayImage
from autocolor.screens.comparing import BEFORE, NOW
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before, seen_on
from tests.autocolor.screens.hand import Hand

PLACE = 335, 205
"""An element and line of the ball to which the highlight is put."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    """A hand that has dragged the highlight."""
    hand = hand_before(ball_scene(), tmp_path)
    hand.drag(hand.handle("highlight of key"), PLACE)
    return hand


def alone(scene: Scene) -> tuple[bytes, bytes]:
    """The words and the entries of a scene by itself."""
    display = Ramtek9300()
    Studio(scene, display)
    return display.words.tobytes(), display.entries.tobytes()


def shown(hand: Hand) -> tuple[bytes, bytes]:
    """The words and the entries of the picture, without a menu and a message over it."""
    hand.move(*MIDDLE)
    hand.viewer.tell("")
    return seen_on(hand)


def press(hand: Hand) -> None:
    hand.viewer.on_key("b", typed="b")


def release(hand: Hand) -> None:
    hand.viewer.on_release("b")


def switch(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("compare")


def test_the_state_before_is_shown_while_the_key_is_held(hand: Hand) -> None:
    now = shown(hand)
    for _ in range(2):
        press(hand)
        hand.viewer.on_key("b", typed="b", repeated=True)
        assert hand.viewer.message == f"shown: {BEFORE}"
        assert shown(hand) == alone(ball_scene())
        assert hand.viewer.studio.scene is not hand.viewer.studio.history.to_undo[-1]
        release(hand)
        assert hand.viewer.message == f"shown: {NOW}"
        assert shown(hand) == now
    assert now == alone(hand.viewer.studio.scene)


def test_each_pick_of_the_row_shows_the_other_state(hand: Hand) -> None:
    now = shown(hand)
    switch(hand)
    assert hand.viewer.message == f"shown: {BEFORE}"
    assert shown(hand) == alone(ball_scene())
    switch(hand)
    assert hand.viewer.message == f"shown: {NOW}"
    assert shown(hand) == now


def test_a_pick_in_the_picture_shows_the_present_state_and_does_nothing_else(hand: Hand) -> None:
    now, surface = shown(hand), hand.viewer.session.surface_name
    switch(hand)
    hand.click(320, 430)
    assert hand.viewer.message == f"shown: {NOW}"
    assert shown(hand) == now
    assert hand.viewer.session.surface_name == surface
    hand.click(320, 430)
    assert hand.viewer.session.surface_name != surface


def undo(hand: Hand) -> None:
    hand.open_menu()
    hand.pick(" ", 0.1)


def undo_and_redo(hand: Hand) -> None:
    undo(hand)
    hand.pick(" ", 0.9)


def switch_a_light(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("fill", 0.95)


def go_to_the_mapping_and_back(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("mapping")
    hand.pick("< picture")


def recolor(hand: Hand) -> None:
    hand.viewer.on_key("c", typed="c")


def watch(hand: Hand) -> None:
    hand.viewer.on_key("w", typed="w")
    hand.viewer.on_key("escape")


ENDINGS: dict[str, Callable[[Hand], None]] = {
    "a drag over the picture": lambda hand: hand.drag((60, 60), (90, 60)),
    "a drag where the highlight is": lambda hand: hand.drag(PLACE, (300, 200)),
    "a switch": switch_a_light,
    "an undo": undo,
    "an undo with a redo": undo_and_redo,
    "a key": recolor,
    "another screen": go_to_the_mapping_and_back,
    "watching": watch,
}


@pytest.mark.parametrize("name", ENDINGS)
def test_whatever_is_done_meanwhile_is_done_with_the_present_state(hand: Hand, name: str) -> None:
    switch(hand)
    ENDINGS[name](hand)
    assert not hand.viewer.session.comparing.is_on
    assert shown(hand) == alone(hand.viewer.studio.scene)


def test_handles_and_marks_of_the_present_light_are_not_there_meanwhile(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("lights")
    assert hand.viewer.board.screen.handles()
    press(hand)
    assert not hand.viewer.board.screen.handles()
    assert not hand.viewer.board.screen.items()


def test_where_colors_alone_differ_no_word_does(hand: Hand) -> None:
    hand.viewer.on_key("c", typed="c")
    press(hand)
    image = hand.viewer.session.comparing.image
    assert image is not None
    assert image.words is hand.viewer.studio.words
    assert (image.entries != hand.viewer.studio.entries).any()


def test_each_other_state_is_computed_once(hand: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[Scene] = []
    image_of = Studio.image_of

    def counted(studio: Studio, scene: Scene) -> DisplayImage:
        computed.append(scene)
        return image_of(studio, scene)

    monkeypatch.setattr(Studio, "image_of", counted)
    for _ in range(3):
        press(hand)
        release(hand)
    assert len(computed) == 1
    hand.viewer.on_key("c", typed="c")
    press(hand)
    assert computed == list(hand.viewer.studio.history.to_undo)


def test_without_a_step_there_is_nothing_to_compare_with(tmp_path: Path) -> None:
    hand = hand_before(ball_scene(), tmp_path)
    switch(hand)
    assert hand.viewer.message == "compare: there is no step to undo"
    press(hand)
    assert hand.viewer.message == (
        "to compare, there must be a step to undo or a kept variant; edit something first"
    )
    assert not hand.viewer.session.comparing.is_on


def test_over_a_screen_without_the_picture_the_picture_comes(hand: Hand) -> None:
    hand.viewer.on_key("f1")
    press(hand)
    assert hand.viewer.page == "picture"
    assert shown(hand) == alone(ball_scene())


def test_the_message_stands_as_long_as_the_other_state_does(hand: Hand) -> None:
    press(hand)
    session = hand.viewer.session
    session.news = session.news._replace(told_at=session.news.told_at - 60)
    assert session.has_news
    session.comparing.end()
    assert not session.has_news


# Kept variants.


def go_to_kept(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("kept")


@pytest.fixture
def kept(hand: Hand) -> Hand:
    """A hand that has kept a variant, and then made two steps."""
    go_to_kept(hand)
    hand.pick("keep")
    hand.pick("< picture")
    hand.drag((60, 60), (90, 60))
    switch_a_light(hand)
    return hand


def test_a_kept_variant_is_compared_until_it_is_not_any_more(kept: Hand) -> None:
    hand, now = kept, shown(kept)
    variant = hand.viewer.studio.variants["A"].scene
    go_to_kept(hand)
    hand.pick("compare")
    assert hand.viewer.page == "picture"
    assert hand.viewer.message == "shown: variant A"
    assert shown(hand) == alone(variant)
    switch(hand)
    assert shown(hand) == now
    press(hand)
    assert shown(hand) == alone(variant)
    release(hand)
    go_to_kept(hand)
    hand.pick("compare", 0.9)
    assert hand.viewer.message == f"compared from now on: {BEFORE}"
    hand.pick("< picture")
    press(hand)
    assert shown(hand) == alone(hand.viewer.studio.history.to_undo[-1])


def test_a_variant_that_was_dropped_is_compared_no_longer(kept: Hand) -> None:
    hand = kept
    go_to_kept(hand)
    hand.pick("compare")
    go_to_kept(hand)
    hand.pick("drop")
    hand.pick("< picture")
    press(hand)
    assert hand.viewer.message == f"shown: {BEFORE}"
