from __future__ import annotations

import zlib

import pytest

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration
from ramtek_emu.monitor.pattern import pattern

EIGHT = Configuration(name="EIGHT_PLANES", elements=1280, lines=1024, planes=8)


@pytest.mark.parametrize(
    ("configuration", "number"), [(GMR_9300, 2928258339), (PRINCETON_9300, 1649409050), (EIGHT, 290906280)]
)
def test_the_pattern_is_drawn_as_it_was(configuration: Configuration, number: int) -> None:
    # If the pattern changes on purpose, look at it, and copy the new number from the failure.
    assert zlib.crc32(pattern(configuration).tobytes()) == number
