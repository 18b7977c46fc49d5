from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from autocolor import Scene
from autocolor.scene.columns.column import fields_of
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.screens.mapping.curve_panel import ACROSS, CURVE, PANEL, place_of
from autocolor.screens.mapping.curve_points import STRAIGHT
from autocolor.screens.mapping.mapping_screen import curve_of
from tests.autocolor.screens.boxes import boxes, hand_at, hint_of, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "mapping")


def scene_of(hand: Hand) -> Scene:
    return hand.viewer.studio.scene


def points_of(hand: Hand) -> CurvePoints:
    mapping = scene_of(hand).mapping
    assert not isinstance(mapping, str)
    return mapping


def test_every_parameter_of_the_mapping_has_a_row(hand: Hand) -> None:
    labels = {row.label for row in hand.viewer.board.screen.rows()}
    tables = {"mesh", "parts", "surfaces", "lights", "view", "scalar", "name", "background"}
    assert labels >= set(fields_of(Scene)) - tables


@pytest.mark.parametrize("label", ["scaling", "contrast", "dither", "division"])
def test_a_choice_goes_to_the_other_and_back(hand: Hand, label: str) -> None:
    before = vars(scene_of(hand))[label]
    hand.pick(label)
    assert vars(scene_of(hand))[label] != before
    assert words_are_those_of_the_scene(hand)
    hand.pick(label)
    assert vars(scene_of(hand))[label] == before


def test_ambient_light_is_set_along_its_bar_in_one_step(hand: Hand) -> None:
    before = scene_of(hand)
    hand.pull("ambient", 0.3, 0.6)
    assert scene_of(hand).ambient == hand.widget("ambient").value  # type: ignore[attr-defined]
    assert scene_of(hand).ambient != before.ambient
    undo(hand)
    assert scene_of(hand) is before


def test_every_curve_is_reached_by_clicks(hand: Hand) -> None:
    seen = []
    for _ in range(len(CURVES) + 1):
        hand.pick("mapping")
        mapping = scene_of(hand).mapping
        seen.append(mapping if isinstance(mapping, str) else "points")
    assert sorted(seen) == sorted([*CURVES, "points"])


def test_the_points_of_a_named_curve_lie_on_it(hand: Hand) -> None:
    hand.viewer.session.edit(scene_of(hand).replace(mapping="gamma"))
    for _ in range(3):
        hand.pick("mapping")
    for x, y in points_of(hand):
        # The last curve before the points is equalize, which depends on the picture.
        assert 0 <= x <= 1
        assert 0 <= y <= 1
    curve = curve_of(
        hand.viewer.studio.picture, "surface", "equalize", "auto", hand.viewer.session.surface_name
    )
    assert curve is not None
    xs, ys = zip(*points_of(hand), strict=True)
    assert ys == pytest.approx(np.interp(xs, ACROSS, curve[0]), abs=1e-4)


def test_a_dragged_point_changes_the_words_in_one_step(hand: Hand) -> None:
    hand.pick("straight")
    before, words = scene_of(hand), hand.viewer.studio.words
    hand.drag(place_of(0.5, 0.5), place_of(0.5, 0.6), place_of(0.4, 0.7))
    assert points_of(hand)[2] == pytest.approx((0.4, 0.7), abs=0.01)
    assert [*points_of(hand)[:2], *points_of(hand)[3:]] == [*STRAIGHT[:2], *STRAIGHT[3:]]
    assert told(hand) == ("intensity 0.40, level 0.70", False)
    assert (hand.viewer.studio.words != words).any()
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert scene_of(hand) is before


def test_a_point_is_picked_and_placed(hand: Hand) -> None:
    hand.pick("straight")
    hand.click(*place_of(0.75, 0.75))
    assert told(hand) == ("intensity 0.75, level 0.75: pick its new place", False)
    hand.click(*place_of(0.8, 0.95))
    assert points_of(hand)[3] == pytest.approx((0.8, 0.95), abs=0.01)


def test_a_curve_that_is_dragged_anywhere_stays_a_rising_one(hand: Hand) -> None:
    hand.pick("straight")
    for start in STRAIGHT:
        hand.drag(place_of(*start), (CURVE.right, CURVE.bottom), (0, 0), (CURVE.left, 479), (639, 0))
        xs, ys = zip(*points_of(hand), strict=True)
        assert all(a < b for a, b in pairwise(xs))
        assert all(a <= b for a, b in pairwise(ys))


