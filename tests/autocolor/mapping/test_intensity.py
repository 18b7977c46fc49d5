from __future__ import annotations

import dataclasses
import math
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, LevelRange, Light, Picture, Scene, render
from autocolor.arrays import Words
from autocolor.images import display_image
from autocolor.lighting.picture import IntensityRange
from autocolor.mapping import intensity as mapping_module
from autocolor.mapping.intensity import (
    dithered_levels,
    following_ranges,
    fraction_of,
    fractions_by_surface,
    has_extent,
    held_exposure,
    levels_of,
    mapped_ranges,
    ordered_thresholds,
    stage_surfaces,
)
from autocolor.mapping.ranges import level_ranges
from autocolor.testing import MAPPINGS, scenes
from autocolor.visibility.visible_points import SurfaceSlice
from tests.autocolor.reference import level_of, trimmed
from tests.autocolor.twins.level import curved
from tests.small import wall_scene
from tests.tables import first


def picture_of(*intensities: list[float]) -> Picture:
    """A picture of one line, with some intensities of each surface one after the other."""
    flat = np.array([value for each in intensities for value in each], np.float32)
    stops = np.cumsum([len(each) for each in intensities]).tolist()
    slices = tuple(
        SurfaceSlice(number + 1, stop - len(each), stop)
        for number, (each, stop) in enumerate(zip(intensities, stops, strict=True))
    )
    names = tuple("abcdef"[: len(intensities)])
    return Picture(1, len(flat) + 2, names, np.arange(1, len(flat) + 1), slices, flat, 1.0)


def words_of(
    picture: Picture,
    ranges: Any,
    scaling: str = "surface",
    mapping: Any = "linear",
    exposure: Any = "auto",
    dither: str = "off",
) -> Words:
    extents = mapped_ranges(picture, scaling, exposure)
    return mapping_module.words_of(picture, ranges, extents, mapping, dither)


def test_an_exposure_holds_the_ranges_that_the_scaling_maps() -> None:
    picture = picture_of([1.0, 3.0], [2.0, 8.0], [5.0, 5.0])
    whole, each = ("object", (1.0, 8.0)), [("a", (1.0, 3.0)), ("b", (2.0, 8.0))]
    assert held_exposure(picture, "object") == (whole,)
    assert held_exposure(picture, "surface") == (whole, *each)
    # A range that is held already stays, and with that of the object no other is added.
    assert held_exposure(picture, "surface", (("b", (0.0, 9.0)),)) == (("b", (0.0, 9.0)), whole, each[0])
    assert held_exposure(picture, "surface", (("object", (0.0, 9.0)),)) == (("object", (0.0, 9.0)),)


RANGES = {"a": LevelRange(1, 11), "b": LevelRange(12, 101)}


@given(
    st.lists(st.integers(0, 1000), min_size=2, max_size=40),
    st.sampled_from([mapping for mapping in MAPPINGS if mapping != "equalize"]),
    st.integers(2, 1007),
)
def test_every_level_agrees_with_the_slow_twin(steps: list[int], mapping: Any, levels: int) -> None:
    intensities = np.array(steps, np.float32) * np.float32(1.7)
    least, most = float(intensities.min()), float(intensities.max())
    extent = IntensityRange(least, most)
    shown = fraction_of(extent, mapping, intensities, extent)(intensities)
    for intensity, level in zip(intensities.tolist(), levels_of(shown, levels).tolist(), strict=True):
        if least == most:
            assert level == levels // 2
            continue
        exact = curved(mapping, (intensity - least) / (most - least)) * (levels - 1) + 0.5
        if abs(exact - round(exact)) > 1e-3:
            assert level == level_of((exact - 0.5) / (levels - 1), levels)


@pytest.mark.parametrize("scaling", ["surface", "object"])
@pytest.mark.parametrize("mapping", first(2, MAPPINGS), ids=str)
def test_where_nothing_has_an_extent_every_pixel_has_the_middle_level(scaling: str, mapping: Any) -> None:
    words = words_of(picture_of([3.0, 3.0], [3.0]), RANGES, scaling, mapping)
    assert words.tolist() == [[0, 6, 6, 62, 0]]


