from __future__ import annotations

from autocolor.checks import Color
from autocolor.screens.scalars.color_choice import NAMED, color_choice


def test_the_row_tells_a_color_by_its_name_or_in_digits() -> None:
    def present(color: Color | None) -> str:
        return color_choice("below", "", color, lambda _: None, has_none=True).present

    assert [present((255, 0, 255)), present((1, 2, 3)), present(None)] == ["magenta", "#010203", "none"]


def test_all_colors_and_none_are_reached_by_clicks() -> None:
    taken: list[Color | None] = []
    row = color_choice("below", "", None, taken.append, has_none=True)
    for name in row.names:
        row.choose(name)
    assert taken == [None, *NAMED.values()]
    assert "none" not in color_choice("missing", "", (0, 0, 0), taken.append, has_none=False).names
