from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.files.formats import Format, read_mesh, recognized, suffixes_of
from autocolor.files.meshes.csv_tables import write_csv_tables
from autocolor.files.meshes.npy_tables import write_npy_tables
from autocolor.files.opening import FORMATS, format_of_folder
from tests.autocolor.files.refusals import refusal
from tests.small import cube

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"

SOLID = Format(
    name="SOLID", suffixes=(".solid", ".sld"), read=read_mesh, begins=lambda head: head.startswith(b"solid")
)
PLAIN = Format(
    name="PLAIN", suffixes=(".plain",), read=read_mesh, begins=lambda head: head.startswith(b"plain")
)
ANYTHING = Format(name="ANYTHING", suffixes=(".any",), read=read_mesh)
ALL = (ANYTHING, PLAIN, SOLID)


def test_no_two_formats_have_a_suffix_or_a_name_in_common() -> None:
    suffixes = [suffix for each in FORMATS for suffix in each.suffixes]
    assert len(suffixes) == len({*suffixes})
    assert len({each.name for each in FORMATS}) == len(FORMATS)
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in suffixes)
    assert suffixes_of(ALL) == (".any", ".plain", ".sld", ".solid")


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("a.solid", b"neither", SOLID),
        ("a.solid", b"plain", PLAIN),
        ("a", b"plain", PLAIN),
        ("a.any", b"plain", ANYTHING),
        ("a.SLD", b"", SOLID),
        ("a.plain.bak", b"", None),
    ],
)
def test_a_file_has_the_format_of_its_suffix_unless_only_another_one_begins_like_it(
    tmp_path: Path, name: str, content: bytes, found: Format | None
) -> None:
    (tmp_path / name).write_bytes(content)
    assert recognized(tmp_path / name, ALL) is found


def test_a_mesh_file_with_the_suffix_of_another_format_is_read_and_reported(tmp_path: Path) -> None:
    (tmp_path / "car.model").write_text("# exported\no car\n" + SQUARE)
    assert read_mesh({"file": tmp_path / "car.model"}).repairs == ()
    (tmp_path / "car.off").write_text(SQUARE)
    assert read_mesh({"file": tmp_path / "car.off"}).repairs == (
        "car.off: it begins as OBJ and was read as that, not as OFF; rename it",
    )


def test_files_of_no_format_are_refused(tmp_path: Path) -> None:
    (tmp_path / "car.shape").write_text("car")
    write_npy_tables(tmp_path / "tables", cube())
    for name in ("car.shape", "tables"):
        sentence = refusal(read_mesh, {"file": tmp_path / name})
        assert sentence.startswith(f"{name}: a mesh file must end in .3mf, ")
        assert sentence.endswith("; export it as one of these")


def test_two_tables_are_recognized_by_the_suffix_and_the_first_bytes_of_the_first(tmp_path: Path) -> None:
    write_npy_tables(tmp_path, cube())
    for name, path in zip(("n.txt", "p.txt"), write_csv_tables(tmp_path, cube()), strict=True):
        path.rename(tmp_path / name)
    (tmp_path / "nodes.npy").rename(tmp_path / "nodes.tab")
    for nodes, polygons in (("n.txt", "p.txt"), ("nodes.tab", "polygons.npy")):
        read = read_mesh({"nodes": tmp_path / nodes, "polygons": tmp_path / polygons})
        assert len(read.mesh.node_numbers) == 6


@pytest.mark.parametrize("each", [each for each in FORMATS if each.in_folder[1:]], ids=lambda each: each.name)
def test_a_folder_of_all_its_files_has_their_format(tmp_path: Path, each: Format) -> None:
    for name in each.in_folder:
        assert format_of_folder(tmp_path) is None
        (tmp_path / name).touch()
    assert format_of_folder(tmp_path) is each
