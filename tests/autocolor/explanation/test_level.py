from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Paint, View, scene_of
from autocolor.explanation.explain import explain
from autocolor.explanation.level import (
    band_colors,
    band_of,
    color_of,
    corner_weights,
    equalized,
    light_share,
    ordered_threshold,
    scalar_value,
    word_of,
)
from autocolor.explanation.point import Camera, point_at
from autocolor.images import display_image
from autocolor.mapping.bands import Bands, band_numbers
from autocolor.mapping.intensity import ordered_thresholds
from autocolor.rendering import rendering
from autocolor.scene.color_scales import COLOR_SCALES, scale_colors
from autocolor.scene.curves import CURVES
from autocolor.scene.scalar import COMPUTED
from autocolor.testing import blended_paints, numbers, scales
from autocolor.visibility.visible_points import Sight
from tests.small import car, opened, sphere

LINES, ELEMENTS = 24, 32


@pytest.mark.parametrize("name", COMPUTED)
def test_every_computed_scalar_is_that_of_the_picture(name: str) -> None:
    mesh = sphere(16, 8)
    stretched = type(mesh)(mesh.coordinates * (1.0, 0.7, 1.3), mesh.node_numbers, crease_angle=180.0)
    view = View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0))
    scene = scene_of(stretched, view=view).with_scalar(name=name, direction=(0.2, 0.1, 1.0))
    both = rendering(scene, LINES, ELEMENTS)
    values, points = both.picture.scalar_values, both.points
    assert values is not None
    assert scene.scalar is not None
    camera = Camera(view, LINES, ELEMENTS)
    for place in range(0, len(points.pixels), 7):
        pixel = int(points.pixels[place])
        at = point_at(scene, camera, int(points.polygon_numbers[place]), *divmod(pixel, ELEMENTS))
        found, expected = scalar_value(scene.mesh, scene.scalar, at), float(values[place])
        if name == "zebra":
            # The phase goes around.
            found = (found - expected + 0.5) % 1 - 0.5 + expected
        assert found == pytest.approx(expected, rel=1e-4, abs=1e-4)


def test_a_missing_value_has_the_band_and_the_color_of_missing_values() -> None:
    scene = car().with_scalar(name="stress", missing="#0a141e", shades=1)
    studio, _ = opened(scene)
    level = studio.explain(12, 16).level
    assert level is not None
    assert level.scalar is not None
    assert level.scalar.value is None
    assert level.scalar.band == studio.display_image.bands["body"].missing
    assert color_of(level) == (10, 20, 30)
    assert word_of(level) == studio.words[12, 16]


@given(
    st.integers(0, 40),
    st.tuples(st.booleans(), st.booleans()),
    st.lists(numbers(-2, 12) | st.just(float("nan")), min_size=1, max_size=20),
)
def test_bands_are_those_of_the_picture(count: int, beyond: tuple[bool, bool], values: list[float]) -> None:
    bands = Bands(0.0, 10.0, count + 2, 3, *beyond, True)
    singles = np.array(values, np.float32)
    assert [band_of(float(each), bands) for each in singles] == band_numbers(singles, bands).tolist()


@given(scales() | st.sampled_from(list(COLOR_SCALES)), st.integers(1, 40))
def test_the_colors_of_bands_are_those_of_the_scale(scale: str, count: int) -> None:
    # Rounding decides about halves.
    found, expected = np.array([*band_colors(scale, count)]), scale_colors(scale, count).astype(int)
    assert np.abs(found - expected).max() <= 1
    assert found[[0, -1]].tolist() == expected[[0, -1]].tolist()


def test_the_thresholds_are_those_of_the_picture() -> None:
    found = [ordered_threshold(line, element) for line in range(11) for element in range(13)]
    assert found == ordered_thresholds(11, 13).tolist()


@given(st.lists(numbers(0.1, 3), min_size=2, max_size=30, unique=True), st.booleans())
def test_equalized_levels_are_those_of_the_picture(given: list[float], held: bool) -> None:
    intensities = np.array(given, np.float32)
    low, high = np.float32(0.1 if held else intensities.min()), np.float32(3 if held else intensities.max())
    if high - low < 1e-3:
        return
    curve = CURVES["equalize"](low, high, intensities)
    for each in intensities:
        found = equalized(intensities.astype(np.float64), float(low), float(high), float(each))
        # Intensities that are equal but for rounding count as equal.
        same = np.count_nonzero(np.abs(intensities - each) < 1e-5) / len(intensities)
        assert abs(found - float(curve(np.array([each]))[0])) <= same + 1e-6


@given(blended_paints(), st.integers(2, 300))
def test_the_light_color_grows_in_equal_steps_to_its_percentage(paint: Paint, levels: int) -> None:
    shares = np.array([light_share(paint, level, levels) for level in range(levels)])
    steps = np.diff(shares[shares > 0])
    assert steps == pytest.approx(steps[:1].repeat(len(steps)), abs=1e-9)
    expected = 0 if int(paint.blend * (levels - 1) + 0.5) == levels - 1 else paint.light_percentage / 100
    assert shares[-1] == pytest.approx(expected)


def test_the_weights_of_corners_give_the_point_back() -> None:
    quad = [(0.0, 0.0, 0.0), (3.0, 0.0, 1.0), (3.0, 2.0, 1.0), (0.0, 1.0, 0.0)]
    dart = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.0, 2.0, 0.0)]
    for corners, point in ((quad, (1.5, 0.75, 0.5)), (dart, (1.0, 0.2, 0.0)), (dart, (0.2, 1.0, 0.0))):
        weights = corner_weights(corners, point)
        assert sum(weights) == pytest.approx(1)
        assert min(weights) >= 0
        assert np.array(weights) @ np.array(corners) == pytest.approx(point)


def test_a_range_is_the_surfaces_or_the_objects_and_can_be_held() -> None:
    scene = car()
    for changes, range_of, is_held in (
        ({"scaling": "surface"}, "surface", False),
        ({"scaling": "object"}, "object", False),
        ({"exposure": {"body": [0.0, 2.0]}}, "surface", True),
        ({"exposure": {"object": [0.0, 2.0]}}, "object", True),
    ):
        edited = scene.replace(**changes)
        both = rendering(edited, LINES, ELEMENTS)
        level = explain(Sight(edited, both.points), display_image(edited, both.picture), 12, 16).level
        assert level is not None
        assert (level.range_of, level.is_held) == (range_of, is_held)
        if is_held:
            assert (level.minimum, level.maximum) == pytest.approx((0, 2))
