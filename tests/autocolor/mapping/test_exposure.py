from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Light, Scene, render
from autocolor.lighting.picture import IntensityRange
from autocolor.mapping.display_image import display_image
from autocolor.mapping.exposure import has_extent, held_exposure, mapped_ranges
from tests.autocolor.meshes import wall_scene
from tests.autocolor.strategies import scenes


@given(scenes())
def test_holding_the_exposure_of_a_picture_changes_no_word(scene: Scene) -> None:
    picture = render(scene, 9, 12)
    held = scene.replace(exposure=held_exposure(picture, scene.scaling, scene.exposure))
    now, then = display_image(scene, picture), display_image(held, picture)
    assert then.words.tolist() == now.words.tolist()
    assert then.entries.tolist() == now.entries.tolist()


@given(scenes())
def test_every_range_that_is_mapped_is_held_or_found_in_the_picture(scene: Scene) -> None:
    picture = render(scene, 9, 12)
    ranges = mapped_ranges(picture, scene.scaling, scene.exposure)
    held = {} if isinstance(scene.exposure, str) else dict(scene.exposure)
    found = picture.relative_ranges

    def in_scale(name: str) -> IntensityRange:
        low, high = held[name]
        return IntensityRange(low / picture.scale, high / picture.scale)

    whole = in_scale("object") if "object" in held else found[0]
    assert tuple(ranges[0]) == pytest.approx(whole)
    for surface in picture.slices:
        name = picture.surfaces[surface.surface_number - 1]
        if name in held:
            expected = in_scale(name)
        elif "object" in held or scene.scaling == "object":
            expected = whole
        else:
            expected = found[surface.surface_number]
        if not has_extent(expected):
            expected = whole
        assert tuple(ranges[surface.surface_number]) == pytest.approx(expected)


def test_half_the_light_is_half_as_bright_where_the_exposure_is_held() -> None:
    scene = wall_scene(lights=[Light("key", (1.0, -3.0, 2.0))], scaling="object")
    picture = render(scene, 24, 32)
    held = scene.replace(exposure={"object": (0.0, picture.ranges.whole.maximum)})
    dimmed = held.with_light("key", intensity=0.5)
    bright = display_image(held, render(held, 24, 32)).words.astype(int) - 1
    dark = display_image(dimmed, render(dimmed, 24, 32)).words.astype(int) - 1
    seen = picture.surface_number > 0
    assert bright[seen].max() == 1006
    assert np.abs(dark[seen] * 2 - bright[seen]).max() <= 1


def test_nothing_is_held_where_nothing_has_an_extent() -> None:
    scene = wall_scene(lights=())
    assert held_exposure(render(scene, 9, 12), scene.scaling) == "auto"


def test_an_extent_of_a_few_units_in_the_last_place_is_none() -> None:
    assert not has_extent(IntensityRange(0.0, 0.0))
    assert not has_extent(IntensityRange(1.0, 1.0 + 4 * 2.0**-23))
    assert has_extent(IntensityRange(1.0, 1.0 + 16 * 2.0**-23))
    assert has_extent(IntensityRange(0.0, 1e-30))


@given(scenes())
def test_what_is_held_already_stays_held_as_it_is(scene: Scene) -> None:
    exposure = held_exposure(render(scene, 9, 12), scene.scaling, scene.exposure)
    if not isinstance(scene.exposure, str):
        held = dict(scene.exposure)
        assert not isinstance(exposure, str)
        assert {name: limits for name, limits in exposure if name in held} == held
