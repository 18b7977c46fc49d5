from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import CookTorrance, Surface
from autocolor.scene.columns import fields_of
from autocolor.scene.reflection_models import MODELS, START_CURVE, SpecularGrowth
from tests.autocolor.screens.boxes import hand_at, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand

BOX = 0.95


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "reflectance")


def surface_of(hand: Hand, name: str = "low") -> Surface:
    return hand.scene.surfaces[name]


@pytest.mark.parametrize("column", ["diffuse", "specular"])
def test_a_drag_along_a_number_sets_it_alone_and_is_one_step(hand: Hand, column: str) -> None:
    before = hand.scene
    hand.pull(column, 0.2, 0.4)
    value = vars(hand.widget(column))["value"]
    assert hand.scene.equals(before.with_surface("low", **{column: value}))
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.scene is before


def test_every_model_is_reached_and_every_parameter_of_it_can_be_set(hand: Hand) -> None:
    seen = []
    for _ in MODELS:
        hand.pick("model")
        model = surface_of(hand).reflectance.model
        seen.append(type(model))
        for name in fields_of(type(model)).keys() - {"growth"}:
            hand.pull(name.replace("_", " "), 0.3, 0.5)
            assert vars(surface_of(hand).reflectance.model)[name] != vars(model)[name]
    assert seen[-1:] + seen[:-1] == list(MODELS.values())
    assert CookTorrance in seen


def test_s_grows_in_one_of_three_ways_without_a_word_typed(hand: Hand) -> None:
    start = hand.scene
    # Each way takes the place of the one before.
    for label, growth in (
        ("base reflectance", SpecularGrowth(base_reflectance=0.04)),
        ("refractive index", SpecularGrowth(refractive_index=1.5)),
        ("fresnel curve", SpecularGrowth(fresnel_curve=START_CURVE)),
    ):
        hand.pick(label, BOX)
        assert vars(surface_of(hand).reflectance.model)["growth"] == growth
    hand.pull("at 70 degrees", 0.3, 0.5)
    assert vars(surface_of(hand).reflectance.model)["growth"].fresnel_curve != START_CURVE
    assert words_are_those_of_the_scene(hand)
    hand.pick("fresnel curve", BOX)
    assert hand.scene.surfaces == start.surfaces


def test_the_number_of_levels_is_switched_and_set_in_whole_numbers(hand: Hand) -> None:
    hand.pick("levels", BOX)
    first = surface_of(hand).levels
    assert isinstance(first, int)
    hand.pull("levels", 0.2, 0.25)
    levels = surface_of(hand).levels
    assert isinstance(levels, int)
    assert levels != first
    assert hand.viewer.studio.level_ranges["low"].levels == levels
    hand.pick("levels", BOX)
    assert surface_of(hand).levels is None
    hand.pick("two sided", BOX)
    assert not surface_of(hand).two_sided
