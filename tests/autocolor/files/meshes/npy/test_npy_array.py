from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autocolor.arrays import AnyArray
from autocolor.errors import InputError, MissingInputError
from autocolor.files.meshes.npy import npy_array as room
from autocolor.files.meshes.npy.npy_array import mapped, parsed_header

DTYPES = ("<f8", ">f8", "<f4", "<i4", "<u2", "|i1", ">i8", "<u8")


def saved(table: AnyArray) -> bytes:
    file = io.BytesIO()
    np.save(file, table)
    return file.getvalue()


@given(
    st.sampled_from(DTYPES),
    st.sampled_from([(0,), (1,), (5,), (0, 3), (1, 4), (7, 3), (6, 4), (9, 1)]),
    st.sampled_from("CF"),
)
def test_a_table_that_numpy_saved_is_mapped_with_its_numbers(
    tmp_path_factory: pytest.TempPathFactory, dtype: str, shape: tuple[int, ...], order: str
) -> None:
    count = int(np.prod(shape))
    table = np.arange(count).reshape(shape).astype(dtype, order="F" if order == "F" else "C")
    path = tmp_path_factory.mktemp("npy") / "table.npy"
    np.save(path, table)
    found = mapped(path)
    assert found.dtype == table.dtype
    assert found.tolist() == table.tolist()
    assert not found.flags.writeable
    if order == "F":
        assert found.T.flags.c_contiguous


def test_what_is_mapped_takes_no_memory_and_outlives_the_name_of_its_file(tmp_path: Path) -> None:
    path = tmp_path / "table.npy"
    np.save(path, np.arange(100_000.0))
    found = mapped(path)
    path.unlink()
    assert found.base is not None
    assert found.sum() == 99_999 * 50_000


@pytest.mark.parametrize(
    ("table", "found"),
    [
        (np.array(["a"]), "<U1"),
        (np.array([1 + 2j]), "<c16"),
        (np.zeros((2, 2, 2)), "(2, 2, 2)"),
        (np.array(3.0), "()"),
        (np.array([True]), "|b1"),
        (np.zeros(2, [("x", "<f8")]), "[('x', '<f8')]"),
        (np.array(["2026-01-01"], "M8[D]"), "<M8[D]"),
    ],
)
def test_what_is_no_table_of_numbers_is_refused(tmp_path: Path, table: AnyArray, found: str) -> None:
    np.save(tmp_path / "nodes.npy", table)
    with pytest.raises(InputError) as refusal:
        mapped(tmp_path / "nodes.npy")
    sentence = str(refusal.value)
    assert sentence.startswith(
        "nodes.npy: it must be an .npy file with a table of whole numbers or floating-point numbers, not"
    )
    assert found in sentence
    assert sentence.endswith("; write it with numpy.save")


def test_objects_are_never_unpickled(tmp_path: Path) -> None:
    np.save(tmp_path / "nodes.npy", np.array([{}], object), allow_pickle=True)
    with pytest.raises(InputError, match=r"it must be an \.npy file with a table"):
        mapped(tmp_path / "nodes.npy")


@pytest.mark.parametrize("change", [-1, -300, 1, 4096])
def test_a_file_of_another_size_than_its_header_says_is_refused(tmp_path: Path, change: int) -> None:
    data = saved(np.zeros((10, 3)))
    path = tmp_path / "nodes.npy"
    path.write_bytes(data[:change] if change < 0 else data + bytes(change))
    with pytest.raises(InputError) as refusal:
        mapped(path)
    if change > -240:
        assert str(refusal.value) == (
            "nodes.npy: a table of shape (10, 3) and type float64 must have 368 bytes, not"
            f" {368 + change:,}; write it again"
        )


def test_a_table_of_too_many_rows_is_refused_before_anything_is_mapped() -> None:
    head = saved(np.zeros(7)).replace(b"(7,), }" + b" " * 11, b"(999999999999,), }")
    with pytest.raises(
        InputError, match="must have at most 200,000,000 rows, not 999,999,999,999; divide it"
    ):
        parsed_header("nodes.npy", head)


def test_files_that_are_missing_or_no_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError):
        mapped(tmp_path / "nodes.npy")
    with pytest.raises(InputError, match="it must be a regular file, not a folder"):
        mapped(tmp_path)
    with pytest.raises(InputError, match="a file name must be valid"):
        mapped(tmp_path / "a\0b")
    (tmp_path / "empty.npy").write_bytes(b"")
    with pytest.raises(InputError, match=r"it must be an \.npy file"):
        mapped(tmp_path / "empty.npy")


@settings(max_examples=30)
@given(st.integers(0, 255))
def test_any_other_byte_in_the_header_is_refused_or_gives_a_table_of_the_same_size(
    tmp_path_factory: pytest.TempPathFactory, byte: int
) -> None:
    data = saved(np.asfortranarray(np.arange(12.0).reshape(4, 3)))
    path = tmp_path_factory.mktemp("npy") / "table.npy"
    read = 0
    for place in range(128):
        path.write_bytes(data[:place] + bytes([byte]) + data[place + 1 :])
        try:
            found = mapped(path)
        except InputError:
            continue
        assert found.nbytes == 96
        read += 1
    assert read < 128


def test_the_second_version_of_the_format_is_read_and_a_long_header_is_not() -> None:
    data = saved(np.zeros(3))
    second = b"\x93NUMPY\x02\x00" + (118).to_bytes(4, "little") + data[10:]
    assert parsed_header("a.npy", second[: 12 + 118]).shape == (3,)
    long = b"\x93NUMPY\x02\x00" + (1 << 31).to_bytes(4, "little") + data[10:]
    with pytest.raises(InputError):
        parsed_header("a.npy", long)
    assert room.LARGEST_HEADER >= 128
