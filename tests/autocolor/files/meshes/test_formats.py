from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files import meshes
from autocolor.files.meshes import formats
from autocolor.files.meshes.formats import (
    MeshFormat,
    files_of_folder,
    format_of,
    format_of_files,
    format_of_folder,
    mesh_formats,
    mesh_suffixes,
    read_mesh,
)
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.registry import Format, Registry
from autocolor.files.scenes.formats import scene_formats

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
    (tmp_path / "car.shape").write_text("car")
    with pytest.raises(InputError) as refusal:
        read_mesh({"file": tmp_path / "car.shape"})
    *others, last = mesh_suffixes()
    assert str(refusal.value) == (
        f"car.shape: a mesh file must end in {', '.join(others)} or {last}, not in '.shape'; export it as one"
        " of these"
    )


def test_a_module_that_is_put_beside_the_others_is_a_format(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "another_format.py").write_text(ANOTHER)
    (tmp_path / "plate.n").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (tmp_path / "plate.p").write_text("node1,node2,node3,node4\n1,2,3,\n")
    (tmp_path / "plate.another").write_text("another")
    monkeypatch.setattr(meshes, "__path__", [*meshes.__path__, str(tmp_path)])
    before, registry = mesh_formats(), Registry[MeshFormat](meshes.__name__)
    monkeypatch.setattr(formats, "REGISTRY", registry)
    for each in before:
        formats.register(each)
    try:
        assert ".another" in mesh_suffixes()
        assert len(read_mesh({"file": tmp_path / "plate.another"}).mesh.node_numbers) == 1
        (tmp_path / "plate").write_text("another")
        found = format_of(tmp_path / "plate")
        assert found is not None
        assert found.name == "ANOTHER"
    finally:
        sys.modules.pop("autocolor.files.meshes.another_format", None)


def read_nothing(*_: object) -> MeshReport:
    raise InputError("nothing")


@pytest.fixture
def pairs(monkeypatch: pytest.MonkeyPatch) -> tuple[MeshFormat, MeshFormat, MeshFormat]:
    """A registry of a format that takes any pair of files, one of binary pairs, and one of folders."""
    keys = ("nodes", "polygons")
    registry = Registry[MeshFormat](meshes.__name__)
    monkeypatch.setattr(formats, "REGISTRY", registry)
    monkeypatch.setattr(meshes, "__path__", [])
    loose = MeshFormat("LOOSE", read_nothing, keys=keys, in_folder=("nodes.csv", "polygons.csv"))
    names = ("nodes.bin", "polygons.bin", "more.bin")
    binary = MeshFormat("BINARY", read_nothing, (".bin",), keys, names, lambda head: head == b"BIN")
    folder = MeshFormat("FOLDER", read_nothing, in_folder=("index",))
    for each in (loose, binary, folder):
        formats.register(each)
    return loose, binary, folder


def test_pairs_of_files_are_told_apart_by_their_suffix_and_their_first_bytes(
    tmp_path: Path, pairs: tuple[MeshFormat, MeshFormat, MeshFormat]
) -> None:
    loose, binary, _ = pairs

    def found(name: str, content: bytes) -> MeshFormat | None:
        (tmp_path / name).write_bytes(content)
        return format_of_files({"nodes": tmp_path / name, "polygons": tmp_path / "p"})

    assert found("nodes.bin", b"BIN") is binary
    assert found("nodes.csv", b"x,y,z") is loose
    assert found("nodes", b"BIN") is binary
    assert found("nodes.txt", b"x,y,z") is loose
    assert format_of_files({"file": tmp_path / "nodes.bin"}) is None


def test_a_folder_gives_the_files_of_its_keys_or_itself(
    tmp_path: Path, pairs: tuple[MeshFormat, MeshFormat, MeshFormat]
) -> None:
    _, binary, folder = pairs
    for name in binary.in_folder:
        (tmp_path / name).touch()
    assert format_of_folder(tmp_path) is format_of(tmp_path) is binary
    assert files_of_folder(tmp_path, binary) == {
        "nodes": tmp_path / "nodes.bin",
        "polygons": tmp_path / "polygons.bin",
    }
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "index").touch()
    assert format_of_files({"file": tmp_path / "inner"}) is folder
    assert files_of_folder(tmp_path / "inner", folder) == {"file": tmp_path / "inner"}


def test_no_two_formats_have_a_suffix_or_a_name_in_common() -> None:
    every: tuple[Format, ...] = (*mesh_formats(), *scene_formats())
    suffixes = [suffix for each in every for suffix in each.suffixes]
    assert sorted(suffixes) == sorted(set(suffixes))
    assert len({each.name for each in every}) == len(every)
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in suffixes)


def test_a_file_of_the_wrong_suffix_is_read_as_what_it_is_and_that_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = MeshFormat("OTHER", read_nothing, (".other",), begins=lambda head: head.startswith(b"other"))
    registry = Registry[MeshFormat](meshes.__name__)
    registry.register(next(each for each in mesh_formats() if each.name == "OBJ"))
    registry.register(other)
    monkeypatch.setattr(formats, "REGISTRY", registry)
    monkeypatch.setattr(meshes, "__path__", [])
    (tmp_path / "car.other").write_text(SQUARE)
    assert read_mesh({"file": tmp_path / "car.other"}).repairs == (
        "car.other: it begins as OBJ and was read as that, not as OTHER; rename it",
    )
