from __future__ import annotations

import math
import zlib
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from autocolor import Scene, View, render, scene_of
from autocolor.images import display_image
from autocolor.mapping.bands import Bands
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.legend import (
    BAR_ELEMENTS,
    CHARACTER,
    LETTER_LINES,
    Legend,
    in_few_digits,
    laid_out,
    legend,
    lines_of_band,
    numbers_beside,
    round_numbers,
)
from autocolor.mapping.ranges import SCREENS
from autocolor.scene.color_scales import scale_colors
from tests.small import sphere


def ball(**scalar: Any) -> Scene:
    return scene_of(sphere(12, 8)).with_scalar(**{"name": "z", **scalar})


def shown(scene: Scene, lines: int = 480, elements: int = 640) -> DisplayImage:
    return display_image(scene, render(scene, (elements, lines)))


def legend_of(image: DisplayImage) -> Legend:
    found = legend(image)
    assert found is not None
    return found


def test_the_bar_has_the_brightest_word_of_each_band_from_the_lowest_at_the_bottom() -> None:
    image = shown(ball(scale="turbo", bands=7, shades=3))
    (first, _), (bands,) = *image.ranges.values(), image.bands.values()
    bar = [each for each in legend_of(image).swatches if each.word < SCREENS.first]
    assert [each.word for each in bar] == [first + bands.brightest(band) for band in range(7)]
    assert all(lower.top == upper.bottom + 1 for lower, upper in pairwise(bar))
    assert {each.right - each.left + 1 for each in bar} == {BAR_ELEMENTS}
    assert (image.entries[[each.word for each in bar]] == scale_colors("turbo", 7)).all()


# If the legend changes on purpose, look at it, and copy the new numbers from the failure.
PLACED = [
    ({"limits": [-2, 6], "bands": 8}, 107314004),
    ({"limits": [0, 1], "bands": 3, "below": "red", "above": "blue"}, 3762902172),
    ({"bands": 64, "scale": "turbo"}, 1305216673),
    ({"name": "mean curvature", "bands": 5}, 1901399814),
]


@pytest.mark.parametrize(("scalar", "number"), PLACED)
def test_the_legend_stands_where_it_stood(scalar: dict[str, Any], number: int) -> None:
    found = legend_of(shown(ball(**scalar)))
    assert zlib.crc32(repr(found).replace(", begin=0", "").encode()) == number


@pytest.mark.parametrize("limits", [[-2, 6], [0, 1e5]])
def test_a_picture_has_a_legend_if_it_takes_at_most_two_fifths_of_its_width(limits: list[float]) -> None:
    scene = ball(limits=limits, bands=8)
    frame = legend_of(shown(scene)).swatches[0]
    # The frame, and the margin beside it.
    taken = frame.right - frame.left + 1 + 8
    least = math.ceil(taken / 0.4)
    assert legend(shown(scene, elements=least)) is not None
    assert legend(shown(scene, elements=least - 1)) is None
    # The height of the frame, and the margins above and below it.
    least = frame.bottom - frame.top + 1 + 2 * 8
    assert legend(shown(scene, lines=least)) is not None
    assert legend(shown(scene, lines=least - 1)) is None


