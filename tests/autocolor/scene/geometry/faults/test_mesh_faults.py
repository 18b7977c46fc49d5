from __future__ import annotations

import numpy as np

from autocolor import Mesh
from autocolor.scene.geometry.faults.mesh_faults import KINDS, fault_scalar, mesh_faults
from tests.autocolor.meshes import cube


def faulty() -> Mesh:
    """A warped quad, a concave and a crossed one, a repeated and a turned triangle, and one without area."""
    return Mesh(
        np.array(
            [
                [0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0],
                [5, 0, 0], [7, 0, 0], [5.5, 0.5, 0], [5, 2, 0],
                [10, 0, 0], [11, 1, 0], [11, 0, 0], [10, 1, 0],
                [20, 0, 0], [21, 0, 0], [20, 1, 0], [21, 1, 0],
                [30, 0, 0], [31, 0, 0], [32, 0, 0],
                [99, 0, 0], [20, 1, 0],
            ]
        ),
        np.array(
            [
                [0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11],
                [12, 13, 14, 14], [13, 15, 14, 14], [14, 12, 13, 13], [16, 17, 18, 18],
                [12, 20, 13, 13],
            ]
        ),
    )  # fmt: skip


def test_each_kind_of_fault_is_found_with_its_rows() -> None:
    found = {fault.kind: fault for fault in mesh_faults(faulty())}
    assert list(found) == [kind for kind in KINDS if kind in found]
    polygons = {kind: found[kind].rows.tolist() for kind in ("warped", "concave", "crossed", "repeated")}
    assert polygons == {"warped": [0], "concave": [1], "crossed": [2], "repeated": [3, 5]}
    assert found["without area"].rows.tolist() == [6]
    assert found["unused"].rows.tolist() == [19]
    assert found["unwelded"].rows.tolist() == [14, 20]
    assert sorted(map(sorted, found["crowded"].rows.tolist())) == [[12, 13], [13, 14]]
    assert found["turned"].polygons.tolist() == [3, 5]
    assert [hole.edges for hole in found["border"].holes][-1] > 0


def test_a_cube_has_no_fault() -> None:
    assert mesh_faults(cube()) == ()
    assert mesh_faults(Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp))) == ()


def test_the_scalar_has_the_gravest_fault_of_each_polygon() -> None:
    mesh = faulty()
    scalar = fault_scalar(mesh, mesh_faults(mesh))
    numbers = {kind: number for number, kind in enumerate(KINDS, 1)}
    assert (scalar.name, scalar.of) == ("fault", "polygon")
    assert scalar.values[2] == numbers["crossed"]
    assert scalar.values[5] == numbers["crowded"]
    assert scalar.values[6] == numbers["without area"]
    assert not fault_scalar(cube(), ()).values.any()
