from __future__ import annotations

import json
from pathlib import Path

from tests.autocolor.commands.conftest import Run


def test_a_scene_without_a_problem_says_so(folder: Path, run: Run) -> None:
    assert run("validate", "scene") == (0, "scene: no problem\n", "")
    ran = run("validate", "scene", "--json")
    assert (ran.code, json.loads(ran.out)) == (0, {"problems": [], "repairs": []})


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
    assert (ran.code, ran.out) == (0, "two.obj: no problem\n")
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
