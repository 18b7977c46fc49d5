from __future__ import annotations

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.stl.binary import TRIANGLE, has_binary_size, read_binary

CORNERS = np.arange(18, dtype=np.float32).reshape(2, 3, 3)


def binary(corners: object = CORNERS, count: int | None = None, begin: bytes = b"") -> bytes:
    table = np.zeros(len(np.asarray(corners)), TRIANGLE)
    table["normal"] = np.nan
    table["corners"] = corners
    table["attribute"] = 65535
    return begin.ljust(80) + (len(table) if count is None else count).to_bytes(4, "little") + table.tobytes()


def refusal(data: bytes) -> str:
    with pytest.raises(InputError) as caught:
        read_binary(data, "a.stl")
    return str(caught.value)


def test_corners_are_read_and_normals_and_attributes_are_not() -> None:
    corners, skipped = read_binary(binary(), "a.stl")
    assert np.array_equal(corners, CORNERS.reshape(6, 3))
    assert corners.dtype == np.float32
    assert skipped == ()


def test_a_binary_file_is_told_by_its_size() -> None:
    assert has_binary_size(binary(begin=b"solid"))
    assert has_binary_size(binary(np.empty((0, 3, 3))))
    assert not has_binary_size(binary() + b"x")
    assert not has_binary_size(binary()[:-1])
    assert not has_binary_size(b"")


def test_bytes_after_the_last_triangle_are_counted() -> None:
    corners, skipped = read_binary(binary(count=1), "a.stl")
    assert len(corners) == 3
    assert skipped == ("skipped bytes after the last triangle: 50",)


def test_a_file_cut_short_is_refused_before_anything_is_made() -> None:
    assert refusal(binary()[:80]) == (
        "a.stl: a binary STL file must have at least 84 bytes, not 80; it is cut short, export it again"
    )
    assert refusal(binary(count=2**32 - 1)) == (
        "a.stl: a binary STL file of 4,294,967,295 triangles must have 214,748,364,834 bytes, not 184; it is"
        " cut short or of another format, export it again"
    )


@pytest.mark.parametrize(("number", "shown"), [(np.nan, "nan"), (-np.inf, "-inf"), (2e30, "2e+30")])
def test_coordinates_that_are_no_numbers_are_refused(number: float, shown: str) -> None:
    corners = CORNERS.copy()
    corners[1, 2, 0] = number
    assert refusal(binary(corners)) == (
        f"a.stl, facet 2: a coordinate must be a finite number of at most 1e30 in size, not {shown};"
        " correct it"
    )


def test_not_more_than_twenty_are_told() -> None:
    assert refusal(binary(np.full((30, 3, 3), np.nan))).count("\n") == 19