def test_a_limit_that_values_exceed_is_written_at_its_end_of_the_bar() -> None:
    found = legend_of(shown(ball(limits=[-0.53, 0.53])))
    bar = [each for each in found.swatches if each.word < SCREENS.first]
    at = {each.text: each.top + LETTER_LINES // 2 for each in found.labels[1:]}
    assert (at["< -0.53"], at["> 0.53"]) == (bar[0].bottom + 1, bar[-1].top)
    assert {"-0.4", "0", "0.4"} <= set(at)
    within = {each.text for each in legend_of(shown(ball(limits=[-1.5, 1.5]))).labels}
    assert all(text[0] not in "<>" for text in within)


@given(st.integers(2, 256), st.sampled_from(["z", "gaussian curvature", "x" * 40, "a b c d e " * 9]))
def test_all_of_it_is_inside_its_frame_and_the_frame_inside_the_picture(bands: int, name: str) -> None:
    found = laid_out(
        name, Bands(-1234.5, 6789.1, bands, 1, True, True, True), 1, (480, 640), (1, 0), (True, True)
    )
    assert found is not None
    assert [each.text for each in found.labels[-2:]] == ["< -1234", "no value"]
    frame = found.swatches[0]
    assert frame.left >= 0
    assert frame.top >= 0
    assert frame.right < 640
    assert frame.bottom < 464
    for swatch in found.swatches[1:]:
        assert frame.left < swatch.left <= swatch.right < frame.right
        assert frame.top < swatch.top <= swatch.bottom < frame.bottom
    for label in found.labels:
        assert frame.left < label.left
        assert label.left + CHARACTER * len(label.text) - 1 < frame.right
        assert frame.top < label.top
        assert label.top + LETTER_LINES - 1 < frame.bottom


def test_there_is_none_without_a_scalar_nor_where_it_is_switched_off_nor_in_a_small_picture() -> None:
    scene = ball()
    assert legend(shown(scene.without_scalar())) is None
    assert legend(shown(scene.with_scalar(legend=False))) is None
    assert legend(shown(scene, 48, 64)) is None
    assert legend(shown(scene.with_scalar(surfaces=[]))) is None


def test_it_stands_where_there_is_room() -> None:
    image = shown(ball())
    right, left = legend_of(image).swatches[0], legend(image, corners=[(0, 0)])
    beside = legend(image, 504, [(1, 0)])
    assert left is not None
    assert beside is not None
    assert right.right == 640 - 9
    assert left.swatches[0].left == 8
    assert beside.swatches[0].right == 504 - 9
    assert beside.has(504 - 9, 20)
    assert not beside.has(504 - 8, 20)


@pytest.mark.parametrize(
    ("values", "told", "exponent"),
    [
        ([0, 62.5, 125], ["0", "62.5", "125"], 0),
        ([-1, -0.5, 0, 0.5, 1], ["-1", "-0.5", "0", "0.5", "1"], 0),
        ([0, 1 / 3, 2 / 3, 1], ["0", "0.333", "0.667", "1.000"], 0),
        ([0, 1e-6, 2e-6], ["0", "1", "2"], -6),
        ([0, 15_000, 30_000, 45_000], ["0", "15000", "30000", "45000"], 0),
        ([1e30, 2e30, 3e30], ["1", "2", "3"], 30),
        ([0, 1e-300, 2e-300], ["0", "1", "2"], -300),
    ],
)
def test_numbers_are_written_in_few_digits(values: list[float], told: list[str], exponent: int) -> None:
    assert in_few_digits(values, values[1] - values[0]) == (told, exponent)


numbers = st.floats(-1e9, 1e9).filter(lambda value: value == 0 or abs(value) > 1e-9)


@given(numbers, st.floats(1e-6, 1e9), st.integers(1, 16))
def test_round_numbers_are_multiples_of_a_round_step_within_the_limits(
    low: float, extent: float, count: int
) -> None:
    high = low + extent
    assume(low < high and extent > 1e-6 * abs(low))
    values = round_numbers(low, high, count)
    assert 2 <= len(values) <= count + 1
    if values == [low, high]:
        return
    step = (values[-1] - values[0]) / (len(values) - 1)
    mantissa = step / 10 ** math.floor(math.log10(step) + 1e-6)
    assert any(mantissa == pytest.approx(wanted, rel=1e-6) for wanted in (1, 2, 5))
    assert all(value / step == pytest.approx(round(value / step), abs=1e-2) for value in values)
    assert low - 1e-6 * step <= values[0] <= low + step * 1.0001
    assert high - step * 1.0001 <= values[-1] <= high + 1e-6 * step


@given(numbers, st.floats(1e-6, 1e9), st.integers(2, 256))
def test_numbers_are_far_enough_apart_and_each_is_what_it_says(low: float, extent: float, bands: int) -> None:
    high = low + extent
    assume(low < high and extent > 1e-6 * abs(low))
    lines = lines_of_band(bands)
    texts, exponent, places = numbers_beside(low, high, bands, lines, 22)
    assert len(places) == 2 or all(after - before >= 11 for before, after in pairwise(places))
    for text, place in zip(texts, places, strict=True):
        value = low + (high - low) * place / (bands * lines)
        assert abs(float(text) * 10.0**exponent - value) <= extent / (bands * lines) + extent / 20


limits = st.floats(-1e30, 1e30, allow_subnormal=True)


@given(limits, limits, st.integers(1, 256))
@example(0, 5e-324, 8)
@example(-1e-323, 5e-324, 7)
@example(0, 1e-320, 8)
@example(0, 3e-308, 8)
@example(-1e30, 1e30, 1)
def test_limits_may_be_any_two_numbers(low: float, high: float, bands: int) -> None:
    assume(low < high)
    lines = lines_of_band(bands)
    texts, _, places = numbers_beside(low, high, bands, lines, 22)
    assert all(math.isfinite(float(text)) for text in texts)
    assert places == sorted(places)
    assert 0 <= places[0] < places[-1] <= bands * lines


@given(st.integers(-100, 700), st.integers(-100, 500))
def test_a_legend_is_where_it_was_put_and_inside(left: int, top: int) -> None:
    def at(place: tuple[float, float]) -> Legend:
        found = laid_out("z", Bands(0, 1, 8, 1), 1, (480, 640), place)
        assert found is not None
        return found

    frame = at(at((0.3, 0.7)).place_at(left, top)).swatches[0]
    right, down = at((0, 0)).room
    assert frame[:2] == (min(max(left, 8), 8 + right), min(max(top, 8), 8 + down))


@given(st.integers(-40, 40), st.integers(2, 256), st.integers(1, 24))
def test_whole_numbers_are_beside_the_middles_of_their_bands_and_far_enough_apart(
    first: int, bands: int, lines: int
) -> None:
    texts, exponent, places = numbers_beside(first - 0.5, first - 0.5 + bands, bands, lines, 22)
    assert exponent == 0
    assert [int(text) - first for text in texts] == [place // lines for place in places]
    assert all(after - before >= 11 for before, after in pairwise(places))
    assert texts[0] == str(first)


@pytest.mark.parametrize(
    ("scalar", "texts"),
    [
        ({"limits": [-2, 6], "bands": 8}, ["-2", "-1", "0", "1", "2", "3", "4", "5", "6"]),
        ({"limits": [0, 8e6], "bands": 2}, ["x 1e6", "5", "< 0"]),
        ({"limits": [0.5, 4.5], "bands": 4}, ["1", "2", "3", "4", "< 0.5"]),
        ({"limits": [-1, 1], "bands": 2, "below": "red", "above": "blue"}, ["> 1", "-1", "0", "1", "< -1"]),
    ],
)
def test_it_tells_the_name_and_the_numbers_of_the_bar_and_of_the_colors_beyond(
    scalar: dict[str, Any], texts: list[str]
) -> None:
    assert [each.text for each in legend_of(shown(ball(**scalar))).labels] == ["z", *texts]


@pytest.mark.parametrize(
    ("left", "right", "low", "is_stage", "corner"),
    [
        (-9, 0, -9, False, (566, 8)),
        (0, 9, -9, False, (8, 8)),
        (-9, 9, 0, False, (573, 233)),
        # It may hide the stage.
        (0, 9, -9, True, (566, 8)),
    ],
)
def test_it_hides_as_little_of_the_object_as_it_can(
    left: float, right: float, low: float, is_stage: bool, corner: tuple[int, int]
) -> None:
    plate = [[left, 0, low], [right, 0, low], [right, 0, 9], [left, 0, 9]]
    view = View((0, -5, 0), (0, 1, 0), field_of_view=60)
    scene = scene_of(plate, [[0, 1, 2, 3]], view=view).with_scalar(name="z", limits=[-2, 6], bands=8)
    part = scene.parts[0]
    scene = scene.with_part(part.name, stage=is_stage).with_scalar(surfaces=[part.surface])
    assert legend_of(shown(scene)).swatches[0][:2] == corner
