from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

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
        "choose another name or add --force\n"
    )
    assert ramtek("-o", str(path), "--force").returncode == 0


def test_help_shows_an_example() -> None:
    run = ramtek("--help")
    assert run.returncode == 0
    assert "ramtek -o pattern.png" in run.stdout


def test_wrong_usage_leaves_with_2() -> None:
    assert ramtek("--nonsense").returncode == 2
