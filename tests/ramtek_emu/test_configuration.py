from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, ConfigurationError, EntryFormat, Ramtek9300


def test_the_default_is_the_display_of_the_paper() -> None:
    display = Ramtek9300()
    assert display.configuration is GMR_9300
    assert display.words.shape == (480, 640)
    assert display.entries.shape == (1024, 3)
    assert display.field().shape == (480, 640, 3)
    assert GMR_9300.largest_word == 1023


def test_the_princeton_display_is_the_strict_9300() -> None:
    assert PRINCETON_9300.entry_format is EntryFormat.WORD_12
    assert not PRINCETON_9300.extended
    assert Ramtek9300(PRINCETON_9300).words.shape == (512, 640)


@pytest.mark.parametrize(
    ("sizes", "sentence"),
    [
        ({"lines": 0}, "lines must be a whole number from 1 to 4096, not 0"),
        ({"planes": 17}, "planes must be a whole number from 1 to 16, not 17"),
        ({"visible_lines": 11}, "visible_lines must be a whole number from 1 to 10, not 11"),
        ({"entries": 1000}, "entries must be 256, 512, 1024, 2048 or 4096, not 1000"),
    ],
)
def test_sizes_that_no_display_has_are_refused(sizes: dict[str, Any], sentence: str) -> None:
    square = Configuration(name="SQUARE", elements=10, lines=10, planes=10)
    with pytest.raises(ConfigurationError) as refusal:
        replace(square, **sizes)
    assert str(refusal.value).startswith(sentence)
