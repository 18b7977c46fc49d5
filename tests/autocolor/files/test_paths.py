from __future__ import annotations

from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor.errors import UsageError
from autocolor.files.paths import check_stem, file_stem, free_path, path_within

FILE = "must be the name of a file, not"
IN_FOLDER = "must be the name of a file in the scene's folder, not"


@pytest.mark.parametrize("name", ["a.obj", "parts/a.obj", "./a.obj", "a b.obj", "é.obj", "..a.obj"])
def test_names_in_the_folder_are_taken(tmp_path: Path, name: str) -> None:
    (tmp_path / "é.obj").symlink_to(tmp_path / "a.obj")
    problems: list[str] = []
    assert path_within(problems, tmp_path, name) == tmp_path / name
    assert problems == []


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("", f"{FILE} ''; correct it"),
        ("a\0b", f"{FILE} 'a\\x00b'; correct it"),
        ("https://a.b/c.obj", f"{FILE} the address 'https://a.b/c.obj'; fetch it and name the file"),
        ("file:/a.obj", f"{FILE} the address 'file:/a.obj'; fetch it and name the file"),
        ("a\\b.obj", "must have / between folders, not \\ as in 'a\\\\b.obj'; correct it"),
        ("/a.obj", f"{IN_FOLDER} '/a.obj'; copy the file there"),
        ("b/../../a", f"{IN_FOLDER} 'b/../../a'; copy the file there"),
        ("C:a.obj", f"{IN_FOLDER} 'C:a.obj'; copy the file there"),
        (
            "up/b.obj",
            "must be a file in the scene's folder, not a link to one outside like 'up/b.obj'; copy the file"
            " there",
        ),
    ],
)
def test_names_of_other_places_are_refused_unless_files_outside_are_allowed(
    tmp_path: Path, name: str, sentence: str
) -> None:
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "up").symlink_to(tmp_path)
    problems: list[str] = []
    assert path_within(problems, folder, name) is None
    assert problems == [sentence]
    within = path_within([], folder, name, outside=True)
    assert within == (None if sentence.startswith(FILE) else folder / name)


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("scenes/coupe", "coupe"),
        ("C:\\car", "C__car"),
        ("line\nbreak\x00\x1f", "line_break__"),
        ('*?"<>|: ~', "_______ ~"),
        (" купе é ", "купе é"),
        ("a" * 101, "a" * 100),
        # A space at the cut goes, too.
        ("a" * 99 + " b", "a" * 99),
        *((name, "scene") for name in ("", ".", "..", "/", "a/..", " ", ". .")),
    ],
)
def test_a_name_becomes_the_beginning_of_a_file_name(name: str, stem: str) -> None:
    assert file_stem(name) == stem


@given(st.text())
@example("../../x")
@example("a\\..\\b")
@example(" " * 100 + "x")
def test_any_name_becomes_a_file_in_the_folder_where_it_is_put(name: str) -> None:
    stem = file_stem(name)
    path = f"{stem}.png"
    assert Path(path).name == path
    assert PureWindowsPath(path).name == path
    assert path != ".png"
    assert len(path) <= 104
    assert not any(ord(letter) < 32 for letter in path)
    assert file_stem(stem) == stem
    if stem.isprintable() and not stem.startswith("."):
        check_stem(stem)


@pytest.mark.parametrize(
    "name", ["", " ", ".hidden", "a/b", "/a", "a\\b", "C:a", "a\nb", "\u202ea", " a", "a ", "x" * 101]
)
def test_a_name_that_cannot_be_the_stem_of_a_listed_file_is_refused(name: str) -> None:
    with pytest.raises(UsageError, match=r"^a file name must be 1 to 100 characters, .*; choose another$"):
        check_stem(name)


def test_a_path_that_is_taken_gets_the_lowest_number_from_two(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    assert free_path(path) == path
    path.touch()
    assert free_path(path) == tmp_path / "rig-2.toml"
    (tmp_path / "rig-2.toml").mkdir()
    (tmp_path / "rig-3.toml").symlink_to(tmp_path / "nowhere")
    assert free_path(path) == tmp_path / "rig-4.toml"
