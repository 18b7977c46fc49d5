from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from autocolor import write_palette
from autocolor.commands.outputs import progress
from tests.autocolor.commands.conftest import ROOT, Run

COLOR = "surfaces.side.object_color"
SMALL = ("--size", "32x24", "--smooth", "1")


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
    with Image.open("out/08-1f3f8f-2.png") as one, Image.open("one.png") as other:
        assert one.tobytes() == other.tobytes()
    with open("made.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["name"], row[COLOR], row["lights.key.intensity"]) for row in rows[3:5]] == [
        ("red-2", "red", "2"),
        ("1f3f8f-0.5", "#1f3f8f", "0.5"),
    ]
    with Image.open("sheet.png") as sheet:
        assert sheet.width > sheet.height


def test_a_picture_file_is_recolored_and_the_palette_names_its_colors(folder: Path, run: Run) -> None:
    assert run("render", "scene", "--save", "saved.npz", *SMALL).code == 0
    write_palette("paints.gpl", ["#102030", "#ff0000"], names=["Deep sea", "Red"])
    ran = run("sweep", "saved.npz", "--vary", f"{COLOR}=@paints.gpl", "-o", "{name}.webp")
    assert (ran.code, ran.err) == (0, "made 2 pictures\n")
    assert run("recolor", "saved.npz", "side", "--object", "#ff0000", "-o", "red.png").code == 0
    with Image.open("Red.webp") as one, Image.open("red.png") as other:
        assert one.convert("RGB").tobytes() == other.tobytes()
    assert Path("Deep sea.webp").exists()


def test_a_table_is_multiplied_and_a_batch_is_resumed_by_processes(folder: Path, run: Run) -> None:
    Path("looks.csv").write_text("name,ambient,view.angle\ndark,0,\ntilted,0.2,10\n")
    arguments = ("sweep", "scene", "--table", "looks.csv", "--vary", f"{COLOR}=red,navy", *SMALL)
    assert run(*arguments, "-o", "a-{name}.png").err.endswith("made 4 pictures\n")
    ran = run(*arguments, "-o", "b-{name}.png", "--jobs", "2")
    assert ran.err.endswith("made 4 pictures\n")
    for name in ("dark-red", "dark-navy", "tilted-red", "tilted-navy"):
        assert Path(f"a-{name}.png").read_bytes() == Path(f"b-{name}.png").read_bytes()
    Path("a-dark-red.png").unlink()
    ran = run(*arguments, "-o", "a-{name}.png", "--resume")
    assert ran.err.endswith("made 1 picture, 3 were there\n")
    assert run(*arguments, "-o", "a-{name}.png").code == 73
    assert run(*arguments, "-o", "a-{name}.png", "--force").err.endswith("made 4 pictures\n")


@pytest.mark.parametrize(
    ("values", "strict", "code"), [("0.1,x", (), 0), ("0.1,x", ("--strict",), 1), ("x,-1", (), 65)]
)
def test_failed_variants_are_listed(
    folder: Path, run: Run, values: str, strict: tuple[str, ...], code: int
) -> None:
    ran = run("sweep", "scene", "--vary", f"ambient={values}", "-o", "{name}.png", *strict, *SMALL)
    assert ran.code == code
    assert "autocolor: x: ambient must be a finite number of at least 0, not 'x'\n" in ran.err
    assert ran.err.endswith("2 failed\n" if code == 65 else "made 1 picture, 1 failed\n")


def test_a_paint_that_variants_unset_is_told_once(folder: Path, run: Run) -> None:
    side = "surfaces.side"
    ramps = ("--vary", f"{side}.ramp=[red,blue],[red,white],[red,navy]")
    told = "autocolor: side: the ramp replaces its two colors and their blend\n"
    assert run("sweep", "scene", *ramps, "-o", "{name}.png", *SMALL).err == f"{told}made 3 pictures\n"
    ran = run("animate", "scene", *ramps, "--frames", "6", "-o", "a.webp", *SMALL)
    assert ran.err == f"{told}wrote a.webp, 6 frames\n"
    back = "autocolor: side: two colors and their blend replace its ramp\n"
    settings = ("--set", f"{side}.ramp=red,blue", "--vary", f"{COLOR}=no,red,navy")
    assert run("sweep", "scene", *settings, "-o", "b-{name}.png", *SMALL).err.startswith(told + back)
    assert run("render", "scene", "--save", "saved.npz", *SMALL).code == 0
    assert run("sweep", "saved.npz", *settings, "-o", "c-{name}.png").err.startswith(told + back)
    nothing = ("--vary", f"{COLOR}=red", "--vary", "ambient=0,1")
    assert run("sweep", "scene", *nothing, "-o", "d-{name}.png", *SMALL).err == "made 2 pictures\n"


def test_the_table_of_results_is_never_written_over_the_table_of_variants(folder: Path, run: Run) -> None:
    Path("looks.csv").write_text("ambient\n1\n")
    arguments = ("--table", "looks.csv", "--made", "./looks.csv", "--force", "-o", "{name}.png")
    ran = run("sweep", "scene", *arguments, *SMALL)
    assert (ran.code, ran.err) == (
        2,
        "autocolor: --made must be a file of its own, not ./looks.csv, which is read; name another\n",
    )
    assert Path("looks.csv").read_text() == "ambient\n1\n"


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        ((), 2, "sweep must have --vary or --table; write it as in"),
        (("--vary", "ambient"), 2, "--vary must be KEY=A,B,C"),
        (("--vary", "ambiet=1,2"), 2, "--vary ambiet: there is no field 'ambiet'; did you mean 'ambient'?"),
        (("--table", "t.csv"), 65, "t.csv, column ambiet: there is no field 'ambiet'; did you mean"),
        (("--table", "no.csv"), 66, "no.csv"),
        (("--vary", f"{COLOR}=@no.gpl"), 66, "no.gpl"),
        (("--vary", "ambient=1,2", "--set", "ambiet=1"), 2, "--set ambiet: there is no field"),
        (("--vary", "ambient=1,2", "--sheet", "a.jpg"), 2, "a contact sheet must be written to a file that"),
    ],
)
def test_a_wrong_command_line_is_refused_before_anything_is_made(
    folder: Path, run: Run, arguments: tuple[str, ...], code: int, sentence: str
) -> None:
    Path("t.csv").write_text("ambiet\n1\n")
    before = sorted(os.listdir())
    ran = run("sweep", "scene", *arguments, "-o", "{name}.png", *SMALL)
    assert ran.code == code
    assert sentence in ran.err
    assert sorted(os.listdir()) == before


def test_a_terminal_gets_a_progress_bar_with_the_time_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with progress(2) as step:
        step()
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress(2) as step:
        step()
        step()
        print("message", file=sys.stderr)
    # The bar has ended its line before the message.
    *_, bar, message, end = capsys.readouterr().err.split("\n")
    assert "2/2" in bar
    assert (message.removeprefix("\x1b[?25h"), end) == ("message", "")


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGINT")
def test_an_interrupted_sweep_ends_its_processes_and_leaves_whole_files(folder: Path) -> None:
    command = [
        sys.executable, "-m", "autocolor", "sweep", "scene", "--vary", "ambient=0:1:5000", "-o",
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
    assert 0 < len(names) < 5000
    for name in names:
        with Image.open(Path("out") / name) as image:
            image.load()