@pytest.mark.parametrize("contrast", ["stretch", "floor"])
@pytest.mark.parametrize("exposure", ["auto", "99.5 %"])
@pytest.mark.parametrize("paint", [{"blend": 0.0}, {"blend": 0.7}, {"ramp": ["#300", "#fff"]}], ids=str)
def test_with_the_last_light_off_no_pixel_is_brighter_and_each_has_its_lowest_level(
    contrast: Any, exposure: str, paint: dict[str, Any]
) -> None:
    scene = wall_scene().replace(contrast=contrast, exposure=exposure, ambient=0.05)
    scene = scene.with_paint("wall", **paint)
    dark = scene.replace(lights=[light.replace(on=False) for light in scene.lights])
    lit, unlit = (display_image(each, render(each, (32, 24))) for each in (scene, dark))
    assert (unlit.colors <= lit.colors).all()
    assert set(unlit.words.ravel().tolist()) == {0, unlit.ranges["wall"].first}


@pytest.mark.parametrize("mapping", MAPPINGS, ids=str)
def test_a_held_range_of_the_object_maps_every_surface(mapping: Any) -> None:
    picture = picture_of([0, 5, 10], [5, 20])
    held = (("object", (5.0, 10.0)),)
    words = words_of(picture, RANGES, "object", mapping, held).ravel().tolist()
    assert 1 <= words[1] == words[2] < words[3] == 11
    assert 12 <= words[4] < words[5] == 112


def test_a_held_range_is_in_intensities_and_not_in_the_scale_of_the_picture() -> None:
    relative = picture_of([1, 2, 3])
    doubled = dataclasses.replace(relative, relative=relative.relative / np.float32(2), scale=2.0)
    held = (("a", (0.0, 4.0)),)
    words = words_of(relative, RANGES, exposure=held)
    assert words.tolist() == words_of(doubled, RANGES, exposure=held).tolist() == [[0, 4, 6, 9, 0]]


def test_dithering_keeps_the_mean_of_a_level_that_lies_between_two() -> None:
    for tenths in range(11):
        fraction = np.full(64, tenths / 10, np.float32)
        levels = dithered_levels(fraction, 2, ordered_thresholds(8, 8))
        assert abs(levels.mean() - tenths / 10) <= 1 / 128
    assert sorted(ordered_thresholds(8, 8).tolist()) == [(place + 0.5) / 64 for place in range(64)]


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_an_intensity_that_is_not_finite_is_refused_by_name(wrong: float) -> None:
    with pytest.raises(InputError, match="surface 'b': an intensity must be finite, not "):
        words_of(picture_of([1, 2], [1, wrong]), RANGES)


@pytest.mark.parametrize("mapping", MAPPINGS, ids=str)
def test_everything_above_a_held_range_has_the_highest_level_and_below_it_the_lowest(mapping: Any) -> None:
    picture = picture_of([5, 6, 7], [5, 9])
    bright = words_of(picture, RANGES, "object", mapping, (("object", (1.0, 4.0)),))
    dark = words_of(picture, RANGES, "object", mapping, (("object", (10.0, 40.0)),))
    assert bright.tolist() == [[0, 11, 11, 11, 112, 112, 0]]
    lowest = words_of(picture_of([5, 6], [5, 9]), RANGES, "object", mapping).ravel()[1] - 1
    assert dark.tolist() == [[0, *[1 + lowest] * 3, *dark.ravel()[4:6].tolist(), 0]]
    assert dark.ravel()[4] == dark.ravel()[5]


def test_a_held_range_too_narrow_for_float32_has_no_extent() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for limits in ((0.0, 1e-300), (1e-38, 1.1e-38), (3e38, 3.1e38), (1.0, 1.0000001)):
            words = words_of(picture_of([1, 2, 3]), RANGES, exposure=(("a", limits),))
            assert words.min() >= 0
            assert words.max() <= 11


def test_a_surface_named_object_has_no_held_range_of_its_own() -> None:
    picture = dataclasses.replace(picture_of([1, 2, 3], [10, 20]), surfaces=("object", "b"))
    ranges = {"object": LevelRange(1, 11), "b": LevelRange(12, 101)}
    held = words_of(picture, ranges, exposure=(("b", (10.0, 20.0)),))
    assert held.tolist() == words_of(picture, ranges).tolist()


def test_dithering_leaves_a_range_without_extent_alone() -> None:
    words = words_of(picture_of([3.0] * 30), {"a": LevelRange(1, 10)}, dither="ordered")
    assert set(words.ravel().tolist()) == {0, 6}


