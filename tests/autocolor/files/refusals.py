"""The refusals of all readers of files: tables of contents and sentences, and the runner of such a table."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.formats import read_mesh


def refusal(read: Callable[..., object], *arguments: object) -> str:
    """The sentences with which a reader refuses its arguments."""
    with pytest.raises(InputError) as caught:
        read(*arguments)
    return str(caught.value)


def is_read_or_refused(path: Path, data: bytes) -> bool:
    """Whether a mesh file with these bytes is read as a sound mesh, or refused by its name, soon."""
    path.write_bytes(data)
    begin = time.process_time()
    try:
        mesh = read_mesh({"file": path}).mesh
        sound = np.isfinite(mesh.coordinates).all() and mesh.node_numbers.max() < len(mesh.coordinates)
    except InputError as error:
        sound = all(problem.startswith(path.name) for problem in error.problems)
    return bool(sound) and time.process_time() - begin < 2


def swapped(text: str, old: str, new: str) -> bytes:
    """A text in which `old`, which it has once, is replaced."""
    assert text.count(old) == 1
    return text.replace(old, new).encode()


def refused(name: str, cases: Iterable[tuple[bytes, str]]) -> Callable[[Path, bytes, str], None]:
    """A test that a mesh file of this name is refused with its sentence, for each content and sentence."""

    @pytest.mark.parametrize(("data", "sentence"), cases)
    def test(tmp_path: Path, data: bytes, sentence: str) -> None:
        (tmp_path / name).write_bytes(data)
        assert refusal(read_mesh, {"file": tmp_path / name}) == sentence

    return test
