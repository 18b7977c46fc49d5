from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.screens.mapping.held_ranges import held_name
from tests.autocolor.screens.boxes import boxes, hand_at, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand

HELD = (("low", (0.1, 0.5)), ("object", (0.0, 2.0)))


def labels_of(hand: Hand) -> list[str]:
    return [row.label for row in hand.viewer.board.screen.rows()]


def limits_of(hand: Hand, name: str) -> tuple[float, float]:
    return dict(hand.viewer.studio.scene.exposure)[name]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("surface", "name"), [("low", "low"), ("high", "object"), ("object", "object"), ("", "object")]
)
def test_a_surface_has_its_own_range_or_that_of_the_object(surface: str, name: str) -> None:
    assert held_name(HELD, surface) == name


def test_what_is_not_held_has_no_name() -> None:
    assert held_name("auto", "low") == held_name(HELD[:1], "high") == ""


def test_nothing_is_held_of_an_exposure_that_follows_the_picture(tmp_path: Path) -> None:
    assert "maximum" not in labels_of(hand_at(tmp_path, "mapping"))


def test_a_drag_sets_one_end_of_what_is_held_as_one_step(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(exposure=HELD))
    before, words = hand.viewer.studio.scene, hand.viewer.studio.words
    hand.pull("maximum", 0.2, 0.4)
    low, high = limits_of(hand, "low")
    assert low == 0.1
    assert high != 0.5
    assert high == hand.widget("maximum").value  # type: ignore[attr-defined]
    assert limits_of(hand, "object") == (0, 2)
    assert (hand.viewer.studio.words != words).any()
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_a_minimum_is_below_its_maximum_however_far_it_is_dragged(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(exposure=HELD))
    hand.pull("minimum", 0.0, 1.0)
    low, high = limits_of(hand, "low")
    assert 0.4 < low < high == 0.5
    hand.pull("maximum", 0.9, 0.0)
    low, high = limits_of(hand, "low")
    assert low < high < 0.6


def test_all_surfaces_without_a_range_of_their_own_share_one(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(exposure=HELD))
    hand.viewer.session.choose_surface("high")
    hand.pull("minimum", 0.1, 0.2)
    assert limits_of(hand, "object")[0] > 0
    assert limits_of(hand, "low") == (0.1, 0.5)


def test_a_dark_scene_can_hold_a_range_too(tmp_path: Path) -> None:
    dark = boxes().replace(exposure=HELD, ambient=0.0, lights=())
    hand = hand_at(tmp_path, "mapping", dark)
    hand.pull("maximum", 0.2, 0.4)
    assert limits_of(hand, "low")[1] != 0.5
