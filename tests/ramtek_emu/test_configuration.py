from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ramtek_emu import FAMILY, GMR_9300, Configuration, Ramtek9300, Timing
from ramtek_emu.configuration import CONFIGURATIONS
from ramtek_emu.processor.processor import Status
from ramtek_emu.snapshot import display_of, snapshot_bytes
from tests.ramtek_emu.recorded_streams import words
from tests.ramtek_emu.strategies import SMALL
from tests.tables import refused


@pytest.mark.parametrize("configuration", CONFIGURATIONS.values(), ids=str)
def test_a_display_is_made_by_the_name_of_its_configuration(configuration: Configuration) -> None:
    name = configuration.name
    for written in (name, name.lower(), name.replace("_", "-"), name.title()):
        display = Ramtek9300(written)
        assert display.configuration is configuration
    assert display.words.shape == (configuration.lines, configuration.elements)
    in_gray = Ramtek9300(f"{name}-monochrome").configuration
    assert in_gray == replace(configuration, monochrome=True) != configuration


def test_the_paper_s_display_takes_what_a_9300_takes_and_family_what_all_members_take() -> None:
    assert Ramtek9300().configuration is GMR_9300
    assert replace(GMR_9300, name="FAMILY", extended=True) == FAMILY
    # Illegal words, and what follows is executed.
    for text, foreign in (
        ("2600 0101", "ZOOM"),
        ("0804 0008 FFFF 0000", "the second operand flag word"),
        ("1300", "PUSHE"),
    ):
        for name, status in (("GMR_9300", Status.READY | Status.ILLEGAL), ("FAMILY", Status.READY)):
            display = Ramtek9300(name)
            display.send(words(f"{text} 0902 0044 5 3 3 3 3"))
            assert (display.status, display.words[3, 3]) == (status, 5)
            assert copy.deepcopy(display).processor.foreign == (foreign if name == "GMR_9300" else None)


def test_the_largest_and_the_least_sizes_are_taken() -> None:
    for sizes in ({"lines": 4096, "planes": 16}, {"elements": 4096, "planes": 1}, {"visible_lines": 9}):
        assert replace(SMALL, **sizes) != SMALL  # type: ignore[arg-type]
    numbers: Any = np.array([40, 1, 256])
    made = Configuration(name="SMALL", elements=numbers[0], lines=numbers[1], planes=10, entries=numbers[2])
    assert made == Configuration(name="SMALL", elements=40, lines=1, planes=10, entries=256)
    # Snapshots of earlier versions have a GMR_9300 with all instructions.
    for configuration in (made, replace(GMR_9300, extended=True)):
        assert display_of(snapshot_bytes(Ramtek9300(configuration))).configuration == configuration


NAMES = "FAMILY, GMR_9300, JPL_9460, NCAR_9460, PRINCETON_9300"
test_what_no_display_is_called = refused(
    Ramtek9300,
    [
        ("ncar", f"a configuration must be one of {NAMES}, not 'ncar'; choose one of them"),
    ],
)
SIZE = "{} of SMALL must be a whole number from {} to {}, not {}; choose another size".format
test_what_no_display_has = refused(
    lambda sizes: replace(SMALL, **sizes),
    [
        ({"lines": 0}, SIZE("lines", 1, 4096, 0)),
        ({"elements": 1.0}, SIZE("elements", 1, 4096, 1.0)),
        ({"visible_lines": 10}, SIZE("visible_lines", 1, 9, 10)),
        ({"entries": 1000}, "entries of SMALL must be a power of 2, not 1000; choose another size"),
        ({"monochrome": 1}, "monochrome of a display must be bool, not 1; choose another value"),
        ({"timing": 5}, "timing of a display must be Timing or None, not 5; choose another value"),
    ],
)
RATE = "must be a whole number from {} to 1000000000, not {} (timing); give nanoseconds, lines or fields"
test_what_no_timing_has = refused(
    lambda rates: Timing(**rates),
    [({"line": 0}, f"line {RATE.format(1, 0)}"), ({"pixel": -1}, f"pixel {RATE.format(0, -1)}")],
)
