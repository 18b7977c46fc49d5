from __future__ import annotations

from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor.errors import UsageError
from autocolor.files.paths import check_stem, file_stem, free_path, path_within


@pytest.mark.parametrize("name", ["a.obj", "parts/a.obj", "./a.obj", "a b.obj", "é.obj", "..a.obj"])
def test_names_in_the_folder_are_taken(tmp_path: Path, name: str) -> None:
    problems: list[str] = []
    assert path_within(problems, tmp_path, name) == tmp_path / name
    assert problems == []


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("", "must be the name of a file, not ''; correct it"),
        ("a\0b", "must be the name of a file, not 'a\\x00b'; correct it"),
        ("a\nb", "must be the name of a file, not 'a\\nb'; correct it"),
        (
            "https://a.b/c.obj",
            "must be the name of a file, not the address 'https://a.b/c.obj'; fetch it and name the file",
        ),
        ("a\\b.obj", "must have / between folders, not \\ as in 'a\\\\b.obj'; correct it"),
        ("/a.obj", "must be the name of a file in the scene's folder, not '/a.obj'; copy the file there"),
        ("../a.obj", "must be the name of a file in the scene's folder, not '../a.obj'; copy the file there"),
        (
            "b/../../a",
            "must be the name of a file in the scene's folder, not 'b/../../a'; copy the file there",
        ),
        ("C:a.obj", "must be the name of a file in the scene's folder, not 'C:a.obj'; copy the file there"),
    ],
)
def test_other_names_are_refused_with_the_reason(tmp_path: Path, name: str, sentence: str) -> None:
    problems: list[str] = []
    assert path_within(problems, tmp_path, name) is None
    assert problems == [sentence]


def test_a_link_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "a.obj").symlink_to(tmp_path / "b.obj")
    (folder / "up").symlink_to(tmp_path)
    for name in ("a.obj", "up/b.obj"):
        problems: list[str] = []
        assert path_within(problems, folder, name) is None
        assert problems == [
            f"must be a file in the scene's folder, not a link to one outside like {name!r};"
            " copy the file there"
        ]


def test_a_link_within_the_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "a.obj").symlink_to(tmp_path / "b.obj")
    assert path_within([], tmp_path, "a.obj") == tmp_path / "a.obj"


def test_with_outside_any_file_is_taken_but_no_address(tmp_path: Path) -> None:
    assert path_within([], tmp_path, "../a.obj", outside=True) == tmp_path / "../a.obj"
    assert path_within([], tmp_path, "/a.obj", outside=True) == Path("/a.obj")
    for name in ("ftp://a/b.obj", "file:/a.obj"):
        problems: list[str] = []
        assert path_within(problems, tmp_path, name, outside=True) is None
        assert len(problems) == 1


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


def test_a_stem_has_at_most_100_letters() -> None:
    for letters, kept in [(99, 99), (100, 100), (101, 100)]:
        assert file_stem("a" * letters) == "a" * kept
    # A space at the cut goes, too.
    assert file_stem("a" * 99 + " b") == "a" * 99


@pytest.mark.parametrize("name", ["coupe", "red coupe 2", "a.b", "Škoda", "coupe-2_b", "x" * 100])
def test_a_stem_is_accepted_as_the_name_of_a_new_file(name: str) -> None:
    check_stem(name)
    assert file_stem(name) == name


@pytest.mark.parametrize(
    "name",
    [
        "",
        " ",
        ".",
        "..",
        ".hidden",
        "a/b",
        "../a",
        "/a",
        "a\\b",
        "C:a",
        "a\nb",
        "a\0",
        "\u202ea",
        " a",
        "a ",
        "x" * 101,
    ],
)
def test_a_name_that_cannot_be_the_stem_of_a_listed_file_is_refused(name: str) -> None:
    with pytest.raises(UsageError, match=r"^a file name must be 1 to 100 characters, .*; choose another$"):
        check_stem(name)


@given(st.text())
def test_the_stem_of_any_name_is_accepted_unless_it_is_hidden_or_unprintable(name: str) -> None:
    stem = file_stem(name)
    if stem.isprintable() and not stem.startswith("."):
        check_stem(stem)
