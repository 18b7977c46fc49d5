from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.checks import LARGEST_COORDINATE
from autocolor.files.meshes.formats import read_mesh
from autocolor.files.meshes.obj import obj_text as module
from autocolor.files.meshes.obj.obj_text import obj_text
from tests.autocolor.meshes import cube, sphere

numbers = st.floats(-LARGEST_COORDINATE, LARGEST_COORDINATE, allow_subnormal=True)


def test_nodes_come_first_and_a_part_has_its_name_where_it_begins() -> None:
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 0.1, 0], [0, 1, 1e-9]]),
        np.array([[0, 1, 2, 3], [0, 1, 2, 2], [1, 2, 3, 3]]),
        np.array([0, 1, 1]),
        ("hood", "left door"),
    )
    assert obj_text(mesh).decode() == (
        "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 1.0 0.1 0.0\nv 0.0 1.0 1e-09\n"
        "o hood\nf 1 2 3 4\no left door\nf 1 2 3\nf 2 3 4\n"
    )


@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=8))
def test_every_coordinate_reads_back_equal(
    tmp_path_factory: pytest.TempPathFactory, places: list[tuple[float, float, float]]
) -> None:
    coordinates = np.array([*places, (0, 0, 0), (1, 0, 0), (1, 1, 0)])
    last = len(coordinates)
    mesh = Mesh(coordinates, np.array([[last - 3, last - 2, last - 1]]), np.array([0]), ("a",))
    path = tmp_path_factory.mktemp("mesh") / "mesh.obj"
    path.write_bytes(obj_text(mesh))
    again = read_mesh({"file": path}).mesh.coordinates
    assert (again == coordinates).all()
    assert (np.signbit(again) == np.signbit(coordinates)).all()


@pytest.mark.parametrize("rows", [1, 7, 1 << 16])
def test_a_mesh_reads_back_equal_however_it_is_cut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows: int
) -> None:
    monkeypatch.setattr(module, "ROWS_AT_ONCE", rows)
    mesh = Mesh.joined([cube(), sphere(8, 6)])
    (tmp_path / "mesh.obj").write_bytes(obj_text(mesh))
    report = read_mesh({"file": tmp_path / "mesh.obj"})
    assert report.repairs == ()
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(report.mesh, name), getattr(mesh, name))
    assert report.mesh.part_names == ("cube", "sphere")
    assert (report.mesh.normals.vectors == mesh.normals.vectors).all()
