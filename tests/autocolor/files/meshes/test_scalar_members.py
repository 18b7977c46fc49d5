from __future__ import annotations

import numpy as np
import pytest

from autocolor import InputError
from autocolor.files.meshes.scalar_members import scalar_members, scalar_rows, scalars_of
from autocolor.scene.scalars.mesh_scalars import MeshScalar


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
