from __future__ import annotations

import numpy as np
import pytest

from autocolor.files.meshes.file_scalars import FileScalars, von_mises


def test_one_component_is_a_scalar_with_missing_values() -> None:
    found = FileScalars()
    found.add("stress", np.array([1, 2, 3], "u1"), "node", np.array([2, 0]))
    found.add("heat", np.array([[1.5], [np.nan]]), "polygon")
    assert [(each.name, each.of, str(each.values.tolist())) for each in found.scalars] == [
        ("stress", "node", "[3.0, 1.0]"),
        ("heat", "polygon", "[1.5, nan]"),
    ]
    assert found.messages == ()


def test_vectors_have_a_magnitude_and_tensors_von_mises_stress() -> None:
    found = FileScalars()
    found.add("v", np.array([[3.0, 4.0, 0.0]]), "node")
    found.add("w", np.array([[3, 4]]), "node")
    found.add("s", np.array([[5.0, 0, 0, 0, 0, 0]]), "node")
    found.add("t", np.array([[0.0, 2, 0, 2, 0, 0, 0, 0, 0]]), "node")
    assert {each.name: each.values.tolist() for each in found.scalars} == {
        "v magnitude": [5],
        "w magnitude": [5],
        "s von Mises": [5],
        "t von Mises": [pytest.approx(2 * 3**0.5)],
    }


def test_six_components_are_in_the_order_xx_yy_zz_xy_yz_xz() -> None:
    found = FileScalars()
    six = np.array([[1.0, 2, 3, 4, 5, 6]])
    found.add("s", six, "node")
    nine = np.array([[1.0, 4, 6, 4, 2, 5, 6, 5, 3]])
    assert found.scalars[0].values.tolist() == von_mises(nine).tolist()
    # A pressure adds nothing.
    assert von_mises(nine + np.eye(3).reshape(1, 9) * 7).tolist() == [pytest.approx(von_mises(nine)[0])]
    assert found.scalars[0].values[0] == pytest.approx((3 + 3 * (16 + 25 + 36)) ** 0.5)


def test_arrays_of_other_sizes_are_skipped_and_told() -> None:
    found = FileScalars()
    found.add("colors", np.zeros((2, 4)), "polygon")
    assert found.scalars == ()
    assert found.messages == ("skipped the polygon array 'colors', which has 4 components",)


def test_infinite_and_huge_values_become_missing_and_are_counted() -> None:
    found = FileScalars()
    found.add("a", np.array([np.inf, -2e30, 1e30, np.nan]), "node")
    found.add("b", np.array([[1e300, 1, 1]]), "node")
    assert str(found.scalars[0].values.tolist()) == "[nan, nan, 1e+30, nan]"
    assert found.messages == (
        "scalar 'a': 2 values above 1e30 in size were made missing",
        "scalar 'b magnitude': 1 value above 1e30 in size was made missing",
    )


def test_names_are_made_unique_and_printable() -> None:
    found = FileScalars()
    for name, of in (("a", "node"), ("a", "polygon"), ("a", "node"), ("a\n", "node"), ("", "node")):
        found.add(name, np.zeros(1), of)
    assert [each.name for each in found.scalars] == ["a", "a 2", "a 3", "scalar", "a of polygons"]


def test_a_mesh_has_at_most_a_thousand_scalars() -> None:
    found = FileScalars()
    for number in range(1002):
        found.add(f"{number}", np.zeros(1), "node")
    assert len(found.scalars) == 1000
    assert found.messages == ("skipped 2 arrays: a mesh has at most 1,000 scalars",)
