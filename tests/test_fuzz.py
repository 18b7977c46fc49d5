"""Every reader of bytes from outside, with a little of the damage that `python -m tests.fuzz` does."""

from __future__ import annotations

import os
import random
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError, Mesh
from autocolor.errors import AutocolorError
from autocolor.rendering import MOST_FREED
from tests import fuzz, fuzz_targets
from tests.fuzz_targets import TARGETS, Arena, Target, fault_of_mesh, formats_without_targets
from tests.mutations import BY_HAND, damaged, mutated

ROOT = Path(__file__).parent
COUNT = 120

QUICK = [name for name in TARGETS if name not in ("foreign", "port", "show")]
"""The targets that do not wait. The others have tests of their own."""


@pytest.fixture
def arena(tmp_path: Path) -> Iterator[Arena]:
    arena = Arena(tmp_path)
    yield arena
    arena.close()


@pytest.mark.parametrize("name", QUICK)
def test_damaged_input_is_read_or_is_refused_in_sentences(name: str, arena: Arena) -> None:
    target, chance = TARGETS[name], random.Random(name)
    samples = list(target.samples())
    for number in range(COUNT):
        data = damaged(chance.choice(samples), chance, samples)[: target.largest]
        fault = arena.fault_of(target, data)
        assert fault is None, f"{name}, number {number}: {fault.story}"


@pytest.mark.parametrize("name", QUICK)
def test_what_is_damaged_was_whole(name: str, arena: Arena) -> None:
    for sample in TARGETS[name].samples():
        arena.files_of(TARGETS[name], sample)
        assert TARGETS[name].run(sample) == ""


@pytest.mark.parametrize("path", sorted((ROOT / "fuzz_cases").glob("*.bin")), ids=lambda path: path.stem)
def test_an_input_that_had_a_fault_has_none(path: Path, arena: Arena) -> None:
    fault = arena.fault_of(TARGETS[path.name.partition("-")[0]], path.read_bytes())
    assert fault is None, fault.story


def test_there_is_a_target_for_every_mesh_format() -> None:
    pytest.importorskip("meshio")
    pytest.importorskip("networkx")
    pytest.importorskip("lxml")
    assert formats_without_targets() == []


def test_mutations_are_the_same_again_and_differ_from_each_other() -> None:
    seed = BY_HAND[0]
    one = [mutated(seed, number).files for number in range(50)]
    assert one == [mutated(seed, number).files for number in range(50)]
    assert one[0] == seed.files
    assert len({tuple(files.values()) for files in one}) > 40


@pytest.mark.parametrize(
    ("field", "value", "fault"),
    [
        ("coordinates", np.full((3, 3), np.inf), "a coordinate"),
        ("node_numbers", np.array([[0, 1, 3, 3]]), "a node number"),
        ("part_numbers", np.array([1]), "a part number"),
    ],
)
def test_a_mesh_that_breaks_its_promise_is_a_fault(field: str, value: object, fault: str) -> None:
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    assert fault_of_mesh(mesh) == ""
    object.__setattr__(mesh, field, value)
    assert fault_of_mesh(mesh).startswith(fault)


def raises(error: Exception) -> Callable[[bytes], str]:
    def run(_: bytes) -> str:
        raise error

    return run


def warns(_: bytes) -> str:
    warnings.warn("careless", RuntimeWarning, stacklevel=1)
    return ""


def leaves_a_file(_: bytes) -> str:
    Path("left").touch()
    return ""


def changes_its_file(_: bytes) -> str:
    Path("given").write_bytes(b"other")
    return ""


def leaves_a_descriptor(_: bytes) -> str:
    os.open("given", os.O_RDONLY)
    return ""


def takes_memory(_: bytes) -> str:
    # More than the process may keep of what earlier tests freed.
    return "" if np.ones(MOST_FREED + 1, np.uint8).all() else "not ones"


@pytest.mark.parametrize(
    ("run", "kind"),
    [
        (lambda _: "", None),
        (raises(InputError("given: too short")), None),
        (lambda _: "an odd result: 7", "an odd result"),
        (raises(InputError("it is too short")), "a refusal that names no file"),
        (raises(InputError("given: " + "x" * 5000)), "a refusal that cannot be read"),
        (raises(InputError(["given: wrong"] * 200)), "a refusal of too few or too many sentences"),
        (raises(AutocolorError("given: wrong")), "a refusal that says the program is at fault"),
        (raises(KeyError("given")), "KeyError"),
        (warns, "RuntimeWarning"),
        (leaves_a_file, "changed files"),
        (changes_its_file, "changed files"),
        (leaves_a_descriptor, "left: ['descriptors']"),
        (takes_memory, "too much memory"),
    ],
)
def test_the_oracle_sees_what_goes_wrong(run: Callable[[bytes], str], kind: str | None, arena: Arena) -> None:
    fault = arena.fault_of(Target(lambda: [], run, ("given",)), b"data")
    assert (fault is None) == (kind is None)
    assert fault is None or fault.kind.startswith(kind or "")


def test_slow_input_is_a_fault(arena: Arena, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fuzz_targets, "MOST_SECONDS", 0.0)
    fault = arena.fault_of(Target(lambda: [], lambda _: "" if sum(range(10**5)) else "no sum"), b"")
    assert fault is not None
    assert fault.kind == "too slow"


def test_the_first_input_of_a_kind_of_fault_is_shortened_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = Target(
        lambda: [b"a" * 40, b"b" * 20 + b"x" + b"b" * 30], lambda data: "an x" if b"x" in data else ""
    )
    monkeypatch.setitem(TARGETS, "fake", fake)
    monkeypatch.chdir(tmp_path)

    def run_here(name: str, folder: Path, keep: Path, *_: object) -> str:
        fuzz.attack_here(name, folder, keep, 0.0, 1, plain=True)
        return ""

    monkeypatch.setattr(fuzz, "run_child", run_here)
    attack = fuzz.attack("fake", tmp_path / "found", 60, 1, plain=True)
    assert (attack.tried, attack.faults, attack.kinds) == (2, 1, ("an x",))
    assert [path.read_bytes() for path in (tmp_path / "found").glob("fake-*.bin")] == [b"x"]


def test_the_input_of_which_a_process_dies_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def run_child(_: str, folder: Path, *__: object) -> str:
        (folder / "output").write_text("killed")
        progress = fuzz.Progress(folder / "progress")
        if progress.faults:
            progress.finish()
            return ""
        progress.begin(b"deadly")
        return "the process ended with -9"

    monkeypatch.setattr(fuzz, "run_child", run_child)
    attack = fuzz.attack("fake", tmp_path, 60, 1)
    assert (attack.tried, attack.faults, attack.kinds) == (1, 1, ("the process ended with -9",))
    assert [path.read_bytes() for path in tmp_path.glob("fake-*.bin")] == [b"deadly"]
