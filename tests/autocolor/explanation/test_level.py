from __future__ import annotations

import pytest

from autocolor.explanation.explain import explain
from autocolor.explanation.level import word_of
from autocolor.images import display_image
from autocolor.rendering import rendering
from autocolor.visibility.visible_points import Sight
from tests.small import car, opened

LINES, ELEMENTS = 24, 32


def test_a_missing_value_has_the_band_and_the_color_of_missing_values() -> None:
    scene = car().with_scalar(name="stress", missing="#0a141e", shades=1)
    studio, _ = opened(scene)
    level = studio.explain(12, 16).level
    assert level is not None
    assert level.scalar is not None
    assert level.scalar.value is None
    assert level.scalar.band == studio.display_image.bands["body"].missing
    assert level.scalar.band_color == (10, 20, 30)
    assert word_of(level) == studio.words[12, 16]


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
