from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.formats import (
    Format,
    format_named,
    format_of_files,
    format_of_folder,
    read_mesh,
    recognized,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.csv_tables import CSV_FILES
from autocolor.files.meshes.npy_tables import MAGIC, write_npy_tables
from autocolor.files.opening import FORMATS
from tests.small import cube

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"

SOLID = Format("SOLID", (".solid", ".sld"), begins=lambda head: head.startswith(b"solid"))
PLAIN = Format("PLAIN", (".plain",), begins=lambda head: head.startswith(b"plain"))
ANYTHING = Format("ANYTHING", (".any",))
ALL = (ANYTHING, PLAIN, SOLID)


def test_no_two_formats_have_a_suffix_or_a_name_in_common() -> None:
    suffixes = [suffix for each in FORMATS for suffix in each.suffixes]
    assert len(suffixes) == len({*suffixes})
    assert len({each.name for each in FORMATS}) == len(FORMATS)
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in suffixes)
    assert suffixes_of(ALL) == (".any", ".plain", ".sld", ".solid")


@pytest.mark.parametrize(
    ("name", "named"),
    [("x.SLD", SOLID), ("x.any.plain", PLAIN), ("x.plain.bak", None), ("plain", None), (".plain", None)],
)
def test_a_format_is_named_by_the_suffix_in_capitals_too(name: str, named: Format | None) -> None:
    assert format_named(Path("folder.any") / name, ALL) is named


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
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
        with pytest.raises(
            InputError, match=rf"^{name}: a mesh file must end in \.3mf, .*; export it as one"
        ):
            read_mesh({"file": tmp_path / name})


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("nodes.npy", b"", "npy"),
        ("nodes.csv", b"x,y,z", "CSV"),
        ("nodes", MAGIC, "npy"),
        ("nodes.txt", b"x,y,z", "CSV"),
    ],
)
def test_two_tables_are_recognized_by_the_suffix_and_the_first_bytes_of_the_first(
    tmp_path: Path, name: str, content: bytes, found: str
) -> None:
    (tmp_path / name).write_bytes(content)
    several = format_of_files({"nodes": tmp_path / name, "polygons": tmp_path / "p"})
    assert several is not None
    assert several.name == found
    assert format_of_files({"file": tmp_path / name}) is None


@pytest.mark.parametrize(("name", "keys"), [("npy", ("nodes.npy", "polygons.npy")), ("CSV", CSV_FILES)])
def test_a_folder_of_all_its_files_has_their_format(tmp_path: Path, name: str, keys: tuple[str, ...]) -> None:
    for key in keys:
        assert format_of_folder(tmp_path) is None
        (tmp_path / key).touch()
    found = format_of_folder(tmp_path)
    assert found is not None
    assert found.name == name
