from __future__ import annotations

import zlib

import pytest

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration
from ramtek_emu.monitor.pattern import pattern

EIGHT = Configuration(name="EIGHT_PLANES", elements=1280, lines=1024, planes=8)


@pytest.mark.parametrize(
    ("configuration", "number"), [(GMR_9300, 3233604340), (PRINCETON_9300, 2446932657), (EIGHT, 1842144940)]
)
def test_the_pattern_is_drawn_as_it_was(configuration: Configuration, number: int) -> None:
    # If the pattern changes on purpose, look at it, and copy the new number from the failure.
    assert zlib.crc32(pattern(configuration).tobytes()) == number
