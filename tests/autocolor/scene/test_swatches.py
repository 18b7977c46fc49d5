from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Surface, UsageError, image, render, scene_of
from autocolor.arrays import Bytes
from autocolor.scene.swatches import (
    CAR_PAINTS,
    COLUMNS,
    FINISHES,
    FIRST_HUE,
    GRAYS,
    HUES,
    ROWS,
    SHADES,
    finished,
    mixed,
    swatches,
)
from autocolor.testing import colors, surfaces
from tests.small import STRETCHED, sphere


def field() -> Bytes:
    found: Bytes = swatches().reshape(ROWS, COLUMNS, 3)
    return found


def test_grays_go_from_white_to_black_and_car_paints_are_as_they_are() -> None:
    grays = field()[:, 0]
    assert (np.ptp(grays.astype(int), axis=1) == 0).all()
    assert (np.diff(grays[:, 0].astype(int)) < 0).all()
    assert grays[0].tolist() == [255] * 3
    assert grays[-1].tolist() == [0] * 3
    assert [tuple(color) for color in field()[:, -1].tolist()] == list(CAR_PAINTS)
    assert len(GRAYS) == len(CAR_PAINTS) == ROWS


def test_rows_have_the_lightness_and_columns_the_hue_that_oklab_says() -> None:
    # Ottosson's definition in its own direction, from sRGB to Oklab.
    encoded = field()[:, 1:-1] / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    cones = np.cbrt(
        linear
        @ np.array(
            [
                [0.4122214708, 0.2119034982, 0.0883024619],
                [0.5363325363, 0.6806995451, 0.2817188376],
                [0.0514459929, 0.1073969566, 0.6299787005],
            ]
        )
    )
    lightness, a, b = np.moveaxis(
        cones
        @ np.array(
            [
                [0.2104542553, 1.9779984951, 0.0259040371],
                [0.7936177850, -2.4285922050, 0.7827717662],
                [-0.0040720468, 0.4505937099, -0.8086757660],
            ]
        ),
        2,
        0,
    )
    wanted = np.array([shade.lightness for shade in SHADES])
    assert np.abs(lightness - wanted[:, None]).max() < 0.004
    turn = np.degrees(np.arctan2(b, a)) - FIRST_HUE - np.arange(HUES) * 360 / HUES
    assert np.abs((turn + 180) % 360 - 180).max() < 3
    for row, shade in enumerate(SHADES):
        assert np.hypot(a, b)[row].max() < shade.most + 0.004


names = st.sampled_from(list(FINISHES))


@given(surfaces("body"), names, names)
def test_a_finish_keeps_the_color_and_replaces_any_other_finish(
    surface: Surface, first: str, last: str
) -> None:
    once = surface.replace(**finished(surface, last))
    other = surface.replace(**finished(surface, first))
    assert other.replace(**finished(other, last)) == once
    assert once.paint.object_color == surface.paint.color
    assert (once.name, once.levels, once.two_sided) == (surface.name, surface.levels, surface.two_sided)


def test_the_finishes_of_a_menu_are_these() -> None:
    assert list(FINISHES) == ["plastic", "paint", "metallic", "metal", "rubber", "glass"]
    with pytest.raises(UsageError, match=r"^there is no finish 'metl'; did you mean 'metal'\?$"):
        finished(Surface("body"), "metl")


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


@given(colors(), colors(), st.floats(0, 1))
def test_a_mixed_color_lies_between_both(
    one: tuple[int, int, int], other: tuple[int, int, int], share: float
) -> None:
    for a, b, c in zip(one, other, mixed(one, other, share), strict=True):
        assert min(a, b) <= c <= max(a, b)
    assert mixed(one, other, 0) == one
    assert mixed(one, other, 1) == other
