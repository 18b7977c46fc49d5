from __future__ import annotations

from typing import Any

import pytest

from ramtek_emu import ConfigurationError, Timing


@pytest.mark.parametrize(
    ("rates", "sentence"),
    [
        ({"line": 0}, "line must be a whole number from 1 to 1000000000, not 0 (timing)"),
        ({"pixel": -1}, "pixel must be a whole number from 0 to 1000000000, not -1 (timing)"),
        ({"word": 0.5}, "word must be a whole number from 0 to 1000000000, not 0.5 (timing)"),
    ],
)
def test_rates_that_no_display_has_are_refused(rates: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        Timing(**rates)
    assert str(refusal.value) == f"{sentence}; give nanoseconds, lines or fields"


def test_a_field_of_the_default_rates_takes_a_thirtieth_of_a_second() -> None:
    timing = Timing()
    assert (480 + timing.blanked_lines) * timing.line == pytest.approx(1e9 / 30, rel=1e-4)
