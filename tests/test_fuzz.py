"""A little of what `python -m tests.attacks` does, and the inputs that had a fault once."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from autocolor.files.foreign.reader import FOREIGN
from autocolor.files.formats import MESH_FORMATS
from tests.attack_targets import READERS
from tests.attacks import Arena, main

CASES = sorted((Path(__file__).parent / "fuzz_cases").glob("*.bin"))
reading = cache(lambda name: READERS[name]())


@pytest.fixture
def arena(tmp_path: Path) -> Iterator[Arena]:
    arena = Arena(tmp_path)
    yield arena
    arena.close()


@pytest.mark.parametrize("name", READERS)
def test_samples_are_read_and_damaged_input_is_read_or_refused(name: str, arena: Arena) -> None:
    trial = reading(name)
    for sample in trial.samples if name != "show" else ():
        trial.write(sample)
        assert not trial.run(sample)
    for number in range(4 if name == "show" else 40):
        fault = arena.fault_of(trial, random.Random(f"{name} {number}"))
        assert fault is None, f"{name}, number {number}: {fault.story}"


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_an_input_that_had_a_fault_has_none(path: Path, arena: Arena) -> None:
    assert reading(path.name.partition("-")[0]).fault_of(path.read_bytes()) == ""


def test_there_is_a_reader_for_every_mesh_format() -> None:
    formats = {each.name for each in MESH_FORMATS} - {each.name for each in FOREIGN}
    assert {name.lower().removeprefix("movie.") for name in formats} <= set(READERS)


@pytest.mark.thorough
@pytest.mark.parametrize(
    "name",
    ["reads/obj", "kills/npy tables", "signals/printing, ramtek_emu list", "uses/screens, car", "uses/unix"],
)
def test_an_attempt_of_each_kind_of_attack_finds_nothing(name: str, tmp_path: Path) -> None:
    assert main([name, "--seed", "1", "--number", "0", "--keep", str(tmp_path)]) == 0
