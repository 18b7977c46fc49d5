from __future__ import annotations

from hypothesis import given

from autocolor.widgets.areas import Area
from tests.autocolor.widgets.drawing import areas


@given(areas(), areas())
def test_areas_meet_where_pixels_are_in_both(one: Area, other: Area) -> None:
    def pixels(area: Area) -> set[tuple[int, int]]:
        return {
            (element, line)
            for element in range(area.left, area.right + 1)
            for line in range(area.top, area.bottom + 1)
        }

    assert pixels(one.within(other)) == pixels(one) & pixels(other)
    assert one.is_empty is (not pixels(one))
    if not one.is_empty and not other.is_empty:
        assert one.overlaps(other) is bool(pixels(one) & pixels(other))
        assert one.covers(other) is (pixels(one) >= pixels(other))
        assert len(pixels(one)) == one.width * one.height
