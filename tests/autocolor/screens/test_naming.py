"""New lights, cameras and variants are named at once; a second click in their list renames."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.autocolor.screens.boxes import hand_at, told
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    hand = hand_at(tmp_path, "lights")
    hand.viewer.session.has_keyboard = True
    return hand


def test_a_new_light_is_named_by_return_and_is_one_step(hand: Hand) -> None:
    before = hand.scene
    hand.pick("add", 0.75)
    assert hand.hint == "name of the light: key 2"
    # A name that is taken stays to be typed over.
    hand.type("key")
    hand.press("return")
    assert (told(hand)[1], hand.hint) == (True, "name of the light: key")
    hand.type("moon")
    hand.press("return")
    assert [light.name for light in hand.scene.lights] == ["key", "fill", "moon"]
    assert hand.viewer.session.light_name == "moon"
    assert hand.viewer.studio.history.to_undo == (before,)
    hand.pick("add", 0.75)
    hand.press("escape")
    assert [light.name for light in hand.scene.lights][3:] == ["moon 2"]


def test_a_second_click_on_the_name_of_a_light_renames_it(hand: Hand) -> None:
    row = next(row for row in hand.viewer.board.widgets() if row.key == "light list. 2 fill")
    for _ in range(2):
        hand.click(row.area.left + 30, row.area.top + 5)
    hand.type("sky")
    hand.press("return")
    assert [light.name for light in hand.scene.lights] == ["key", "sky"]
    assert hand.viewer.session.light_name == "sky"
    assert len(hand.viewer.studio.history.to_undo) == 1


def test_a_camera_is_named_and_renamed_from_its_list(hand: Hand) -> None:
    hand.go_to("picture")
    hand.open_menu()
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


def test_a_variant_is_named_when_it_is_kept_and_renamed_by_a_second_click(hand: Hand) -> None:
    hand.go_to("variants")
    for name in ("", "dusk"):
        hand.pick("keep")
        hand.type(name)
        hand.press("return")
        hand.viewer.studio.recolor("low", blend=0.25)
    scene = hand.viewer.studio.variants["A"].scene
    for _ in range(2):
        hand.pick("A", 0.5)
    assert hand.hint == "name of the variant: A"
    hand.type("dawn")
    hand.press("return")
    variants = hand.viewer.studio.variants
    assert list(variants) == ["dawn", "dusk"]
    assert variants["dawn"].scene is scene
    assert hand.hint.startswith("variant dawn")


def test_without_a_keyboard_nobody_is_asked(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = False
    hand.pick("add", 0.25)
    assert not hand.viewer.board.typing.is_on
