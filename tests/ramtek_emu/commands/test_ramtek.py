from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

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


def test_without_a_screen_it_says_so_in_one_sentence() -> None:
    run = ramtek()
    assert run.returncode == 69
    assert run.stdout == ""
    assert run.stderr == (
        "ramtek: a window must have a screen, and neither DISPLAY nor WAYLAND_DISPLAY names one; "
        "run it on a desktop, or ask for a picture file instead\n"
    )


def test_a_window_without_a_screen_is_refused_before_a_host_is_told_where_to_connect() -> None:
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


def test_wrong_usage_leaves_with_2() -> None:
    assert ramtek("--nonsense").returncode == 2


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
def test_a_pygame_that_is_missing_or_broken_is_told_with_what_to_install(tmp_path: Path, kind: str) -> None:
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
def test_every_command_that_opens_a_window_tells_what_it_lacks(
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
