from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh
from autocolor.files.array_file import array_file_bytes
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import Placement
from autocolor.files.meshes.table_file import TABLE_FILE, table_file_bytes
from autocolor.scene.scalar import MeshScalar
from autocolor.testing import meshes
from tests.autocolor.files.refusals import refusal
from tests.small import cube


def read(folder: Path, data: bytes, up: str = "z") -> Mesh:
    (folder / "mesh.tables").write_bytes(data)
    return read_mesh({"file": folder / "mesh.tables"}, Placement(up)).mesh


@given(meshes())
def test_any_mesh_reads_back_without_a_repair(tmp_path_factory: pytest.TempPathFactory, mesh: Mesh) -> None:
    path = tmp_path_factory.mktemp("mesh") / "mesh.tables"
    path.write_bytes(table_file_bytes(mesh))
    report = read_mesh({"file": path}, Placement(crease_angle=mesh.crease_angle))
    assert report.repairs == ()
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(report.mesh, name), getattr(mesh, name))
    assert (report.mesh.part_names, report.mesh.crease_angle) == (mesh.part_names, mesh.crease_angle)


def test_an_empty_mesh_odd_names_and_scalars_are_kept(tmp_path: Path) -> None:
    empty = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), (" a\n", "\ud800"))
    assert read(tmp_path, table_file_bytes(empty)).part_names == empty.part_names
    mesh = cube().with_scalars(
        MeshScalar("stress", np.array([np.nan, 1e30, *range(6)])),
        MeshScalar("\ud800", np.arange(6.0), "polygon"),
    )
    again = read(tmp_path, table_file_bytes(mesh)).scalars
    for one, other in zip(again, mesh.scalars, strict=True):
        assert (one.name, one.of) == (other.name, other.of)
        assert np.array_equal(one.values, other.values, equal_nan=True)


IS_NO_SCALAR = "its header must be as autocolor wrote it, and is not ("


@pytest.mark.parametrize(
    ("header", "arrays", "problem"),
    [
        ({"mesh_scalars": [{"name": "a", "of": "node"}]}, {}, "there must be one value a node"),
        ({"mesh_scalars": [{"name": "a"}]}, {}, IS_NO_SCALAR),
        ({"mesh_scalars": ["a"]}, {}, IS_NO_SCALAR),
        ({}, {"node_numbers": np.array([[0, 1, 2, 99]])}, "a node number must be a row of the node table"),
        ({}, {"coordinates": np.full((8, 3), np.nan)}, "coordinates must be finite"),
        ({}, {"coordinates": np.zeros((8, 2))}, "coordinates must be <f8 of shape (None, 3), not"),
        ({"part_names": ["a", "a"]}, {}, "part names must differ"),
        ({"part_names": [3]}, {}, "part names must be strings"),
        ({"part_names": "a"}, {}, "part names must be strings"),
    ],
)
def test_a_table_file_of_no_mesh_is_refused(
    tmp_path: Path, header: dict[str, Any], arrays: dict[str, Any], problem: str
) -> None:
    header = {"part_names": ["a"], "mesh_scalars": [], **header}
    scalars = {"mesh_scalar_0": np.zeros(7)} if header["mesh_scalars"] else {}
    sentence = refusal(read, tmp_path, array_file_bytes(TABLE_FILE, cube(), header, {**arrays, **scalars}))
    assert sentence.startswith("mesh.tables: ")
    assert problem in sentence
    assert sentence.endswith("; write the scene again")
