from __future__ import annotations

import os
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.foreign_mesh import part_names_of
from autocolor.files.meshes.foreign_worker import guard, sentence_of


def test_what_a_reader_has_no_need_of_is_refused(tmp_path: Path) -> None:
    folder, written = tmp_path / "meshes", tmp_path / "written"
    folder.mkdir()
    (folder / "a.obj").write_text("v 0 0 0")
    (tmp_path / "secret").write_text("secret")
    (folder / "link").symlink_to(tmp_path / "secret")
    refuse = guard(folder, written)
    refuse("open", (str(folder / "a.obj"), "r", os.O_RDONLY))
    refuse("open", (os.fsencode(os.__file__), "r", os.O_RDONLY))
    refuse("open", (str(written / "result"), "w", os.O_WRONLY | os.O_CREAT))
    refuse("open", (3, "r", os.O_RDONLY))
    refuse("import", ("meshio", None, None, None, None))
    for name in ("../secret", "link"):
        with pytest.raises(PermissionError, match=f"the file names '.*{name}', which is not in its folder"):
            refuse("open", (str(folder / name), "r", os.O_RDONLY))
    with pytest.raises(PermissionError):
        refuse("open", (str(folder / "a.obj"), "w", os.O_WRONLY | os.O_CREAT))
    for event in ("socket.connect", "subprocess.Popen", "os.system", "urllib.Request", "os.remove"):
        with pytest.raises(PermissionError, match=f"{event} is not allowed"):
            refuse(event, ())


def test_a_failure_is_one_line_of_limited_length_without_the_name_of_the_file() -> None:
    def told(error: BaseException) -> str:
        return sentence_of(error, "VTK", "a.vtk")

    cannot = "VTK must be able to read it, and cannot ({}); correct the file, or write it as OBJ or PLY"
    assert told(ValueError("a\n b")) == cannot.format("ValueError: a b")
    assert told(MemoryError()) == cannot.format("it needs more memory than its size and --limit allow")
    assert told(InputError("a.vtk: it must be text")) == "it must be text"
    assert len(told(ValueError("x" * 1000))) == len(cannot) - 2 + 300


def test_names_are_made_unique_and_printable() -> None:
    assert part_names_of(["a", "a", "a 2", "", "b\0", "a"]) == ("a", "a 2", "a 2 2", "part", "b?", "a 3")
