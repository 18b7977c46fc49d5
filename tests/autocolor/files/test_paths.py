from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.files.paths import path_within


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
