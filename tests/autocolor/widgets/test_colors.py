from __future__ import annotations

from autocolor.mapping.level_ranges import SCREENS
from autocolor.widgets import colors


def test_the_words_of_the_screens_belong_to_the_screens_and_differ() -> None:
    names = (
        "BLACK", "WHITE", "LIGHT_GRAY", "GRAY", "SLATE", "NIGHT", "YELLOW", "ORANGE", "RED", "GREEN", "BLUE",
    )  # fmt: skip
    words = [getattr(colors, name) for name in names]
    assert len(set(words)) == len(words)
    assert all(SCREENS.first <= word <= SCREENS.last for word in words)
