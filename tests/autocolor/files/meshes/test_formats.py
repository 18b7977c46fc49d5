from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files import meshes
from autocolor.files.meshes import formats
from autocolor.files.meshes.formats import format_of, format_of_folder, mesh_formats, mesh_suffixes, read_mesh

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"

ANOTHER = """
from autocolor.files.meshes.csv_tables import read_csv_tables
from autocolor.files.meshes.formats import MeshFormat, register

def read(path, placement):
    return read_csv_tables(path.with_suffix(".n"), path.with_suffix(".p"), placement)

register(MeshFormat("ANOTHER", read, (".another",), begins=lambda head: head.startswith(b"another")))
"""


def test_every_format_has_a_name_and_a_way_to_be_chosen() -> None:
    names = [each.name for each in mesh_formats()]
    assert names == sorted({"CSV", "OBJ", *names})
    assert all(each.suffixes or each.in_folder for each in mesh_formats())
    assert ".obj" in mesh_suffixes()


def test_a_file_is_known_by_the_end_of_its_name_in_capitals_too(tmp_path: Path) -> None:
    found = format_of(tmp_path / "car.OBJ")
    assert found is not None
    assert found.name == "OBJ"


def test_a_file_of_another_name_is_known_by_how_it_begins(tmp_path: Path) -> None:
    (tmp_path / "car.model").write_text("# exported\no car\n" + SQUARE)
    report = read_mesh({"file": tmp_path / "car.model"})
    assert len(report.mesh.node_numbers) == 1
    (tmp_path / "notes").write_text("various things\nv\n")
    assert format_of(tmp_path / "notes") is None


def test_a_folder_is_a_mesh_where_all_its_files_are_there(tmp_path: Path) -> None:
    (tmp_path / "nodes.csv").write_text("x,y,z\n")
    assert format_of_folder(tmp_path) is None
    (tmp_path / "polygons.csv").write_text("node1,node2,node3,node4\n")
    found = format_of_folder(tmp_path)
    assert found is not None
    assert found.name == "CSV"


def test_an_unknown_format_is_refused_with_those_that_are_known(tmp_path: Path) -> None:
    (tmp_path / "car.shape").write_text("solid car")
    with pytest.raises(InputError) as refusal:
        read_mesh({"file": tmp_path / "car.shape"})
    suffixes = " or ".join(mesh_suffixes())
    assert str(refusal.value) == (
        f"car.shape: a mesh file must end in {suffixes}, not in '.shape'; export it as one of these"
    )


def test_a_module_that_is_put_beside_the_others_is_a_format(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "another_format.py").write_text(ANOTHER)
    (tmp_path / "plate.n").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (tmp_path / "plate.p").write_text("node1,node2,node3,node4\n1,2,3,\n")
    (tmp_path / "plate.another").write_text("another")
    monkeypatch.setattr(meshes, "__path__", [*meshes.__path__, str(tmp_path)])
    monkeypatch.setattr(formats, "_REGISTERED", list(formats._REGISTERED))
    mesh_formats.cache_clear()
    try:
        assert ".another" in mesh_suffixes()
        assert len(read_mesh({"file": tmp_path / "plate.another"}).mesh.node_numbers) == 1
        (tmp_path / "plate").write_text("another")
        found = format_of(tmp_path / "plate")
        assert found is not None
        assert found.name == "ANOTHER"
    finally:
        mesh_formats.cache_clear()
        sys.modules.pop("autocolor.files.meshes.another_format", None)
