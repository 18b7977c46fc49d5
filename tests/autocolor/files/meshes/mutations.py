"""Damaged copies of a file, for the readers of mesh files."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport

SNIPPETS = (b"-1", b"0", b"99999999999", b"nan", b"1e999", b"\0", b"\n", b" ", b"x", b"4294967295", b"\xff")


def mutations(data: bytes, count: int = 200) -> Iterator[bytes]:
    """Copies of the data with bytes changed, cut out, doubled, or replaced by what readers dislike."""
    chance = random.Random(1983)
    for _ in range(count):
        mutant = bytearray(data)
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(mutant) + 1)
            end = min(len(mutant), at + chance.randint(1, 12))
            kind = chance.randrange(5)
            if kind == 0 and at < len(mutant):
                mutant[at] = chance.randrange(256)
            elif kind == 1:
                del mutant[at:end]
            elif kind == 2:
                mutant[at:at] = mutant[at:end]
            elif kind == 3:
                mutant[at:end] = chance.choice(SNIPPETS)
            else:
                del mutant[at:]
        yield bytes(mutant)


def changes(data: bytes, count: int = 200) -> Iterator[bytes]:
    """Copies of the data with bits turned over, bytes cut out or put in, and numbers replaced."""
    chance = np.random.default_rng(1983)
    for _ in range(count):
        changed = bytearray(data)
        for _ in range(chance.integers(1, 4)):
            at = int(chance.integers(len(changed)))
            kind = chance.integers(4)
            if kind == 0:
                changed[at] ^= 1 << int(chance.integers(8))
            elif kind == 1:
                del changed[at : at + int(chance.integers(1, 9))]
            elif kind == 2:
                changed[at:at] = chance.bytes(int(chance.integers(1, 9)))
            else:
                changed[at : at + 4] = chance.choice([b"\xff\xff\xff\xff", b"nan ", b"\0\0\xc0\x7f", b"9999"])
        yield bytes(changed)


def survives(read: Callable[[Path], MeshReport], path: Path, data: bytes, count: int = 200) -> None:
    """Assert that each damaged copy of a file is a mesh or is refused in short sentences."""
    for mutant in mutations(data, count):
        path.write_bytes(mutant)
        length = 1
        try:
            report = read(path)
        except InputError as error:
            length = len(str(error))
        else:
            assert len(report.mesh.node_numbers)
        assert 0 < length < 4000
