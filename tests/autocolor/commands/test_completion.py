from __future__ import annotations

import os
from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from autocolor import read_scene, render, write_picture, write_scene
from autocolor.commands import completion
from autocolor.commands.autocolor import autocolor
from autocolor.commands.completion import narrowed
from autocolor.files.formats import MESH_FORMATS, suffixes_of
from autocolor.files.opening import FILES
from tests.autocolor.commands.conftest import Run


def completed(*words: str) -> list[str]:
    """The candidates for the last word of a line that begins with `autocolor`."""
    shell = BashComplete(autocolor, {}, "autocolor", "_AUTOCOLOR_COMPLETE")
    return [item.value for item in shell.get_completions(list(words[:-1]), words[-1])]


@pytest.fixture
def crowded(folder: Path) -> Path:
    """The folder with files that are no scenes, hidden ones, and folders of folders."""
    (folder / "notes.txt").write_text("")
    (folder / ".hidden.obj").write_text("")
    (folder / "Car.OBJ").write_text("")
    (folder / "tables").mkdir()
    for name in ("nodes.csv", "polygons.csv"):
        (folder / "tables" / name).write_text("")
    (folder / "more" / "inner").mkdir(parents=True)
    (folder / "more" / "inner" / "deep.obj").write_text("")
    return folder


def test_the_files_and_folders_of_all_formats_are_completed(folder: Path) -> None:
    (folder / "all").mkdir()
    expected = {f"all/a{suffix}" for suffix in suffixes_of(FILES)}
    for name in expected:
        (folder / name).touch()
    for each in MESH_FORMATS:
        for name in each.in_folder:
            (folder / "all" / each.name).mkdir(exist_ok=True)
            (folder / "all" / each.name / name).touch()
            expected.add(f"all/{each.name}")
    assert set(completed("render", "all/")) == expected


@pytest.mark.parametrize("command", ["render", "view", "info", "validate", "show", "tables"])
def test_a_scene_is_a_folder_with_one_or_a_file_of_a_format(crowded: Path, command: str) -> None:
    assert completed(command, "") == ["Car.OBJ", "more/", "scene", "tables", "two.obj"]


@pytest.mark.parametrize(
    ("word", "candidates"),
    [
        ("t", ["tables", "two.obj"]),
        ("mo", ["more/inner/deep.obj"]),
        ("more/", ["more/inner/deep.obj"]),
        ("scene/", ["scene/scene.toml", "scene/two.obj"]),
        ("./sc", ["./scene"]),
        ("nothing/", []),
        ("notes", []),
    ],
)
def test_a_path_is_completed_into_the_only_folder_left(
    crowded: Path, word: str, candidates: list[str]
) -> None:
    assert completed("info", word) == candidates


def test_an_absolute_path_is_completed(crowded: Path) -> None:
    assert completed("info", f"{crowded}/tw") == [f"{crowded}/two.obj"]


def test_a_picture_and_its_surfaces_are_completed(folder: Path) -> None:
    scene = read_scene("scene")
    write_picture("saved.npz", scene, render(scene, (30, 20)))
    assert completed("recolor", "") == ["saved.npz", "scene/"]
    assert completed("recolor", "saved.npz", "") == ["front.low", "side"]
    assert completed("recolor", "saved.npz", "s") == ["side"]
    assert completed("recolor", "saved.npz", "side", "--object", "navy") == ["navy"]


def test_lights_are_those_of_the_scene_on_the_line(folder: Path) -> None:
    assert completed("render", "scene", "--light", "") == ["key", "key.2"]
    assert completed("render", "--up", "y", "two.obj", "--light", "t") == ["top"]
    assert completed("render", "--light", "") == []


def test_views_are_those_of_the_scene_on_the_line(folder: Path) -> None:
    write_scene("views", read_scene("scene").with_saved_view("hood").with_saved_view("roof"))
    assert completed("render", "views", "--view", "") == ["hood", "roof"]
    assert completed("render", "views", "--view", "r") == ["roof"]
    assert completed("render", "views", "--set", "views.h") == [
        f"views.hood.{key}=" for key in ("eye", "direction", "target", "angle", "field_of_view")
    ]


