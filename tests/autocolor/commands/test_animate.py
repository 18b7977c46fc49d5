from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import image, read_scene, render
from autocolor.files.settings import scene_with
from tests.autocolor.commands.conftest import Run
from tests.ramtek_emu.film_reader import decoded

PAINT = "surfaces.side.object_color"


def test_lists_run_together_and_a_loop_comes_back(folder: Path, run: Run) -> None:
    varies = ("--vary", f"{PAINT}=red,blue,red", "--vary", "background=black,white,black")
    ran = run(
        "animate", "scene", *varies, "--frames", "4", "--size", "40x30", "--smooth", "1", "-o", "a.apng"
    )
    assert ran == (0, "", "wrote a.apng, 4 frames\n")
    scene = read_scene("scene")
    expected = [("red", "#000000"), ("#800080", "#808080"), ("blue", "#ffffff"), ("#800080", "#808080")]
    for shown, (paint, background) in zip(decoded("a.apng"), expected, strict=True):
        frame = scene_with(scene, {PAINT: paint, "background": background})
        assert np.array_equal(shown, image(frame, render(frame, 30, 40)))


def test_a_table_with_times_and_a_turn_make_numbered_pictures(folder: Path, run: Run) -> None:
    Path("looks.csv").write_text(f"time,{PAINT}\n0,red\n3,blue\n4,red\n")
    ran = run(
        "animate", "scene", "--table", "looks.csv", "--turn", "360", "--frames", "4", "--size", "40x30",
        "-o", "{number}.png", "--jobs", "1",
    )  # fmt: skip
    assert ran == (0, "", "wrote {number}.png, 4 frames\n")
    assert all(Path(f"{number}.png").exists() for number in range(1, 5))
    first, second, third, _ = (decoded(f"{number}.png")[0] for number in range(1, 5))
    assert not np.array_equal(first, second)
    assert not np.array_equal(second, third)


def test_a_picture_file_cycles_its_colors_without_its_mesh(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--smooth", "1", "--save", "scene.npz").code == 0
    for name in ("scene.toml", "two.obj"):
        (folder / "scene" / name).unlink()
    ran = run("animate", "scene.npz", "--vary", f"{PAINT}=red,blue", "--frames", "5", "-o", "cycle.ramtek")
    assert ran == (0, "", "wrote cycle.ramtek, 5 frames\n")
    ran = run(
        "animate", "scene.npz", "--vary", "view.angle=0,9", "--frames", "5", "-o", "cycle.ramtek", "--force"
    )
    assert ran.code == 65
    assert "an edit of view.angle computes everything again; write a film" in ran.err


def test_with_a_held_exposure_less_light_is_darker(folder: Path, run: Run) -> None:
    for name, options in (("auto.apng", ()), ("held.apng", ("--hold-exposure",))):
        lights = ("--vary", "lights.key.intensity=1,0.2", "--set", "lights.'key.2'.on=false")
        size = ("--frames", "2", "--size", "40x30", "--smooth", "1")
        assert run("animate", "scene", *lights, *options, *size, "-o", name).code == 0
    (bright, same), (first, dark) = (decoded(name) for name in ("auto.apng", "held.apng"))
    assert np.array_equal(bright, first)
    assert dark.mean() < 0.9 * same.mean()


def test_words_can_stand_for_normals_in_a_stream(folder: Path, run: Run) -> None:
    light = ("--vary", "lights.key.intensity=1,0.2", "--frames", "3", "-o", "cycle.ramtek")
    ran = run("animate", "scene", *light)
    assert ran.code == 65
    assert ran.err.endswith(
        "write a film such as .webp, or let words stand for normals (--normals; words='normals' in Python)\n"
    )
    assert run("animate", "scene", *light, "--normals").code == 0


def test_the_loss_of_a_gif_is_printed(folder: Path, run: Run) -> None:
    ran = run(
        "animate", "scene", "--turn", "20", "--frames", "2", "--size", "320x240", "-o", "a.gif", "--once"
    )
    assert ran.code == 0
    assert ran.err.splitlines()[0].startswith("2 of 2 frames lost colors, by at most ")
    with Image.open("a.gif") as film:
        assert "loop" not in film.info


REFUSED = [
    ("scene -o a.webp", 2, "animate must have --vary, --table or --turn; write it as in --turn 360"),
    ("scene --turn 9 --fps 60 -o a.gif", 2, "per second must be a number from 0.1 to 50, not 60.0"),
    ("scene --vary ambiend=0,1 -o a.gif", 2, "--vary ambiend: there is no field 'ambiend'; did you mean"),
    ("scene --vary ambient=1 -o a.gif", 2, "an animation must have at least two variants, or a turn"),
    ("scene --vary ambient=0,-1 -o a.gif", 2, "variant -1: ambient must be a"),
    ("scene --turn 9 -o there.gif", 73, "an output must be a new file, not there.gif, which exists"),
    ("scene --table bad.csv -o a.gif", 65, "bad.csv: the time of '0.2' must be later than the time of '0.1'"),
    ("none --turn 9 -o a.gif", 66, "none"),
]


@pytest.mark.parametrize(("line", "code", "sentence"), REFUSED)
def test_a_wrong_command_line_is_refused_in_a_sentence(
    folder: Path, run: Run, line: str, code: int, sentence: str
) -> None:
    Path("there.gif").write_bytes(b"old")
    Path("bad.csv").write_text("time,ambient\n1,0.1\n1,0.2\n")
    ran = run("animate", *line.split())
    assert (ran.code, ran.out) == (code, "")
    assert sentence in ran.err
    assert sorted(os.listdir()) == ["bad.csv", "scene", "there.gif", "two.obj"]
    assert Path("there.gif").read_bytes() == b"old"
