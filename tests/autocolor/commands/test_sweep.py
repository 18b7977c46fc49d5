from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import image, read_picture, write_palette
from tests.autocolor.commands.conftest import ROOT, SMALL, Refused, Run, is_same, pixels

COLOR = "surfaces.side.object_color"


def test_each_picture_is_that_of_render_with_the_same_settings(folder: Path, run: Run) -> None:
    ran = run(
        "sweep", "scene", "--vary", f"{COLOR}=red,#1f3f8f", "--vary", "lights.key.intensity=0.5:2:4",
        "--set", "ambient=0.2", "-o", "out/{number:02}-{name}.png", "--sheet", "sheet.png",
        "--made", "made.csv", *SMALL,
    )  # fmt: skip
    assert (ran.code, ran.out, ran.err.splitlines()[-1]) == (0, "", "made 8 pictures")
    names = sorted(os.listdir("out"))
    assert names[:2] == ["01-red-0.5.png", "02-red-1.png"]
    assert names[7] == "08-1f3f8f-2.png"
    settings = ("--set", f"{COLOR}=#1f3f8f", "--set", "lights.key.intensity=2", "--set", "ambient=0.2")
    assert run("render", "scene", *settings, "-o", "one.png", *SMALL).code == 0
    assert np.array_equal(pixels("out/08-1f3f8f-2.png"), pixels("one.png"))
    with open("made.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["name"], row[COLOR], row["lights.key.intensity"]) for row in rows[3:5]] == [
        ("red-2", "red", "2"),
        ("1f3f8f-0.5", "#1f3f8f", "0.5"),
    ]
    with Image.open("sheet.png") as sheet:
        assert sheet.width > sheet.height


def test_a_picture_file_is_recolored_and_the_palette_names_its_colors(saved: Path, run: Run) -> None:
    write_palette("paints.gpl", ["#102030", "#ff0000"], names=["Deep sea", "Red"])
    ran = run("sweep", "scene.npz", "--vary", f"{COLOR}=@paints.gpl", "-o", "{name}.webp")
    assert (ran.code, ran.err) == (0, "made 2 pictures\n")
    assert run("recolor", "scene.npz", "side", "--object", "#ff0000", "-o", "red.png").code == 0
    assert np.array_equal(pixels("Red.webp"), pixels("red.png"))
    assert Path("Deep sea.webp").exists()


def test_a_size_given_for_a_smooth_picture_file_is_that_of_its_image(
    folder: Path, run: Run, refused: Refused
) -> None:
    """Of 135 x 90 samples, which are 45 x 30 pixels."""
    assert run("render", "scene", "--size", "45x30", "--smooth", "3", "--save", "a.npz").code == 0
    line = f"sweep a.npz --vary {COLOR}=red -o {{name}}.png --force"
    scene, picture = read_picture("a.npz")
    red = image(scene.with_surface("side", object_color="red"), picture)
    for options in ("", "--size 45x30 --smooth 3"):
        assert run(*line.split(), *options.split()) == (0, "", "made 1 picture\n")
        assert np.array_equal(pixels("red.png"), red)
    for options in ("--size 135x90", "--smooth 1"):
        refused(f"{line} {options}", 2)


def test_a_table_is_multiplied_and_a_batch_is_resumed_by_processes(folder: Path, run: Run) -> None:
    Path("looks.csv").write_text("name,ambient,view.angle\ndark,0,\ntilted,0.2,10\n")
    arguments = ("sweep", "scene", "--table", "looks.csv", "--vary", f"{COLOR}=red,navy", *SMALL)
    for name, jobs in (("a", ()), ("b", ("--jobs", "2"))):
        assert run(*arguments, "-o", f"{name}-{{name}}.png", *jobs).err.endswith("made 4 pictures\n")
    for name in ("dark-red", "dark-navy", "tilted-red", "tilted-navy"):
        assert is_same(f"a-{name}.png", f"b-{name}.png")
    Path("a-dark-red.png").unlink()
    ran = run(*arguments, "-o", "a-{name}.png", "--resume")
    assert ran.err.endswith("made 1 picture, 3 were there\n")
    assert run(*arguments, "-o", "a-{name}.png").code == 73


@pytest.mark.parametrize(
    ("values", "strict", "code"),
    [("0.1,x", (), 0), ("0.1,x", ("--strict",), 1), ("x,-1", (), 65), ("0.1,0.2", ("--strict",), 0)],
)
def test_failed_variants_are_listed(
    folder: Path, run: Run, values: str, strict: tuple[str, ...], code: int
) -> None:
    ran = run("sweep", "scene", "--vary", f"ambient={values}", "-o", "{name}.png", *strict, *SMALL)
    assert ran.code == code
    assert ("autocolor: x: ambient must be" in ran.err) == ("x" in values)
    counts = {"0.1,x": "made 1 picture, 1 failed", "x,-1": "not -1"}
    assert ran.err.endswith(f"{counts.get(values, 'made 2 pictures')}\n")
    assert "Warning" not in ran.err


@pytest.mark.parametrize("smooth", ["1", "2"])
def test_the_exposure_is_held_as_render_and_animate_hold_it(saved: Path, run: Run, smooth: str) -> None:
    """It is the exposure of the scene before --set, of a picture that is as smooth."""
    key = "lights.key.intensity"
    common = ("--hold-exposure", "--set", "lights.key.on=true", "--set", "ambient=0.01", *SMALL[:2])
    options = (*common, "--smooth", smooth)
    assert run("render", "scene", *options, "--set", f"{key}=0.3", "-o", "render.png").code == 0
    assert run("sweep", "scene", *options, "--vary", f"{key}=0.3", "-o", "{name}.png").code == 0
    film = ("--vary", f"{key}=0.3,1", "--frames", "2", "-o", "film.webp")
    assert run("animate", "scene", *options, *film).code == 0
    assert np.array_equal(pixels("0.3.png"), pixels("render.png"))
    assert np.array_equal(pixels("film.webp"), pixels("render.png"))
    # A picture file has the exposure of its picture.
    vary = ("--vary", "mapping=gamma")
    for name, more in (("held", ("--hold-exposure",)), ("auto", ())):
        assert run("sweep", "scene.npz", *vary, *more, "-o", f"{name}.png").code == 0
    assert np.array_equal(pixels("held.png"), pixels("auto.png"))


def test_a_sheet_has_the_columns_that_are_asked_for(folder: Path, run: Run) -> None:
    sheet = ("--sheet", "s.png", "--columns", "4", *SMALL)
    assert run("sweep", "scene", "--vary", "ambient=0:1:4", "-o", "{name}.png", *sheet).code == 0
    with Image.open("s.png") as image:
        assert image.width > 4 * 160


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGINT")
@pytest.mark.thorough
def test_an_interrupted_sweep_ends_its_processes_and_leaves_whole_files(folder: Path) -> None:
    command = [
        sys.executable, "-m", "autocolor", "sweep", "scene", "--vary", "ambient=0:1:2000", "-o",
        "out/{number}.png", "--jobs", "2", *SMALL,
    ]  # fmt: skip
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        assert process.stderr is not None
        while not any(folder.glob("out/*.png")):
            assert process.poll() is None, process.stderr.read()
        os.killpg(process.pid, signal.SIGINT)
        # All processes hold stderr: it ends when the last of them has ended.
        assert process.stderr.read() == "autocolor: interrupted\n"
    assert process.returncode == 130
    names = os.listdir("out")
    assert 0 < len(names) < 2000
    for name in names:
        with Image.open(Path("out") / name) as picture:
            picture.load()