@pytest.mark.parametrize(
    ("word", "candidates"),
    [
        ("li", ["lights.key.", "lights.key.2."]),
        ("surfaces.side.two", [f"surfaces.side.two_sided{end}" for end in ("=", "=true", "=false")]),
        ("dither=o", ["dither=off", "dither=ordered"]),
        ("background=na", ["background=navajowhite", "background=navy"]),
        ("background=#", ["background=#000000"]),
        ("ambient", ["ambient=", "ambient=0.1"]),
        ("lights.key.flaps.z.m", ["lights.key.flaps.z.minimum=", "lights.key.flaps.z.maximum="]),
        ("surfaces.front.low.le", ["surfaces.front.low.levels="]),
        ("lights.nobody.", []),
        ("xyz", []),
    ],
)
@pytest.mark.parametrize("command", ["render", "view"])
def test_keys_of_settings_are_those_of_the_scene_on_the_line(
    folder: Path, command: str, word: str, candidates: list[str]
) -> None:
    assert completed(command, "scene", "--set", word) == candidates


@pytest.mark.parametrize("scene", ["none.obj", "bad.obj", "bad", "bad.npz", "\0", "", "two.obj/x"])
@pytest.mark.parametrize("option", ["--light", "--set"])
def test_a_scene_that_cannot_be_read_completes_to_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], scene: str, option: str
) -> None:
    (folder / "bad.obj").write_text("v 0 0\n")
    (folder / "bad.npz").write_bytes(b"PK\3\4")
    (folder / "bad").mkdir()
    (folder / "bad" / "scene.toml").write_text("[[mesh]\n")
    assert completed("render", scene, option, "") == []
    assert capsys.readouterr() == ("", "")


def test_a_large_scene_is_not_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    size = (folder / "two.obj").stat().st_size
    monkeypatch.setattr(completion, "LARGEST_SCENE", size)
    assert completed("render", "two.obj", "--light", "k") == ["key"]
    monkeypatch.setattr(completion, "LARGEST_SCENE", size - 1)
    assert completed("render", "two.obj", "--light", "k") == []


def test_a_folder_of_very_many_entries_is_looked_at_in_part(
    crowded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(completion, "MOST_ENTRIES", 2)
    assert len(completed("info", "")) <= 2


def test_candidates_of_a_single_start_take_its_place_down_to_its_end() -> None:
    after = {"": ["a.", "b="], "a.": ["a.b."], "a.b.": ["a.b.c=", "a.b.d="], "a.b.c=": []}
    assert narrowed("a", "", after.__getitem__) == ["a.b.c=", "a.b.d="]
    assert narrowed("a.b.c", "a.b.", after.__getitem__) == ["a.b.c="]
    assert narrowed("x", "", after.__getitem__) == []


@pytest.mark.skipif(os.name != "posix", reason="the shells are those of POSIX")
@pytest.mark.parametrize(
    ("shell", "line", "told"),
    [
        ("bash", "autocolor\nrender\nscene\n--light\n", "key.2"),
        ("bash", "autocolor\ninfo\na\\ ", "a\\ \\(1\\).obj"),
        ("zsh", "autocolor\ninfo\na\\ ", "a (1).obj"),
        ("fish", "autocolor info a", "a (1).obj"),
        ("bash", "autocolor\nrender\nbad.obj\n--light\n", ""),
    ],
)
def test_a_shell_is_told_in_its_own_quotes_and_nothing_else(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, shell: str, line: str, told: str
) -> None:
    (folder / "a (1).obj").write_text("")
    (folder / "bad.obj").write_text("v 0 0\n")
    count = str(len(line.split("\n")) - 1)
    monkeypatch.setenv("_AUTOCOLOR_COMPLETE", f"{shell}_complete")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", "a" if shell == "fish" else count)
    ran = run()
    assert (ran.code, ran.err) == (0, "")
    # How a candidate is marked differs between versions of click.
    assert told in ran.out
    assert bool(told) == bool(ran.out.strip())
