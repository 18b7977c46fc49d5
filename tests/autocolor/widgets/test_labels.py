from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.labels import FEWEST, short_label, short_name


@pytest.mark.parametrize(
    ("label", "most", "short"),
    [
        ("cone angle", 10, "cone angle"),
        ("x minimum", 7, "x min."),
        ("normal reflectance", 12, "normal refl."),
        ("concentration", 9, "concentr."),
        ("aim", 1, "aim"),
        ("", 0, ""),
    ],
)
def test_the_longest_word_is_shortened_first(label: str, most: int, short: str) -> None:
    assert short_label(label, most) == short


@given(st.lists(st.text("abcdefgxyz", min_size=1), min_size=1).map(" ".join), st.integers(0, 40))
def test_a_label_keeps_its_words_and_fits_if_it_can(label: str, most: int) -> None:
    short = short_label(label, most)
    words = label.split(" ")
    shortened = short.split(" ")
    assert len(shortened) == len(words)
    for word, part in zip(words, shortened, strict=True):
        assert part == word or (part.endswith(".") and word.startswith(part[:-1]) and len(part) < len(word))
    least = sum(min(len(word), FEWEST + 1) for word in words) + len(words) - 1
    assert len(short) <= max(most, least)
    if len(label) <= most:
        assert short == label


@pytest.mark.parametrize(
    ("name", "most", "shown"),
    [
        ("car.obj", 7, "car.obj"),
        ("fender of the left door 12.obj", 16, "fender .. 12.obj"),
        ("abcdef", 5, "ab..f"),
        ("abcdef", 2, ".."),
        ("abcdef", 1, "."),
        ("abcdef", -3, ""),
    ],
)
def test_the_middle_of_a_long_name_is_left_out(name: str, most: int, shown: str) -> None:
    assert short_name(name, most) == shown
