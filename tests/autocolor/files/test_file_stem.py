from __future__ import annotations

from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor.files.file_stem import file_stem, free_path


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("coupe", "coupe"),
        ("scenes/coupe", "coupe"),
        ("/etc/passwd", "passwd"),
        ("a: b", "a_ b"),
        ("C:\\car", "C__car"),
        ("line\nbreak\x00", "line_break_"),
        (" coupe ", "coupe"),
        ("купе é", "купе é"),
        ("x" * 300, "x" * 100),
    ],
)
def test_a_name_becomes_the_beginning_of_a_file_name(name: str, stem: str) -> None:
    assert file_stem(name) == stem


@pytest.mark.parametrize("name", ["", ".", "..", "/", "a/..", " ", ". ."])
def test_a_name_that_names_no_file_becomes_scene(name: str) -> None:
    assert file_stem(name) == "scene"


@given(st.text())
@example("../../x")
@example("a\\..\\b")
@example(" " * 100 + "x")
def test_any_name_becomes_a_file_in_the_folder_where_it_is_put(name: str) -> None:
    path = f"{file_stem(name)}.png"
    assert Path(path).name == path
    assert PureWindowsPath(path).name == path
    assert path != ".png"
    assert len(path) <= 104
    assert not any(ord(letter) < 32 for letter in path)


@given(st.text())
def test_a_stem_is_a_stem_already(name: str) -> None:
    assert file_stem(file_stem(name)) == file_stem(name)


def test_a_path_that_is_taken_gets_the_lowest_number_from_two(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    assert free_path(path) == path
    path.touch()
    assert free_path(path) == tmp_path / "rig-2.toml"
    (tmp_path / "rig-2.toml").mkdir()
    (tmp_path / "rig-3.toml").symlink_to(tmp_path / "nowhere")
    assert free_path(path) == tmp_path / "rig-4.toml"
