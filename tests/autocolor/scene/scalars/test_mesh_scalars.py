from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from autocolor import InputError, Mesh
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from tests.autocolor.meshes import grid

NAN = float("nan")


def plate(*scalars: MeshScalar) -> Mesh:
    return grid(2, 1, (0, 0, 0), (1, 0, 0), (0, 1, 0)).with_scalars(*scalars)


def test_values_are_float64_and_a_copy_unless_they_are_read_only() -> None:
    given = np.arange(6)
    scalar = MeshScalar("stress", given)  # type: ignore[arg-type]
    given[:] = 7
    assert scalar.values.dtype == np.float64
    assert scalar.values.tolist() == [0, 1, 2, 3, 4, 5]
    assert MeshScalar("again", scalar.values).values is scalar.values


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"name": ""}, "a scalar must have a name, not ''; give it one"),
        ({"of": "part"}, "scalar 'stress': it must be of 'node' or 'polygon', not 'part'; choose one"),
        (
            {"values": [1.0, np.inf]},
            "scalar 'stress': a value must be at most 1e30 in size, or NaN if it is missing, not inf (row 1)",
        ),
        (
            {"values": np.zeros((2, 2))},
            "scalar 'stress': its values must be numbers in one dimension, not float64 of shape (2, 2);"
            " convert them",
        ),
    ],
)
def test_what_is_no_scalar_is_refused(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        MeshScalar(**{"name": "stress", "values": [0.0, 1.0], **fields})
    assert str(caught.value) == sentence


def test_a_mesh_has_one_value_for_each_row_and_one_scalar_of_each_name() -> None:
    with pytest.raises(InputError, match=r"scalar 'a': there must be one value a node \(6\), not 2"):
        plate(MeshScalar("a", np.zeros(2)))
    with pytest.raises(InputError, match=r"scalar 'a': its name must be unique, not repeated; rename one"):
        plate(MeshScalar("a", np.zeros(6)), MeshScalar("a", np.zeros(2), "polygon"))


def test_a_mesh_with_other_scalars_shares_its_tables_and_what_was_computed_of_them() -> None:
    mesh = plate()
    normals = mesh.normals
    other = mesh.with_scalars(MeshScalar("stress", np.zeros(6)))
    assert other.coordinates is mesh.coordinates
    assert other.normals is normals
    assert mesh.scalars == ()


def test_joined_meshes_keep_their_scalars_and_miss_those_of_others() -> None:
    one = plate(MeshScalar("stress", np.arange(6.0)))
    other = plate(MeshScalar("stress", np.array([1.0, 2.0]), "polygon"), MeshScalar("heat", np.full(6, 5.0)))
    joined = {scalar.name: scalar for scalar in Mesh.joined([one, other]).scalars}
    assert list(joined) == ["stress", "stress of polygons", "heat"]
    np.testing.assert_array_equal(joined["stress"].values, [0, 1, 2, 3, 4, 5, *[NAN] * 6])
    np.testing.assert_array_equal(joined["stress of polygons"].values, [NAN, NAN, 1, 2])
    np.testing.assert_array_equal(joined["heat"].values, [*[NAN] * 6, *[5] * 6])
