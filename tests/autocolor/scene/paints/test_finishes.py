from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Surface, UsageError, image, render, scene_of
from autocolor.mapping.color_blending import entries_of
from autocolor.scene.paints.finishes import FINISHES, finished, mixed
from tests.autocolor.meshes import STRETCHED, sphere
from tests.autocolor.strategies import colors, surfaces

names = st.sampled_from(list(FINISHES))


@given(surfaces("body"), names, names)
def test_a_finish_keeps_the_color_and_replaces_any_other_finish(
    surface: Surface, first: str, last: str
) -> None:
    once = surface.replace(**finished(surface, last))
    other = surface.replace(**finished(surface, first))
    assert other.replace(**finished(other, last)) == once
    assert once.paint.object_color == surface.paint.object_color
    assert (once.name, once.levels, once.two_sided) == (surface.name, surface.levels, surface.two_sided)


def test_the_finishes_of_a_menu_are_these() -> None:
    assert list(FINISHES) == ["plastic", "paint", "metallic", "metal", "rubber", "glass"]
    with pytest.raises(UsageError, match=r"^there is no finish 'metl'; did you mean 'metal'\?$"):
        finished(Surface("body"), "metl")


@given(colors, names)
def test_more_light_is_never_clearly_darker(color: tuple[int, int, int], name: str) -> None:
    surface = Surface("body").replace(object_color=color)
    paint = surface.replace(**finished(surface, name)).paint
    brightness = entries_of(paint, 128).astype(int).sum(axis=1)
    assert (np.maximum.accumulate(brightness) - brightness).max() <= 45


def test_each_finish_looks_different() -> None:
    scene = scene_of(
        sphere(24, 16), surfaces=[Surface("sphere").replace(object_color="#b01020")], **STRETCHED
    )
    images = {}
    for name in FINISHES:
        finish = scene.with_surface("sphere", **finished(scene.surface("sphere"), name))
        images[name] = image(finish, render(finish, 60, 80)).astype(float)
    for one, other in itertools.combinations(FINISHES, 2):
        assert np.abs(images[one] - images[other]).mean() > 1, (one, other)
    means = {name: found.mean() for name, found in images.items()}
    assert min(means, key=lambda name: means[name]) == "glass"
    # Glass and paint have a white highlight; that of metal has its color, and rubber has none.
    whitest = {name: found.min(axis=2).max() for name, found in images.items()}
    assert whitest["glass"] > 240
    assert whitest["paint"] > 240
    assert whitest["rubber"] < 100 < whitest["metal"] < 200


@given(colors, colors, st.floats(0, 1))
def test_a_mixed_color_lies_between_both(
    one: tuple[int, int, int], other: tuple[int, int, int], share: float
) -> None:
    for a, b, c in zip(one, other, mixed(one, other, share), strict=True):
        assert min(a, b) <= c <= max(a, b)
    assert mixed(one, other, 0) == one
    assert mixed(one, other, 1) == other