def test_a_click_in_the_panel_adds_a_point(hand: Hand) -> None:
    hand.pick("straight")
    surface = hand.viewer.session.surface_name
    hand.click(*place_of(0.6, 0.7))
    assert len(points_of(hand)) == 6
    assert points_of(hand)[3] == pytest.approx((0.6, 0.7), abs=0.01)
    assert hand.viewer.session.surface_name == surface


@pytest.mark.parametrize("mapping", CURVES)
def test_a_click_in_the_panel_makes_points_of_a_named_curve(hand: Hand, mapping: str) -> None:
    hand.viewer.session.edit(scene_of(hand).replace(mapping=mapping))
    hand.click(*place_of(0.6, 0.97))
    assert len(points_of(hand)) == 6
    undo(hand)
    assert scene_of(hand).mapping == mapping


def test_the_point_that_was_touched_last_is_removed(hand: Hand) -> None:
    hand.pick("straight")
    assert hint_of(hand, "remove point") == "click at a point of the curve first"
    hand.drag(place_of(0.5, 0.5), place_of(0.5, 0.6))
    hand.pick("remove point")
    assert points_of(hand) == (*STRAIGHT[:2], *STRAIGHT[3:])
    before = scene_of(hand)
    hand.pick("remove point")
    assert scene_of(hand) is before


def test_ends_and_named_curves_have_nothing_to_remove(hand: Hand) -> None:
    hand.pick("remove point")
    assert told(hand) == (
        "remove point: a curve with a name has no points; click in it to make some",
        True,
    )
    hand.pick("straight")
    hand.drag(place_of(0, 0), place_of(0, 0.1))
    hand.pick("remove point")
    assert told(hand) == ("remove point: the ends of the curve stay; click at another point first", True)
    assert len(points_of(hand)) == 5


def test_the_panel_does_not_turn_the_object_behind_it(hand: Hand) -> None:
    before = scene_of(hand)
    hand.drag((PANEL.left + 2, PANEL.top + 2), (PANEL.left + 90, PANEL.top + 60))
    assert scene_of(hand) is before
    hand.drag((400, 100), (430, 90))
    assert scene_of(hand).view != before.view


def test_the_exposure_is_held_and_released_and_the_row_shows_which(hand: Hand) -> None:
    words = hand.viewer.studio.words
    assert hand.widget("exposure").present == "auto"  # type: ignore[attr-defined]
    hand.pick("exposure")
    assert hand.widget("exposure").present == "held"  # type: ignore[attr-defined]
    assert told(hand) == ("exposure held: less light is darker", False)
    assert np.array_equal(hand.viewer.studio.words, words)
    hand.pull("ambient", 0.2, 0.0)
    assert not (hand.viewer.studio.words > words).any()
    hand.pick("exposure")
    assert scene_of(hand).exposure == "auto"
    assert told(hand) == ("the exposure follows the picture", False)


def test_a_picture_without_light_has_no_exposure_to_hold(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(lights=(), ambient=0.2))
    hand.pick("exposure")
    message, is_warning = told(hand)
    assert is_warning
    assert message.startswith("to hold the exposure, a surface must have different intensities")
    assert scene_of(hand).exposure == "auto"
    for mapping in CURVES:
        hand.viewer.session.edit(scene_of(hand).replace(mapping=mapping))
        hand.click(*place_of(0.6, 0.9))


def test_a_surface_that_is_not_visible_has_no_curve_of_its_own(hand: Hand) -> None:
    assert curve_of(hand.viewer.studio.picture, "surface", "linear", "auto", "nowhere") is None


@pytest.mark.parametrize("mapping", CURVES)
@pytest.mark.parametrize("scaling", ["surface", "object"])
def test_the_levels_of_a_curve_rise_from_end_to_end(hand: Hand, mapping: str, scaling: str) -> None:
    curve = curve_of(hand.viewer.studio.picture, scaling, mapping, "auto", "low")
    assert curve is not None
    levels, shares = curve
    assert all(a <= b for a, b in pairwise(levels))
    assert levels[0] >= 0
    assert levels[-1] == pytest.approx(1)
    assert shares.max() == 1
