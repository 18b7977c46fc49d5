from __future__ import annotations

import os
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files import formats
from autocolor.files.formats import (
    MESH_FORMATS,
    Format,
    MeshFormat,
    files_of_folder,
    format_named,
    format_of,
    format_of_files,
    format_of_folder,
    mesh_suffixes,
    read_mesh,
    recognized,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.npy_tables import write_npy_tables
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_sources import SCENE_FORMATS
from tests.small import cube

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"

SOLID = Format("SOLID", (".solid", ".sld"), begins=lambda head: head.startswith(b"solid"))
PLAIN = Format("PLAIN", (".plain",), begins=lambda head: head.startswith(b"plain"))
ANYTHING = Format("ANYTHING", (".any",))
ALL = (ANYTHING, PLAIN, SOLID)


def test_every_mesh_format_has_its_suffixes_and_abilities() -> None:
    table = {each.name: each.suffixes for each in MESH_FORMATS}
    own = {
        "CSV": (".csv",), "Movie.BYU": (".g", ".byu"), "npy": (".npy",), "OBJ": (".obj",), "OFF": (".off",),
        "PLY": (".ply",), "STL": (".stl",), "VTK": (".vtk",), "VTP": (".vtp",),
    }  # fmt: skip
    assert {name: table[name] for name in own} == own
    assert [each.name for each in MESH_FORMATS if each.mapped] == ["npy"]
    assert [each.name for each in MESH_FORMATS if each.in_folder] == ["CSV", "npy"]
    assert [each.name for each in MESH_FORMATS if each.written] == ["OBJ", "PLY", "STL", "tables"]
    assert [each.name for each in MESH_FORMATS if each.write] == ["CSV", "npy"]


def test_suffixes_are_each_listed_once() -> None:
    assert suffixes_of((*ALL, Format("another", (".any",)))) == (".any", ".plain", ".sld", ".solid")


@pytest.mark.parametrize(
    ("name", "named"),
    [("x.SLD", SOLID), ("x.any.plain", PLAIN), ("x.plain.bak", None), ("plain", None), (".plain", None)],
)
def test_a_format_is_named_by_the_suffix_in_capitals_too(name: str, named: Format | None) -> None:
    assert format_named(Path("folder.any") / name, ALL) is named


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("a.solid", b"solid", SOLID),
        ("a.solid", b"", SOLID),
        ("a.solid", b"neither", SOLID),
        ("a.solid", b"plain", PLAIN),
        ("a", b"plain", PLAIN),
        ("a", b"neither", None),
        ("a.any", b"plain", ANYTHING),
        ("a.shape", b"solid", SOLID),
    ],
)
def test_a_file_has_the_format_of_its_suffix_unless_only_another_one_begins_like_it(
    tmp_path: Path, name: str, content: bytes, found: Format | None
) -> None:
    (tmp_path / name).write_bytes(content)
    assert recognized(tmp_path / name, ALL) is found


def test_what_is_no_file_begins_as_nothing_and_is_never_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name in ("pipe", "none", ".", "a\0b"):
        assert recognized(tmp_path / name, ALL) is None


@pytest.mark.parametrize(
    ("name", "suffixes", "rule"),
    [
        ("a.shape", (".any",), "end in .any, not in '.shape'"),
        ("a", (".any", ".plain", ".sld"), "end in .any, .plain or .sld, and this one has no ending"),
        ("a.SLDD", (".any", ".sld"), "end in .any or .sld, not in '.SLDD'; did you mean '.sld'?"),
    ],
)
def test_the_rule_for_a_suffix_lists_all_and_the_nearest(
    name: str, suffixes: tuple[str, ...], rule: str
) -> None:
    assert suffix_rule(Path(name), suffixes) == rule


def test_no_two_formats_have_a_suffix_or_a_name_in_common() -> None:
    every: tuple[Format, ...] = (*MESH_FORMATS, *SCENE_FORMATS)
    suffixes = [suffix for each in every for suffix in each.suffixes]
    assert sorted(suffixes) == sorted(set(suffixes))
    assert len({each.name for each in every}) == len(every)
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in suffixes)
    assert all(each.suffixes for each in every)


def test_a_mesh_file_of_another_name_is_known_by_how_it_begins(tmp_path: Path) -> None:
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


def read_nothing(*_: object) -> MeshReport:
    raise InputError("nothing")


PAIR = ("nodes", "polygons")
LOOSE = MeshFormat("LOOSE", (), read_nothing, PAIR, in_folder=("nodes.csv", "polygons.csv"))
BINARY = MeshFormat(
    "BINARY",
    (".bin",),
    read_nothing,
    PAIR,
    in_folder=("nodes.bin", "polygons.bin", "more.bin"),
    begins=lambda head: head == b"BIN",
)
FOLDER = MeshFormat("FOLDER", (), read_nothing, in_folder=("index",))


@pytest.fixture
def pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only a format that takes any pair of files, a format of binary pairs, and a format of folders."""
    monkeypatch.setattr(formats, "MESH_FORMATS", (LOOSE, BINARY, FOLDER))


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("nodes.bin", b"BIN", BINARY),
        ("nodes.csv", b"x,y,z", LOOSE),
        ("nodes", b"BIN", BINARY),
        ("nodes.txt", b"x,y,z", LOOSE),
    ],
)
@pytest.mark.usefixtures("pairs")
def test_pairs_of_files_are_told_apart_by_their_suffix_and_their_first_bytes(
    tmp_path: Path, name: str, content: bytes, found: MeshFormat
) -> None:
    (tmp_path / name).write_bytes(content)
    assert format_of_files({"nodes": tmp_path / name, "polygons": tmp_path / "p"}) is found
    assert format_of_files({"file": tmp_path / name}) is None


@pytest.mark.usefixtures("pairs")
def test_a_folder_gives_the_files_of_its_keys_or_itself(tmp_path: Path) -> None:
    for name in BINARY.in_folder:
        (tmp_path / name).touch()
    assert format_of_folder(tmp_path) is format_of(tmp_path) is BINARY
    assert files_of_folder(tmp_path, BINARY) == {
        "nodes": tmp_path / "nodes.bin",
        "polygons": tmp_path / "polygons.bin",
    }
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "index").touch()
    assert format_of_files({"file": tmp_path / "inner"}) is FOLDER
    assert files_of_folder(tmp_path / "inner", FOLDER) == {"file": tmp_path / "inner"}


def test_a_file_of_the_wrong_suffix_is_read_as_what_it_is_and_that_is_told(tmp_path: Path) -> None:
    (tmp_path / "car.off").write_text(SQUARE)
    assert read_mesh({"file": tmp_path / "car.off"}).repairs == (
        "car.off: it begins as OBJ and was read as that, not as OFF; rename it",
    )


def test_a_folder_is_no_mesh_file(tmp_path: Path) -> None:
    write_npy_tables(tmp_path / "tables", cube())
    with pytest.raises(InputError, match="must be a regular file, not a folder"):
        read_mesh({"file": tmp_path / "tables"})