def test_half_the_light_is_half_as_bright_where_the_exposure_is_held() -> None:
    scene = wall_scene(lights=[Light("key", (1.0, -3.0, 2.0))], scaling="object")
    picture = render(scene, (32, 24))
    held = scene.replace(exposure={"object": (0.0, picture.ranges.whole.maximum)})
    dimmed = held.with_light("key", intensity=0.5)
    bright = display_image(held, render(held, (32, 24))).words.astype(int) - 1
    dark = display_image(dimmed, render(dimmed, (32, 24))).words.astype(int) - 1
    seen = picture.surface_number > 0
    assert bright[seen].max() == 1006
    assert np.abs(dark[seen] * 2 - bright[seen]).max() <= 1


@pytest.mark.parametrize("exposure", ["auto", "99.5 %"])
def test_no_range_is_held_if_no_range_has_an_extent(exposure: str) -> None:
    scene = wall_scene(lights=()).replace(ambient=0)
    assert held_exposure(render(scene, (12, 9)), scene.scaling, exposure) == exposure


def test_an_extent_of_a_few_units_in_the_last_place_is_none() -> None:
    assert not has_extent(IntensityRange(0.0, 0.0))
    assert not has_extent(IntensityRange(1.0, 1.0 + 4 * 2.0**-23))
    assert has_extent(IntensityRange(1.0, 1.0 + 16 * 2.0**-23))
    assert has_extent(IntensityRange(0.0, 1e-30))


values = st.lists(st.floats(0, 4, width=32), min_size=1, max_size=40)
percentages = st.sampled_from(["50 %", "60 %", "90 %", "97.5 %", "99.5 %", "100 %"])


@given(values, st.integers(1, 30), st.floats(0, 4, width=32), percentages)
def test_a_trimmed_range_leaves_out_the_brightest_as_sorting_all_intensities_would(
    some: list[float], times: int, plateau: float, percentage: str
) -> None:
    # Many equal intensities around others, so that a sample often misses the brightest.
    intensities = [*some, *[plateau] * (40 * times), *some]
    picture = picture_of(intensities)
    expected = trimmed(intensities, percentage)
    assert tuple(following_ranges(picture, "object", percentage)[0]) == pytest.approx(expected, rel=1e-7)


def test_a_surface_is_trimmed_by_its_own_intensities_or_by_those_of_the_object() -> None:
    dark, bright = [*np.linspace(0.1, 0.5, 9).tolist(), 1.0], [*np.linspace(1, 8, 9).tolist(), 9.0]
    picture = picture_of(dark, bright)
    of_surfaces = following_ranges(picture, "surface", "90 %")
    assert of_surfaces[1].maximum == pytest.approx(0.5)
    assert of_surfaces[2].maximum == pytest.approx(8)
    assert following_ranges(picture, "object", "90 %")[0].maximum == pytest.approx(7.125)


def test_a_percentage_counts_the_pixels_of_the_object_and_not_those_of_the_stage() -> None:
    of_object, floor = np.linspace(0.1, 10, 200).tolist(), [1.0] * 5000
    alone = following_ranges(picture_of(of_object), "object", "90 %")[0]
    beside = following_ranges(picture_of(of_object, floor), "object", "90 %", frozenset({2}))[0]
    assert beside.maximum == alone.maximum
    nothing = following_ranges(picture_of(of_object), "object", "90 %", frozenset({1}))[0]
    assert nothing == alone


def test_a_surface_without_extent_is_not_trimmed_and_has_the_range_of_the_object() -> None:
    picture = picture_of([0.1] * 20, np.linspace(0.1, 1, 20).tolist())
    ranges = mapped_ranges(picture, "surface", "90 %")
    assert ranges[1] == ranges[0]
    assert words_of(picture, RANGES, exposure="90 %").ravel()[1] == RANGES["a"].first


def test_specks_are_at_the_highest_level_and_leave_all_other_words() -> None:
    body = np.linspace(0.2, 1, 1000).tolist()
    clean, specked = picture_of(body), picture_of([*body, 30.0, 40.0, 50.0])
    words = [
        words_of(each, {"a": LevelRange(1, 100)}, "object", exposure="99.5 %").ravel()
        for each in (clean, specked)
    ]
    assert words[1][1001:-1].tolist() == [100] * 3
    assert np.abs(words[0][1:1001].astype(int) - words[1][1:1001]).max() <= 1
    automatic = words_of(specked, {"a": LevelRange(1, 100)}, "object").ravel()
    assert automatic[1:1001].max() < 4


def test_a_narrow_range_is_trimmed_continuously_to_two_fifths_of_its_maximum() -> None:
    for least in (0.0, 0.3, 0.59, 0.61, 0.99, 1.0):
        picture = picture_of([least, 1.0])
        assert tuple(following_ranges(picture, "object", "99.5 %")[0]) == pytest.approx((min(least, 0.6), 1))


