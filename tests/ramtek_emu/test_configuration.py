from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ramtek_emu import GMR_9300, Configuration, ConfigurationError, EntryFormat, Ramtek9300, Timing
from ramtek_emu.configuration import CONFIGURATIONS, configuration_named
from ramtek_emu.snapshot import display_of, snapshot_bytes
from tests.ramtek_emu.strategies import SMALL
from tests.tables import call, refused


@pytest.mark.parametrize("configuration", CONFIGURATIONS.values(), ids=str)
def test_a_display_is_made_by_the_name_of_its_configuration(configuration: Configuration) -> None:
    name = configuration.name
    for written in (name, name.lower(), name.replace("_", "-"), name.title()):
        assert configuration_named(written) is configuration
    display = Ramtek9300(name.lower())
    assert display.configuration is configuration
    assert display.words.shape == (configuration.lines, configuration.elements)
    assert configuration.largest_word == (1 << configuration.planes) - 1
    # It is shown as Python that makes it.
    assert (
        eval(repr(configuration), {"Configuration": Configuration, "EntryFormat": EntryFormat})
        == configuration
    )


def test_the_default_is_the_display_of_the_paper() -> None:
    display = Ramtek9300()
    assert display.configuration is GMR_9300
    assert (GMR_9300.elements, GMR_9300.lines, GMR_9300.planes, GMR_9300.entries) == (640, 480, 10, 1024)
    assert display.field().shape == (480, 640, 3)


def test_a_field_of_the_default_rates_takes_a_thirtieth_of_a_second() -> None:
    timing = Timing()
    assert (480 + timing.blanked_lines) * timing.line == pytest.approx(1e9 / 30, rel=1e-4)


@pytest.mark.parametrize(
    ("sizes", "sentence"),
    [
        ({"lines": 0}, "lines must be a whole number from 1 to 4096, not 0"),
        ({"elements": 4097}, "elements must be a whole number from 1 to 4096, not 4097"),
        ({"planes": 17}, "planes must be a whole number from 1 to 16, not 17"),
        ({"visible_lines": 10}, "visible_lines must be a whole number from 1 to 9, not 10"),
        ({"entries": 1000}, "entries must be 256, 512, 1024, 2048 or 4096, not 1000"),
        ({"lines": 10.0}, "lines must be a whole number from 1 to 4096, not 10.0"),
        ({"entry_format": "WORD_12"}, "entry_format must be an EntryFormat, not 'WORD_12'"),
        ({"monochrome": 1}, "monochrome must be True or False, not 1"),
        ({"timing": 5}, "timing must be a Timing or None, not 5"),
        ({"name": 5}, "name must be a str, not 5"),
    ],
)
def test_sizes_that_no_display_has_are_refused(sizes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        replace(SMALL, **sizes)
    assert str(refusal.value).startswith(sentence)


def test_the_largest_and_the_least_sizes_are_taken() -> None:
    for sizes in ({"lines": 4096, "planes": 16}, {"elements": 4096, "planes": 1}, {"visible_lines": 9}):
        assert replace(SMALL, **sizes) != SMALL  # type: ignore[arg-type]
    numbers: Any = np.array([40, 1, 256])
    made = Configuration(name="SMALL", elements=numbers[0], lines=numbers[1], planes=10, entries=numbers[2])
    assert made == Configuration(name="SMALL", elements=40, lines=1, planes=10, entries=256)
    assert display_of(snapshot_bytes(Ramtek9300(made))).configuration == made


NAMES = ", ".join(sorted(CONFIGURATIONS))
ADVICE = "give nanoseconds, lines or fields"
test_what_is_refused = refused(
    call,
    [
        (
            lambda: Ramtek9300("ncar"),
            f"a configuration must be one of {NAMES}, not 'ncar'; did you mean NCAR_9460?",
        ),
        (lambda: Ramtek9300(""), f"a configuration must be one of {NAMES}, not ''; choose one of them"),
        (
            lambda: Ramtek9300(9300),  # type: ignore[arg-type]
            f"a configuration must be a Configuration or the name of one, not 9300; choose one of {NAMES}",
        ),
        (
            lambda: Timing(line=0),
            f"line must be a whole number from 1 to 1000000000, not 0 (timing); {ADVICE}",
        ),
        (
            lambda: Timing(pixel=-1),
            f"pixel must be a whole number from 0 to 1000000000, not -1 (timing); {ADVICE}",
        ),
        (
            lambda: Timing(word=0.5),  # type: ignore[arg-type]
            f"word must be a whole number from 0 to 1000000000, not 0.5 (timing); {ADVICE}",
        ),
    ],
)
