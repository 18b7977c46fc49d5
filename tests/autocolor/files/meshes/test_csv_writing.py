from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.csv_tables import read_csv_tables
from autocolor.files.meshes.csv_writing import csv_tables_bytes
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import MeshScalar

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1 / 3]])
TWO = np.array([[0, 1, 2, 3], [0, 1, 2, 2]])


def test_a_mesh_is_two_tables_with_its_scalars() -> None:
    mesh = Mesh(
        SQUARE,
        TWO,
        np.array([0, 1]),
        ("hood", 'a, "b"'),
        scalars=(
            MeshScalar("stress", np.array([0.1, math.nan, 1e-300, 4])),
            MeshScalar("part", np.array([1.0, math.nan]), "polygon"),
        ),
    )
    nodes, polygons = csv_tables_bytes(mesh)
    assert nodes.decode() == (
        "node,x,y,z,stress\n1,0.0,0.0,0.0,0.1\n2,1.0,0.0,0.0,\n3,1.0,1.0,0.0,1e-300\n"
        "4,0.0,1.0,0.3333333333333333,4.0\n"
    )
    assert polygons.decode() == (
        'polygon,part,node1,node2,node3,node4,scalar part\n1,hood,1,2,3,4,1.0\n2,"a, ""b""",1,2,3,,\n'
    )


NAMES = st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=9)
SCALAR_NAMES = NAMES | st.sampled_from(["x", "X", "node5", "scalar", "scalar x", "part", "nodes"])
VALUES = st.floats(-1e30, 1e30) | st.just(math.nan)


@given(
    parts=st.lists(NAMES, min_size=2, max_size=2, unique=True),
    names=st.lists(SCALAR_NAMES, max_size=4, unique=True),
    places=st.lists(st.floats(-1e3, 1e3), min_size=4, max_size=4),
    values=st.lists(VALUES, min_size=4, max_size=4),
)
def test_a_mesh_reads_back_equal(
    parts: list[str],
    names: list[str],
    places: list[float],
    values: list[float],
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    coordinates = SQUARE.copy()
    coordinates[:, 2] = places
    scalars = [
        MeshScalar(name, np.array(values), "node")
        if number % 2 == 0
        else MeshScalar(name, np.array(values[:2]), "polygon")
        for number, name in enumerate(names)
    ]
    mesh = Mesh(coordinates, TWO, np.array([0, 1]), tuple(parts), scalars=tuple(scalars))
    folder = tmp_path_factory.getbasetemp()
    paths = folder / "nodes.csv", folder / "polygons.csv"
    for path, data in zip(paths, csv_tables_bytes(mesh), strict=True):
        path.write_bytes(data)
    report = read_csv_tables(*paths)
    assert report.repairs == ()
    assert report.mesh.part_names == mesh.part_names
    for name in ("coordinates", "node_numbers", "part_numbers"):
        np.testing.assert_array_equal(getattr(report.mesh, name), getattr(mesh, name))
    found = {each.name: each for each in report.mesh.scalars}
    assert set(found) == set(names)
    for scalar in scalars:
        assert found[scalar.name].of == scalar.of
        np.testing.assert_array_equal(found[scalar.name].values, scalar.values)
