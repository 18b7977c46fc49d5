from __future__ import annotations

import numpy as np
import pytest

from autocolor.files.meshes.file_scalars import FileScalars, von_mises

NINE = np.array([[1.0, 4, 6, 4, 2, 5, 6, 5, 3]])


@pytest.mark.parametrize(
    ("values", "name", "expected"),
    [
        (np.array([1, 2, 3], "u1"), "a", [1, 2, 3]),
        (np.array([[1.5], [np.nan]]), "a", [1.5, np.nan]),
        (np.array([[3.0, 4.0, 0.0]]), "a magnitude", [5]),
        # Six components are in the order xx, yy, zz, xy, yz, xz.
        (np.array([[1.0, 2, 3, 4, 5, 6]]), "a von Mises", [(3 + 3 * (16 + 25 + 36)) ** 0.5]),
        (NINE, "a von Mises", von_mises(np.array([[1.0, 8, 12, 0, 2, 10, 0, 0, 3]]))),
        # A pressure adds nothing.
        (NINE + np.eye(3).reshape(1, 9) * 7, "a von Mises", von_mises(NINE)),
    ],
)
def test_an_array_is_a_scalar_its_length_or_von_mises_stress(
    values: np.ndarray, name: str, expected: list[float]
) -> None:
    found = FileScalars()
    found.add("a", values, "node")
    [scalar] = found.scalars
    assert scalar.name == name
    assert scalar.values == pytest.approx(np.array(expected), nan_ok=True)
    assert found.messages == ()


def test_other_arrays_and_values_are_left_out_and_told() -> None:
    found = FileScalars()
    found.add("colors", np.zeros((2, 4)), "polygon")
    found.add("a", np.array([np.inf, -2e30, 1e30, np.nan]), "node")
    found.add("b", np.array([[1e300, 1, 1]]), "node")
    assert str(found.scalars[0].values.tolist()) == "[nan, nan, 1e+30, nan]"
    assert found.messages == (
        "skipped the polygon array 'colors', which has 4 components",
        "scalar 'a': values above 1e30 in size were made missing: 2",
        "scalar 'b magnitude': values above 1e30 in size were made missing: 1",
    )


def test_names_are_made_unique_rows_are_chosen_and_there_are_at_most_a_thousand() -> None:
    found = FileScalars()
    for name, of in (("a", "polygon"), ("a", "node"), ("a\n", "node"), ("", "node")):
        found.add(name, np.array([7, 8]), of, np.array([1]))
    assert [(each.name, each.of) for each in found.scalars] == [
        ("a", "node"), ("a 2", "node"), ("scalar", "node"), ("a of polygons", "polygon"),
    ]  # fmt: skip
    assert found.scalars[0].values.tolist() == [8]
    for number in range(1002):
        found.add(f"{number}", np.zeros(1), "node")
    assert len(found.scalars) == 1000
    assert found.messages == ("skipped 6 arrays: a mesh has at most 1,000 scalars",)
