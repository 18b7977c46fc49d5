from __future__ import annotations

from autocolor.screens.light_and_view.kept import Kept


def test_a_value_is_made_once_for_the_same_sources() -> None:
    kept: Kept[list[int]] = Kept()
    source = [1]
    first = kept.of(lambda: [2], source, "a")
    assert first == [2]
    assert kept.of(lambda: [3], source, "a") is first


def test_a_value_is_made_anew_for_another_source_even_an_equal_one() -> None:
    kept: Kept[list[int]] = Kept()
    source = [1]
    kept.of(lambda: [2], source)
    assert kept.of(lambda: [3], [1]) == [3]
    assert kept.of(lambda: [4], [1], source) == [4]
    assert kept.of(lambda: [5]) == [5]


def test_what_fails_is_tried_again() -> None:
    kept: Kept[float] = Kept()
    for _ in range(2):
        try:
            kept.of(lambda: 1 / 0, "a")
        except ZeroDivisionError:
            continue
        raise AssertionError
    assert kept.of(lambda: 1.0, "a") == 1.0
