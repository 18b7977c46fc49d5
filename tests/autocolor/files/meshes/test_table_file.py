from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import InputError, Mesh
from autocolor.files.array_file import array_file_bytes
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import Placement
from autocolor.files.meshes.table_file import TABLE_FILE, table_file_bytes
from autocolor.scene.scalar import MeshScalar
from autocolor.testing import meshes
from tests.small import cube


@given(meshes())
def test_any_mesh_reads_back_without_a_repair(tmp_path_factory: pytest.TempPathFactory, mesh: Mesh) -> None:
    path = tmp_path_factory.mktemp("mesh") / "mesh.tables"
    path.write_bytes(table_file_bytes(mesh))
    report = read_mesh({"file": path}, Placement(crease_angle=mesh.crease_angle))
    assert report.repairs == ()
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(report.mesh, name), getattr(mesh, name))
    assert (report.mesh.part_names, report.mesh.crease_angle) == (mesh.part_names, mesh.crease_angle)


def test_an_empty_mesh_and_odd_names_are_kept(tmp_path: Path) -> None:
    mesh = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), (" a\n", "\ud800"))
    (tmp_path / "mesh.tables").write_bytes(table_file_bytes(mesh))
    again = read_mesh({"file": tmp_path / "mesh.tables"}).mesh
    assert (again.part_names, again.coordinates.shape, again.node_numbers.shape) == (
        mesh.part_names, (0, 3), (0, 4),
    )  # fmt: skip


def test_scalars_are_kept(tmp_path: Path) -> None:
    mesh = cube().with_scalars(
        MeshScalar("stress", np.array([np.nan, 1e30, *range(6)])),
        MeshScalar("\ud800", np.arange(6.0), "polygon"),
    )
    (tmp_path / "mesh.tables").write_bytes(table_file_bytes(mesh))
    again = read_mesh({"file": tmp_path / "mesh.tables"}).mesh.scalars
    assert [(each.name, each.of) for each in again] == [("stress", "node"), ("\ud800", "polygon")]
    for one, other in zip(again, mesh.scalars, strict=True):
        assert np.array_equal(one.values, other.values, equal_nan=True)


def test_a_table_file_without_scalars_is_still_read(tmp_path: Path) -> None:
    older = dataclasses.replace(TABLE_FILE, formats=TABLE_FILE.plain, series={})
    arrays = {name: getattr(cube(), name) for name in TABLE_FILE.arrays}
    (tmp_path / "mesh.tables").write_bytes(array_file_bytes(older, {"part_names": ["cube"]}, arrays))
    again = read_mesh({"file": tmp_path / "mesh.tables"}).mesh
    assert np.array_equal(again.coordinates, cube().coordinates)
    assert again.scalars == ()


@pytest.mark.parametrize(
    ("rows", "problem"),
    [
        ([{"name": "a", "of": "node"}], "there must be one value a node"),
        ([{"name": "a"}], r"mesh_scalars\[1\] must be a table of name and of"),
        (["a"], r"mesh_scalars\[1\] must be a table of name and of, not 'a'"),
    ],
)
def test_wrong_scalars_are_refused(tmp_path: Path, rows: list[Any], problem: str) -> None:
    arrays = {name: getattr(cube(), name) for name in TABLE_FILE.arrays}
    header = {"part_names": ["cube"], "mesh_scalars": rows}
    data = array_file_bytes(TABLE_FILE, header, {**arrays, "mesh_scalar_0": np.zeros(7)})
    (tmp_path / "mesh.tables").write_bytes(data)
    with pytest.raises(InputError, match=rf"(?m)^mesh\.tables: .*{problem}.*; write the scene again$"):
        read_mesh({"file": tmp_path / "mesh.tables"})


def test_the_up_axis_is_turned_as_in_other_formats(tmp_path: Path) -> None:
    (tmp_path / "mesh.tables").write_bytes(table_file_bytes(cube()))
    low, high = read_mesh({"file": tmp_path / "mesh.tables"}, Placement("y")).mesh.bounds
    assert (low.tolist(), high.tolist()) == ([0, -1, 0], [1, 0, 1])


@pytest.mark.parametrize(
    ("names", "change", "problem"),
    [
        (["a"], {"node_numbers": np.array([[0, 1, 2, 99]])}, "a node number must be a row of the node table"),
        (["a"], {"coordinates": np.full((8, 3), np.nan)}, "coordinates must be finite"),
        (["a"], {"coordinates": np.zeros((8, 2))}, r"its shape must be \(rows, 3\)"),
        (["a", "a"], {}, "part names must differ"),
        ([3], {}, "part names must be strings"),
        ("a", {}, "a part number must be a row of the part table"),
    ],
)
def test_a_table_file_of_no_mesh_is_refused(
    tmp_path: Path, names: object, change: dict[str, object], problem: str
) -> None:
    mesh = cube()
    arrays = {**{name: getattr(mesh, name) for name in TABLE_FILE.arrays}, **change}
    (tmp_path / "mesh.tables").write_bytes(
        array_file_bytes(TABLE_FILE, {"part_names": names, "mesh_scalars": []}, arrays)
    )
    with pytest.raises(InputError, match=rf"(?m)^mesh\.tables: .*{problem}.*; write the scene again$"):
        read_mesh({"file": tmp_path / "mesh.tables"})


def test_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mesh.tables").write_text("v 0 0 0\n")
    with pytest.raises(
        InputError, match=r"mesh\.tables: a table file must be whole and as autocolor wrote it"
    ):
        read_mesh({"file": tmp_path / "mesh.tables"})
