from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest

from autocolor.arrays import AnyArray
from autocolor.errors import InputError
from autocolor.files.meshes.npy import table_rows as room


@pytest.mark.parametrize("row", [0, 2, 3, 8])
@pytest.mark.parametrize("order", ["C", "F"])
def test_the_first_wrong_row_is_named_in_whichever_chunk_it_lies(
    monkeypatch: pytest.MonkeyPatch, row: int, order: Any
) -> None:
    monkeypatch.setattr(room, "ROWS_AT_ONCE", 3)
    table = np.zeros((9, 3), order=order)
    table[row:, 1] = np.nan
    with pytest.raises(InputError) as refusal:
        room.checked("nodes.npy", table, "coordinates must be finite", room.are_coordinates, "correct it")
    assert str(refusal.value) == (
        f"nodes.npy: coordinates must be finite, not [0.0, nan, 0.0] (row {row}, counted from 0); correct it"
    )


@pytest.mark.parametrize(
    ("numbers", "right"),
    [
        (np.array([0, 4]), True),
        (np.array([0, 5]), False),
        (np.array([-1, 0]), False),
        (np.array([2**63 + 1, 0], np.uint64), False),
        (np.array([-128, 0], np.int8), False),
    ],
)
def test_numbers_are_compared_in_their_own_type(numbers: AnyArray, right: bool) -> None:
    assert bool(room.within(5)(numbers[None]).all()) == right


@pytest.mark.parametrize(
    ("vector", "right"),
    [((0, 0, 1), True), ((0.6, 0.8, 0), True), ((0, 0, 1.1), False), ((0, 0, np.nan), False)],
)
def test_normals_must_have_the_length_of_one(vector: tuple[float, ...], right: bool) -> None:
    assert room.are_unit_vectors(np.array([vector], np.float32).T).tolist() == [right]


@pytest.mark.parametrize(
    ("table", "held"),
    [
        (np.zeros((5, 3), order="F"), True),
        (np.zeros((5, 3)), False),
        (np.zeros((5, 3), np.float32, order="F"), False),
        (np.zeros((5, 3), ">f8", order="F"), False),
        (np.zeros(5), True),
        (np.zeros(5, np.int8), False),
    ],
)
def test_only_what_rendering_does_not_read_as_it_is_is_copied(
    table: AnyArray, held: bool, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(room, "ROWS_AT_ONCE", 2)
    table[3] = 7
    with caplog.at_level(logging.INFO, "autocolor"):
        read = room.as_read("nodes.npy", table, np.float64)
    assert (read is table) == held
    assert read.dtype == np.float64
    assert read.T.flags.c_contiguous
    assert read.tolist() == table.tolist()
    assert ("nodes.npy: copied" in caplog.text) == (not held)


def test_a_table_of_another_shape_or_kind_is_refused() -> None:
    with pytest.raises(InputError) as refusal:
        room.is_shaped("parts.npy", np.zeros((4, 2)), "part numbers", 4, (0,))
    assert str(refusal.value) == (
        "parts.npy: the shape of part numbers must be (4,), not (4, 2); write it again"
    )
    with pytest.raises(InputError, match=r"must be \(rows, 4\) or \(rows, 3\), not \(2, 5\)"):
        room.is_shaped("polygons.npy", np.zeros((2, 5)), "a polygon table", None, (4, 3))
    with pytest.raises(InputError) as refusal:
        room.is_of("parts.npy", np.zeros(4), "part numbers", "iu")
    assert str(refusal.value) == "parts.npy: part numbers must be whole numbers, not float64; convert them"


@pytest.mark.parametrize("dtype", [np.float16, ">f2", np.float32, np.float64])
def test_coordinates_are_finite_in_any_precision(dtype: str | type[Any]) -> None:
    rows = np.array([[0, np.inf, -np.inf, np.nan, 1]] * 3, dtype)
    assert room.are_coordinates(rows).tolist() == [True, False, False, False, True]