@given(scenes(), st.sampled_from(["60 %", "99.5 %"]), st.sampled_from([0.125, 0.5, 2.0, 64.0]))
def test_scaling_all_light_leaves_every_word(scene: Scene, percentage: str, factor: float) -> None:
    lights = [light.replace(intensity=factor * light.intensity) for light in scene.lights]
    scene = scene.replace(exposure=percentage, scalar=None)
    scaled = scene.replace(lights=lights, ambient=factor * scene.ambient)
    one, other = (display_image(each, render(each, (12, 9))) for each in (scene, scaled))
    assert other.words.tolist() == one.words.tolist()
    assert other.entries.tolist() == one.entries.tolist()


@pytest.mark.parametrize(
    ("intensities", "scaling", "words"),
    [
        # Each surface has its own minimum and maximum.
        (([1, 2, 3], [10, 20]), "surface", [1, 6, 11, 12, 112]),
        # The whole object has one.
        (([0, 5, 10], [5, 20]), "object", [1, 4, 6, 37, 112]),
        # A surface without extent, or with one within rounding of its maximum, has those of the object.
        (([1, 5], [2, 2]), "surface", [1, 11, 37, 37]),
        (([1, 5], [2, np.nextafter(np.float32(2), np.float32(3))]), "surface", [1, 11, 37, 37]),
    ],
)
def test_a_minimum_and_a_maximum_have_the_lowest_and_the_highest_level(
    intensities: tuple[list[float], ...], scaling: str, words: list[int]
) -> None:
    found = words_of(picture_of(*intensities), RANGES, scaling, "linear")
    assert found.tolist() == [[0, *words, 0]]


@given(scenes())
def test_brighter_pixels_of_a_surface_have_higher_words_of_its_range_and_dithering_moves_them_by_one(
    scene: Scene,
) -> None:
    picture = render(scene, (16, 12))
    ranges = level_ranges(scene.surfaces, {part.surface: 1 for part in scene.parts})
    plain, dithered = (
        words_of(picture, ranges, scene.scaling, scene.mapping, scene.exposure, dither)
        for dither in ("off", "ordered")
    )
    assert plain.max() <= 1023
    assert not plain.flags.writeable
    assert np.abs(plain.astype(int) - dithered).max() <= 1
    for words in (plain, dithered):
        assert (words[picture.surface_number == 0] == 0).all()
        for number, name in enumerate(picture.surfaces, 1):
            on_surface = words[picture.surface_number == number]
            first, levels = ranges.get(name, (0, 0))
            assert ((on_surface >= first) & (on_surface < first + levels)).all()
    for number in range(1, len(picture.surfaces) + 1):
        of_surface = picture.surface_number == number
        order = np.argsort(picture.intensity[of_surface], kind="stable")
        assert (np.diff(plain[of_surface][order].astype(int)) >= 0).all()


@given(scenes())
def test_held_ranges_map_as_before_and_the_others_come_from_the_picture(scene: Scene) -> None:
    picture = render(scene, (12, 9))
    ranges = mapped_ranges(picture, scene.scaling, scene.exposure)
    held = {} if isinstance(scene.exposure, str) else dict(scene.exposure)
    found = following_ranges(picture, "surface", scene.exposure)

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

    # If the exposure is held now, no word changes, and what was held stays.
    exposure = held_exposure(picture, scene.scaling, scene.exposure, stage_surfaces(scene))
    if held:
        assert held.items() <= dict(exposure).items()  # type: ignore[arg-type]
    now, then = display_image(scene, picture), display_image(scene.replace(exposure=exposure), picture)
    assert then.words.tolist() == now.words.tolist()
    assert then.entries.tolist() == now.entries.tolist()


def test_the_function_of_one_surface_is_that_among_all_and_maps_its_range_to_0_and_1() -> None:
    picture = picture_of([0.1, 0.4, 0.9], [0.2, 0.3, 1.5])
    extents = mapped_ranges(picture, "surface", "auto")
    of_all, of_one = (fractions_by_surface(picture, extents, "linear", only) for only in (None, 2))
    values = np.array([0.2, 0.3, 1.5], np.float32)
    for functions in (of_all, of_one):
        assert functions[2](values).tolist() == pytest.approx([0, 0.1 / 1.3, 1])
    assert [*of_all, *of_one] == [1, 2, 2]
