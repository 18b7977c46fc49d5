"""What picture files and table files have in common; their own tests damage whole files of theirs."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError
from autocolor.arrays import AnyArray
from autocolor.budget import MEMORY, allowing
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, read_array_file
from tests.autocolor.files.refusals import refusal
from tests.small import cube

KIND = ArrayFileKind("test file", "make it again", "test 2", {"rows": ("<i4", (None,))})
ROWS = {"rows": np.arange(3)}


@pytest.mark.parametrize(
    ("header", "members", "reason"),
    [
        ({"format": "test 3"}, ROWS, "its format must be 'test 2'"),
        ({}, {"rows": np.eye(2)}, "rows must be <i4 of shape (None,), not <i4 of (2, 2)"),
    ],
)
def test_another_format_and_another_type_are_refused(
    tmp_path: Path, header: dict[str, str], members: dict[str, AnyArray], reason: str
) -> None:
    path = tmp_path / "file"
    path.write_bytes(array_file_bytes(KIND, cube(), header, members))
    rule = "a test file must be whole and as autocolor wrote it"
    assert refusal(read_array_file, KIND, path) == f"file: {rule}, and it is not ({reason}); make it again"


def test_a_sparse_file_and_overlapping_members_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(array_file_bytes(KIND, cube(), {}, ROWS))
    os.truncate(path, 3 << 30)
    with pytest.raises(InputError, match=r"file: to read 3,221,225,472 bytes must take at most 4,000.0 MB "):
        read_array_file(KIND, path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("header.npy", bytes(1000))
        archive.filelist = archive.filelist * 9
    with pytest.raises(InputError, match="file: to read 9,000 bytes"), allowing(9000 / MEMORY):
        read_array_file(KIND, path)
