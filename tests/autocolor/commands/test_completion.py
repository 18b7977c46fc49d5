from __future__ import annotations

from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from autocolor import read_scene, render, write_picture, write_scene
from autocolor.commands import completion
from autocolor.commands.autocolor import autocolor
from tests.autocolor.commands.conftest import Run


def completed(*words: str) -> list[str]:
    """The candidates for the last word of a line that begins with `autocolor`."""
    shell = BashComplete(autocolor, {}, "autocolor", "_AUTOCOLOR_COMPLETE")
    return [item.value for item in shell.get_completions(list(words[:-1]), words[-1])]


@pytest.fixture
def named(folder: Path) -> None:
    """A scene with named views, views, and a picture of it, saved.npz."""
    scene = read_scene("scene").with_saved_view("hood").with_saved_view("roof")
    write_scene("views", scene)
    write_picture("saved.npz", scene, render(scene, (30, 20)))


@pytest.mark.usefixtures("named")
@pytest.mark.parametrize(
    ("line", "candidates"),
    [
        # The shell itself completes paths.
        ("info two", ["two"]),
        # Names are those of the scene or the picture on the line.
        ("render scene --light ", ["key", "key.2"]),
        ("render --up y two.obj --light t", ["top"]),
        ("render --light ", []),
        ("render views --view ", ["hood", "roof"]),
        ("render views --view r", ["roof"]),
        ("recolor saved.npz ", ["front.low", "side"]),
        ("palette saved.npz s", ["side"]),
        ("recolor saved.npz side --object nav", ["navajowhite", "navy"]),
        # Keys: each up to its next part.
        ("view views --set li", ["lights.key.", "lights.key.2."]),
        (
            "render views --set views.h",
            [f"views.hood.{key}=" for key in ("eye", "direction", "target", "angle", "field_of_view")],
        ),
        ("render scene --set view.a", ["view.angle=", "view.angle=0.0"]),
        (
            "sweep scene --vary surfaces.side.two",
            [f"surfaces.side.two_sided{end}" for end in ("=", "=true", "=false")],
        ),
        ("render scene --set dither=o", ["dither=off", "dither=ordered"]),
        ("animate scene --vary background=na", ["background=navajowhite", "background=navy"]),
        ("render scene --set background=#", ["background=#000000"]),
        ("render scene --set lights.nobody.", []),
        ("render scene --set xyz=", []),
        # A scene that cannot be read.
        *(
            (f"render {scene} {option} ", [])
            for scene in ("no.obj", "bad")
            for option in ("--light", "--set")
        ),
    ],
)
def test_names_keys_and_values_are_completed(line: str, candidates: list[str], folder: Path) -> None:
    (folder / "bad").mkdir()
    (folder / "bad" / "scene.toml").write_text("[[mesh]\n")
    assert completed(*line.split(" ")) == candidates


def test_a_large_scene_is_not_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    size = (folder / "two.obj").stat().st_size
    monkeypatch.setattr(completion, "LARGEST_SCENE", size)
    assert completed("render", "two.obj", "--light", "k") == ["key"]
    monkeypatch.setattr(completion, "LARGEST_SCENE", size - 1)
    assert completed("render", "two.obj", "--light", "k") == []


@pytest.mark.parametrize(("scene", "told"), [("scene", "key.2"), ("bad.obj", "")])
def test_a_shell_gets_candidates_and_no_message(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, scene: str, told: str
) -> None:
    (folder / "bad.obj").write_text("v 0 0\n")
    monkeypatch.setenv("_AUTOCOLOR_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", f"autocolor\nrender\n{scene}\n--light\n")
    monkeypatch.setenv("COMP_CWORD", "4")
    ran = run()
    assert (ran.code, ran.err) == (0, "")
    # How a candidate is marked differs between versions of click.
    assert (told in ran.out, bool(told)) == (True, bool(ran.out.strip()))
