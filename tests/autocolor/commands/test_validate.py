from __future__ import annotations

import json
from pathlib import Path

import pytest

from autocolor import scene_of, write_scene
from autocolor.commands import view
from autocolor.journal.history import History
from tests.autocolor.commands.conftest import Run
from tests.autocolor.meshes import cube


def test_a_scene_without_a_problem_says_so(folder: Path, run: Run) -> None:
    write_scene("whole", scene_of(cube()))
    assert run("validate", "whole") == (0, "whole: no problem\n", "")
    ran = run("validate", "whole", "--json", "--strict")
    assert (ran.code, json.loads(ran.out)) == (0, {"problems": [], "repairs": [], "faults": []})


def test_faults_of_the_mesh_are_listed_and_count_under_strict(folder: Path, run: Run) -> None:
    ran = run("validate", "scene")
    first, border, *_ = ran.out.splitlines()
    assert (ran.code, first[:23]) == (0, "scene: it can be render")
    assert border.startswith(" 1 border ")
    ran = run("validate", "scene", "--json", "--strict")
    assert (ran.code, json.loads(ran.out)["faults"][0]["kind"]) == (1, "border")


def test_faults_are_shown_in_a_picture(folder: Path, run: Run) -> None:
    ran = run("validate", "two.obj", "--show", "-o", "faults.png")
    assert (ran.code, ran.err.splitlines()[-1]) == (0, "wrote faults.png")
    assert (folder / "faults.png").read_bytes().startswith(b"\x89PNG")
    assert run("validate", "two.obj", "--show", "-o", "faults.png").code == 73
    assert run("validate", "two.obj", "-o", "other.png").code == 2
    assert not (folder / "other.png").exists()


def test_faults_are_shown_in_a_window(folder: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[History] = []
    monkeypatch.setattr(view, "show", shown.append)
    assert run("validate", "two.obj", "--show").code == 0
    scalar = shown[0].scene.scalar
    assert scalar is not None
    assert scalar.name == "fault"


def test_every_problem_is_told_at_once(folder: Path, run: Run) -> None:
    text = (folder / "scene" / "scene.toml").read_text().replace("aim", "aimm").replace("minimum", "minimmum")
    (folder / "scene" / "scene.toml").write_text("ambeint = 3\n" + text)
    ran = run("validate", "scene")
    assert (ran.code, ran.out) == (65, "")
    sentences = ran.err.splitlines()
    assert len(sentences) == 3
    for sentence, line, right in zip(
        sentences, (1, 10, 11), ("'ambient'", "'aim'", "'minimum'"), strict=True
    ):
        assert sentence.startswith(f"autocolor: scene.toml, line {line}, ")
        assert sentence.endswith(f"; did you mean {right}?")
    ran = run("validate", "scene", "--json")
    assert ran.code == 65
    assert [f"autocolor: {problem}" for problem in json.loads(ran.out)["problems"]] == ran.err.splitlines()


def test_repairs_are_no_problems_but_count_under_strict(folder: Path, run: Run) -> None:
    (folder / "two.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    ran = run("validate", "two.obj")
    assert (ran.code, ran.out.splitlines()[0][:27]) == (0, "two.obj: it can be rendered")
    assert ran.err.count("\n") == 1
    ran = run("validate", "two.obj", "--strict", "--json")
    assert ran.code == 1
    assert len(json.loads(ran.out)["repairs"]) == 1


def test_what_is_not_there_is_missing(folder: Path, run: Run) -> None:
    ran = run("validate", "none.obj", "--json")
    assert ran.code == 66
    assert json.loads(ran.out)["problems"] == ["none.obj: there is no such file or folder; check the name"]


def test_a_mesh_that_is_not_there_is_missing_too(folder: Path, run: Run) -> None:
    (folder / "scene" / "two.obj").unlink()
    ran = run("validate", "scene")
    assert ran.code == 66
    assert ran.err.count("\n") == 1
