"""What picture files and table files have in common; their own tests damage whole files of theirs."""

from __future__ import annotations

import dataclasses
import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError
from autocolor.budget import MEMORY, allowing
from autocolor.files.array_file import (
    ArrayFileKind,
    Series,
    array_file_bytes,
    read_array_file,
    scalar_members,
    scalar_rows,
    scalars_of,
)
from autocolor.scene.scalar import MeshScalar

KIND = ArrayFileKind(
    noun="test file",
    advice="make it again",
    formats=("test 2", "test 1"),
    keys=frozenset(("name",)),
    arrays={"numbers": ("<i4", 2)},
)
NUMBERS = {"numbers": np.arange(6).reshape(2, 3)}


def test_the_header_and_the_arrays_are_read_back(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": "ö"}, NUMBERS))
    header, arrays = read_array_file(KIND, tmp_path / "file")
    assert header == {"format": "test 2", "name": "ö"}
    assert arrays.keys() == {"numbers"}
    assert arrays["numbers"].tolist() == [[0, 1, 2], [3, 4, 5]]
    assert arrays["numbers"].dtype == np.int32


def test_numpy_opens_it(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": ""}, NUMBERS))
    with np.load(tmp_path / "file") as archive:
        assert archive["numbers"].tolist() == NUMBERS["numbers"].tolist()


def test_the_same_values_give_the_same_bytes() -> None:
    assert array_file_bytes(KIND, {"name": "a"}, NUMBERS) == array_file_bytes(KIND, {"name": "a"}, NUMBERS)


def test_an_older_format_is_read_and_any_other_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": "", "format": "test 1"}, NUMBERS))
    assert read_array_file(KIND, tmp_path / "file").header["format"] == "test 1"
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": "", "format": "test 3"}, NUMBERS))
    with pytest.raises(InputError, match=r"file, header: its format must be 'test 2'; make it"):
        read_array_file(KIND, tmp_path / "file")


WITH_SERIES = dataclasses.replace(
    KIND,
    formats=("test 3",),
    plain=("test 2", "test 1"),
    series={"rows": Series("row", ("<f8", 1), most=3)},
)


@pytest.mark.parametrize("count", [0, 1, 3])
def test_a_series_has_as_many_arrays_as_the_header_tells(tmp_path: Path, count: int) -> None:
    series = {f"row_{number}": np.full(number, number) for number in range(count)}
    header = {"name": "", "rows": list(range(count))}
    (tmp_path / "file").write_bytes(array_file_bytes(WITH_SERIES, header, {**NUMBERS, **series}))
    again = read_array_file(WITH_SERIES, tmp_path / "file")
    assert again.header == {"format": "test 3", **header}
    assert again.arrays.keys() == {"numbers", *series}
    for name, values in series.items():
        assert again.arrays[name].dtype == np.float64
        assert again.arrays[name].tolist() == values.tolist()


def test_a_plain_format_has_no_series(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": ""}, NUMBERS))
    assert read_array_file(WITH_SERIES, tmp_path / "file").arrays.keys() == {"numbers"}
    (tmp_path / "file").write_bytes(array_file_bytes(KIND, {"name": "", "rows": []}, NUMBERS))
    with pytest.raises(InputError, match=r"file, header: it must have exactly the keys of its format"):
        read_array_file(WITH_SERIES, tmp_path / "file")


@pytest.mark.parametrize("rows", [None, {}, "ab", 3, [0] * 4])
def test_a_series_that_is_no_short_list_is_refused(tmp_path: Path, rows: object) -> None:
    plain = dataclasses.replace(KIND, formats=("test 3",))
    (tmp_path / "file").write_bytes(array_file_bytes(plain, {"name": "", "rows": rows}, NUMBERS))
    with pytest.raises(InputError, match=r"file, header: rows must be a list of at most 3 rows, not"):
        read_array_file(WITH_SERIES, tmp_path / "file")


@pytest.mark.parametrize("count", [1, 3])
def test_a_series_with_other_members_than_the_header_tells_is_refused(tmp_path: Path, count: int) -> None:
    header = {"name": "", "rows": [0, 0]}
    rows = {f"row_{number}": np.zeros(2) for number in range(count)}
    types = {**KIND.arrays, **{name: ("<f8", 1) for name in rows}}
    plain = dataclasses.replace(KIND, formats=("test 3",), arrays=types)
    (tmp_path / "file").write_bytes(array_file_bytes(plain, header, {**NUMBERS, **rows}))
    with pytest.raises(InputError, match="must be whole and as autocolor wrote it, not with members like"):
        read_array_file(WITH_SERIES, tmp_path / "file")


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"PK\x03\x04",
        array_file_bytes(KIND, {"name": ""}, NUMBERS)[:-30],
        array_file_bytes(KIND, {"name": ""}, NUMBERS).replace(b"(2, 3)", b"(9, 9)"),
    ],
)
def test_a_damaged_file_is_refused_and_told_by_its_kind(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "file").write_bytes(data)
    with pytest.raises(InputError, match=r"a test file must be whole .*; make it again"):
        read_array_file(KIND, tmp_path / "file")


def test_a_sparse_file_and_overlapping_members_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(array_file_bytes(KIND, {"name": ""}, NUMBERS))
    os.truncate(path, 3 << 30)
    with pytest.raises(InputError, match=r"file: to read 3,221,225,472 bytes must take at most 4,000.0 MB "):
        read_array_file(KIND, path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("header.npy", bytes(1000))
        archive.filelist = archive.filelist * 9
    with pytest.raises(InputError, match="file: to read 9,000 bytes"), allowing(9000 / MEMORY):
        read_array_file(KIND, path)


def test_scalars_come_back_from_their_rows_and_members() -> None:
    scalars = (MeshScalar("stress", np.array([1.0, np.nan])), MeshScalar("load", np.zeros(3), "polygon"))
    rows, members = scalar_rows(scalars), scalar_members(scalars)
    assert rows == [{"name": "stress", "of": "node"}, {"name": "load", "of": "polygon"}]
    assert list(members) == ["mesh_scalar_0", "mesh_scalar_1"]
    again = scalars_of({"mesh_scalars": rows}, members)
    assert [(each.name, each.of) for each in again] == [("stress", "node"), ("load", "polygon")]
    assert np.array_equal(again[0].values, scalars[0].values, equal_nan=True)


def test_a_header_of_before_there_were_scalars_has_none() -> None:
    assert scalars_of({}, {}) == ()


@pytest.mark.parametrize("row", [3, None, [], {}, {"name": "a"}, {"name": "a", "of": "node", "more": 1}])
def test_a_row_of_other_keys_is_refused(row: object) -> None:
    with pytest.raises(InputError, match=r"mesh_scalars\[1\] must be a table of name and of, not"):
        scalars_of({"mesh_scalars": [row]}, {"mesh_scalar_0": np.zeros(1)})
