from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import ramtek_emu
from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, ConfigurationError, EntryFormat, Ramtek9300
from ramtek_emu.configuration import CONFIGURATIONS, configuration_named
from ramtek_emu.snapshot import display_of, snapshot_bytes


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
        ({"lines": True}, "lines must be a whole number from 1 to 4096, not True"),
        ({"lines": 10.0}, "lines must be a whole number from 1 to 4096, not 10.0"),
        ({"entry_format": "WORD_12"}, "entry_format must be an EntryFormat, not 'WORD_12'"),
        ({"monochrome": 1}, "monochrome must be True or False, not 1"),
        ({"timing": 5}, "timing must be a Timing or None, not 5"),
        ({"name": 5}, "name must be a str, not 5"),
    ],
)
def test_sizes_that_no_display_has_are_refused(sizes: dict[str, Any], sentence: str) -> None:
    square = Configuration(name="SQUARE", elements=10, lines=10, planes=10)
    with pytest.raises(ConfigurationError) as refusal:
        replace(square, **sizes)
    assert str(refusal.value).startswith(sentence)


def test_sizes_may_be_numbers_of_numpy() -> None:
    sizes: Any = np.array([40, 30, 256])
    made = Configuration(name="SMALL", elements=sizes[0], lines=sizes[1], planes=10, entries=sizes[2])
    assert made == Configuration(name="SMALL", elements=40, lines=30, planes=10, entries=256)
    assert type(made.elements) is int
    assert display_of(snapshot_bytes(Ramtek9300(made))).configuration == made


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_a_display_is_made_by_the_name_of_its_configuration(name: str) -> None:
    for written in (name, name.lower(), name.replace("_", "-"), name.title()):
        assert configuration_named(written) is CONFIGURATIONS[name]
    assert Ramtek9300(name.lower()).configuration is getattr(ramtek_emu, name)


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("ncar", "did you mean NCAR_9460?"),
        ("gmr 9300", "did you mean GMR_9300?"),
        ("PRINCETOWN", "did you mean PRINCETON_9300?"),
        ("vt100", "choose one of them"),
        ("", "choose one of them"),
    ],
)
def test_an_unknown_configuration_is_answered_with_all_names_and_the_nearest(name: str, advice: str) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        Ramtek9300(name)
    assert str(refusal.value) == (
        "a configuration must be one of GMR_9300, JPL_9460, NCAR_9460, PRINCETON_9300, "
        f"not {name!r}; {advice}"
    )


@pytest.mark.parametrize("value", [None, 9300, b"GMR_9300"])
def test_a_configuration_must_be_a_configuration_or_a_name(value: Any) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        Ramtek9300(value)
    assert str(refusal.value).startswith(
        f"a configuration must be a Configuration or the name of one, not {value!r}; choose one of GMR_9300, "
    )


@pytest.mark.parametrize(
    "configuration", CONFIGURATIONS.values(), ids=lambda configuration: configuration.name
)
def test_a_configuration_is_shown_as_python_that_makes_it(configuration: Configuration) -> None:
    names = {"Configuration": Configuration, "EntryFormat": EntryFormat}
    assert eval(repr(configuration), names) == configuration
