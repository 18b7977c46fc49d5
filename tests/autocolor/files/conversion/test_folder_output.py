from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Mesh
from autocolor.errors import OutputError, WriteError
from autocolor.files.conversion.folder_output import write_folder
from tests.autocolor.meshes import cube


def write_two(folder: Path, mesh: Mesh) -> None:
    (folder / "nodes").write_text(str(len(mesh.coordinates)))
    (folder / "polygons").write_text(str(len(mesh.node_numbers)))
    (folder / "scalars").mkdir()
    (folder / "scalars" / "1").write_text("")


def test_the_files_of_a_mesh_are_written_to_a_new_folder(tmp_path: Path) -> None:
    target = tmp_path / "out"
    assert write_folder(target, cube(), write_two, overwrite=False) == [
        target / "nodes",
        target / "polygons",
        target / "scalars" / "1",
    ]
    assert (target / "polygons").read_text() == "6"
    assert list(tmp_path.iterdir()) == [target]


def test_files_are_overwritten_only_where_that_is_allowed_and_others_stay(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "polygons").write_text("old")
    (tmp_path / "out" / "notes").write_text("mine")
    with pytest.raises(OutputError, match=r"must be new files, not .*polygons, which exists"):
        write_folder(tmp_path / "out", cube(), write_two, overwrite=False)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["notes", "polygons"]
    assert (tmp_path / "out" / "polygons").read_text() == "old"
    write_folder(tmp_path / "out", cube(), write_two, overwrite=True)
    assert (tmp_path / "out" / "polygons").read_text() == "6"
    assert (tmp_path / "out" / "notes").read_text() == "mine"


def test_a_failed_write_leaves_nothing(tmp_path: Path) -> None:
    def fail(folder: Path, mesh: Mesh) -> None:
        write_two(folder, mesh)
        raise OSError(28, "No space left on device")

    with pytest.raises(WriteError, match="must be written whole"):
        write_folder(tmp_path / "out", cube(), fail, overwrite=True)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_has_a_folder_to_be_in_and_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"must be in an existing folder, not .*none; create it"):
        write_folder(tmp_path / "none" / "out", cube(), write_two, overwrite=False)
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="must be a folder, not the file"):
        write_folder(tmp_path / "file", cube(), write_two, overwrite=True)


def test_a_folder_whose_name_is_too_long_cannot_be_made(tmp_path: Path) -> None:
    with pytest.raises(WriteError, match=r"could not be .*; make room or choose another place"):
        write_folder(tmp_path / ("x" * 300), cube(), lambda folder, mesh: None, overwrite=False)
    assert not list(tmp_path.iterdir())


def test_an_overwriting_that_is_cut_off_never_mixes_two_meshes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out"
    target.mkdir()
    for name in ("nodes", "polygons"):
        (target / name).write_text("old")

    def cut_off(source: object, place: Path) -> None:
        (target / "nodes").write_text("new")
        raise OSError("cut off")

    monkeypatch.setattr("os.replace", cut_off)
    with pytest.raises(WriteError):
        write_folder(target, cube(), write_two, overwrite=True)
    assert [(path.name, path.read_text()) for path in target.iterdir() if path.is_file()] == [
        ("nodes", "new")
    ]
