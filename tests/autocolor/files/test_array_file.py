"""What picture files and table files have in common; their own tests damage whole files of theirs."""

from __future__ import annotations

import dataclasses
import os
import tempfile
import zipfile
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from autocolor import InputError
from autocolor.budget import MEMORY, allowing
from autocolor.files.array_file import (
    ArrayFile,
    ArrayFileKind,
    Series,
    array_file_bytes,
    read_array_file,
)
from tests.tables import refused

KIND = ArrayFileKind(
    noun="test file",
    advice="make it again",
    formats=("test 2", "test 1"),
    keys=frozenset(("name",)),
    arrays={"numbers": ("<i4", 2)},
    series={"rows": Series("row", ("<f8", 1), most=3)},
)
NUMBERS = {"numbers": np.arange(6).reshape(2, 3)}


def content(arrays: int, /, **header: Any) -> bytes:
    """The bytes of a file with some arrays of the series, whatever its header says of them."""
    series = {f"row_{number}": np.full(number, number) for number in range(arrays)}
    types = {**KIND.arrays, **dict.fromkeys(series, ("<f8", 1))}
    plain = dataclasses.replace(KIND, arrays=types, series={})
    return array_file_bytes(plain, {"name": "ö", **header}, {**NUMBERS, **series})


def read(data: bytes) -> ArrayFile:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "file")
        path.write_bytes(data)
        return read_array_file(KIND, path)


WHOLE = "file: a test file must be whole and as autocolor wrote it, and it is not"

test_what_is_refused = refused(
    read,
    [
        (content, f"{WHOLE} ({reason}); make it again")
        for content, reason in (
            (content(0, format="test 3"), "its format must be 'test 2'"),
            (content(0, more=1), "its header must have exactly the keys of its format"),
            *(
                (content(0, rows=rows), f"rows must be a list of at most 3 rows, not {rows!r}")
                for rows in cast("tuple[object, ...]", (None, {}, "ab", 3, [0] * 4))
            ),
            *(
                (content(count, rows=[0, 0]), "its members are 'header.npy', 'numbers.npy', 'row_0.npy'")
                for count in (1, 3)
            ),
        )
    ],
)


def test_a_sparse_file_and_overlapping_members_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(content(0, rows=[]))
    os.truncate(path, 3 << 30)
    with pytest.raises(InputError, match=r"file: to read 3,221,225,472 bytes must take at most 4,000.0 MB "):
        read_array_file(KIND, path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("header.npy", bytes(1000))
        archive.filelist = archive.filelist * 9
    with pytest.raises(InputError, match="file: to read 9,000 bytes"), allowing(9000 / MEMORY):
        read_array_file(KIND, path)
