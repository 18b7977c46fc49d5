"""Every reader, with damaged copies of a small file of its format: a mesh, or a refusal, and nothing else."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh
from tests.mutations import BY_HAND, Seed, fault_of_mesh, formats_without_seeds, mutated, read_fresh, seeds

COUNT = 200


@pytest.mark.parametrize("seed", list(seeds()), ids=lambda seed: seed.name)
def test_a_damaged_file_is_a_mesh_or_is_refused_in_sentences(seed: Seed, tmp_path: Path) -> None:
    kinds = set()
    for number in range(COUNT + 1):
        outcome = read_fresh(mutated(seed, number), tmp_path / "read")
        assert not outcome.fault, f"{seed.name}, mutation {number}: {outcome.kind}, {outcome.fault}"
        kinds.add(outcome.kind)
    # The damage matters, and does not always matter.
    assert kinds == {"mesh", "refused"}


@pytest.mark.parametrize("seed", list(seeds()), ids=lambda seed: seed.name)
def test_what_is_damaged_was_whole(seed: Seed, tmp_path: Path) -> None:
    assert read_fresh(seed, tmp_path / "read").kind == "mesh"


def test_there_is_a_sample_of_every_mesh_format() -> None:
    assert formats_without_seeds() == []


def test_mutations_are_the_same_again_and_differ_from_each_other() -> None:
    seed = BY_HAND[0]
    one = [mutated(seed, number).files for number in range(50)]
    assert one == [mutated(seed, number).files for number in range(50)]
    assert one[0] == seed.files
    assert len({tuple(files.values()) for files in one}) > 40


def test_a_mesh_that_breaks_its_promise_would_be_told() -> None:
    broken = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    assert fault_of_mesh(broken) == ""
    for name, value, fault in (
        ("coordinates", np.full((3, 3), math.inf), "a coordinate"),
        ("node_numbers", np.array([[0, 1, 3, 3]]), "a node number"),
        ("part_numbers", np.array([1]), "a part number"),
    ):
        other = Mesh(np.eye(3), np.array([[0, 1, 2]]))
        object.__setattr__(other, name, value)
        assert fault_of_mesh(other).startswith(fault)
