from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from ramtek_emu.command_line import run_command
from ramtek_emu.commands.ramtek import ramtek as ramtek_group
from tests.ramtek_emu.processes import ROOT


def ramtek(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    without_screen = {
        key: value
        for key, value in os.environ.items()
        if key not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    }
    return subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *arguments],
        cwd=ROOT,
        env={**without_screen, "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_a_missing_screen_is_reported_in_one_sentence() -> None:
    run = ramtek()
    assert run.returncode == 69
    assert run.stdout == ""
    assert run.stderr == (
        "ramtek: a window must have a screen, and neither DISPLAY nor WAYLAND_DISPLAY names one; "
        "run it on a desktop, or ask for a picture file instead\n"
    )


def test_a_window_without_a_screen_is_refused_before_the_address_is_printed() -> None:
    run = ramtek("serve", "--port", "0", "--window")
    assert (run.returncode, run.stdout) == (69, "")
    assert run.stderr.startswith("ramtek: a window must have a screen")


def test_a_screen_that_does_not_answer_is_no_screen() -> None:
    run = ramtek(DISPLAY=":4711")
    assert run.returncode == 69
    assert "a window must have a screen" in run.stderr
    assert "Traceback" not in run.stderr


def test_the_pattern_goes_to_a_picture_file_once(tmp_path: Path) -> None:
    path = tmp_path / "pattern.png"
    assert ramtek("-o", str(path)).returncode == 0
    assert path.stat().st_size > 1000
    again = ramtek("-o", str(path))
    assert again.returncode == 73
    assert again.stderr == (
        f"ramtek: an output must be a new file, not {path}, which exists; "
        "choose another name, or overwrite it with --force (overwrite=True in Python)\n"
    )
    assert ramtek("-o", str(path), "--force").returncode == 0


def test_help_shows_an_example() -> None:
    run = ramtek("--help")
    assert run.returncode == 0
    assert "ramtek -o pattern.png" in run.stdout


OUTPUT = "Error: an output must be the name of a file, not {!r}; give it one"
FOLDER = (
    "ramtek: an output must have a folder to be in, and there is no folder {}; "
    "make it, or choose another place"
)
CONFIGURATION = (
    "ramtek: a configuration must be one of GMR_9300, JPL_9460, NCAR_9460, PRINCETON_9300, not {!r}; "
    "did you mean GMR_9300?"
)
INPUT = "Error: an input must be the name of a file, not ''; give it one"
MISSING = (
    "ramtek: a stream must be a file that can be read, not 'none' (no such file or directory); check the name"
)
WAYS = "Error: a display must be served on one of --port, --unix and --stdio; give one of them"
JOYSTICK = (
    "ramtek: a joystick's lines must come from a file or a FIFO that can be read, not {!r} ({}); "
    "make a FIFO with mkfifo, or give - for stdin"
)
REFUSED = (
    ("plai", 2, "Error: there is no command 'plai'; did you mean 'play'?"),
    ("--nonsense", 2, "Error: No such option"),
    ("-o -", 2, OUTPUT.format("-")),
    ("-o ''", 2, OUTPUT.format("")),
    ("--configuration gmr_9301 -o x.png", 2, CONFIGURATION.format("gmr_9301")),
    ("play", 2, "Error: Missing argument 'STREAM'."),
    ("play none", 66, MISSING),
    ("play .", 66, "ramtek: a stream must be a file, not the folder .; name a file in it"),
    ("play ''", 2, INPUT),
    ("play - -o x.png --configuration gmr", 2, CONFIGURATION.format("gmr")),
    (
        "play - -o x.png --configuration gmr_9300 --start s.png",
        2,
        "Error: a display must be given by --configuration or --start; leave one out",
    ),
    (
        "play - -o x.png --loads-per-second 30",
        2,
        "Error: --loads-per-second is for the window; add --window, or leave it out",
    ),
    ("play - --loads-per-second nan", 2, "Error: Invalid value for '--loads-per-second'"),
    ("play - --loads-per-second 0", 2, "Error: Invalid value for '--loads-per-second'"),
    ("list none", 66, MISSING),
    ("list ''", 2, INPUT),
    ("list none --configuration gmr_9301", 2, CONFIGURATION.format("gmr_9301")),
    ("assemble none -o ''", 2, OUTPUT.format("")),
    ("assemble none -o /none/at/all", 73, FOLDER.format("/none/at")),
    ("serve", 2, WAYS),
    ("serve --stdio --port 1", 2, WAYS),
    ("serve --port 0 --unix x", 2, WAYS),
    ("serve --port 70000", 2, "Error: Invalid value for '--port'"),
    ("serve --stdio --configuration gmr_9301", 2, CONFIGURATION.format("gmr_9301")),
    ("serve --stdio -o /none/at/all.png", 73, FOLDER.format("/none/at")),
    ("serve --stdio -o -", 2, OUTPUT.format("-")),
    (
        "serve --stdio --joystick -",
        2,
        "Error: stdin must be for words or for the joystick, not both; give --joystick a FIFO",
    ),
    ("serve --stdio --joystick none", 66, JOYSTICK.format("none", "no such file or directory")),
    ("serve --port 0 --joystick ''", 66, JOYSTICK.format("", "no such file or directory")),
    ("serve --port 0 --joystick .", 66, JOYSTICK.format(".", "is a directory")),
    (
        "tty none -- 'no such program'",
        66,
        "ramtek: a program must be executable, not 'no such program'; check its name",
    ),
    (
        "tty none -- true",
        69,
        "ramtek: a display must listen at none, and it is not reached (no such file or directory); "
        "start `ramtek serve --unix none`",
    ),
)
"""Arguments, the exit code, and the sentence on stderr, or the start of click's sentence."""


@pytest.mark.parametrize(("arguments", "code", "sentence"), REFUSED)
def test_a_command_that_cannot_be_done_is_refused(
    arguments: str,
    code: int,
    sentence: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["ramtek", *shlex.split(arguments)])
    with pytest.raises(SystemExit) as left:
        run_command(ramtek_group, "ramtek")
    out, err = capsys.readouterr()
    assert (left.value.code, out) == (code, "")
    assert err.splitlines()[-1].startswith(sentence)


BROKEN = {
    "missing": "raise ModuleNotFoundError(\"No module named 'pygame'\", name='pygame')",
    "half installed": "import pygame.base",
    "without its library": "raise OSError('libSDL2-2.0.so.0: cannot open shared object file')",
    "of another machine": "raise RuntimeError('built for another numpy')",
    "of another version": "import sys; sys.nothing",
    "a stub": "",
    "silent": "raise ImportError",
}


def without_pygame(folder: Path, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    (folder / "pygame.py").write_text(program, "utf-8")
    return ramtek(*arguments, PYTHONPATH=f"{folder}{os.pathsep}{ROOT}")


@pytest.mark.parametrize("kind", BROKEN)
def test_a_missing_or_broken_pygame_is_reported_with_the_package_to_install(
    tmp_path: Path, kind: str
) -> None:
    run = without_pygame(tmp_path, BROKEN[kind])
    assert (run.returncode, run.stdout) == (69, "")
    assert run.stderr.startswith("ramtek: a window must have pygame, and it cannot be loaded (")
    name = "pygame" if sys.version_info < (3, 14) else "pygame-ce"
    assert run.stderr.endswith(
        f"); install it with `pip install {name}`, or ask for a picture file instead\n"
    )
    assert "()" not in run.stderr


@pytest.mark.parametrize(
    "arguments", [("play", "-"), ("serve", "--stdio", "--window"), ("serve", "--port", "0", "--window")]
)
def test_every_command_with_a_window_reports_a_missing_pygame(
    tmp_path: Path, arguments: tuple[str, ...]
) -> None:
    run = without_pygame(tmp_path, BROKEN["missing"], *arguments)
    assert run.returncode == 69
    assert run.stderr.count("\n") == 1
    assert "pip install pygame" in run.stderr
    debugged = without_pygame(tmp_path, BROKEN["missing"], *arguments, "--debug")
    assert debugged.returncode == 69
    assert "Traceback" in debugged.stderr


def test_a_picture_needs_no_pygame(tmp_path: Path) -> None:
    path = tmp_path / "pattern.png"
    assert without_pygame(tmp_path, BROKEN["missing"], "-o", str(path)).returncode == 0
    assert path.stat().st_size > 1000


@pytest.mark.skipif(os.name != "posix", reason="pipes end otherwise there")
@pytest.mark.parametrize(
    "arguments",
    [
        "list words",
        "list words --json",
        "assemble listing -o -",
        "serve --port 0 --once",
        "--help",
        "play -h",
    ],
)
def test_a_reader_that_leaves_ends_every_command_in_silence(tmp_path: Path, arguments: str) -> None:
    (tmp_path / "words").write_bytes(bytes(1000))
    (tmp_path / "listing").write_text("raw 0700\n", "ascii")
    read_end, write_end = os.pipe()
    os.close(read_end)
    left = subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *arguments.split()],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        stdout=write_end,
        stderr=subprocess.PIPE,
        timeout=60,
        check=False,
    )
    os.close(write_end)
    assert (left.returncode, left.stderr) == (141, b"")
