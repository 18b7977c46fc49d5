"""A folder to run commands in, with a small mesh, and two ways to run one: here, and in its own process."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from autocolor.commands.autocolor import autocolor
from ramtek_emu.command_line import run_command
from tests.autocolor.files.store.stores import contents
from tests.small import TWO_PARTS, scene_folder

ROOT = Path(__file__).parents[3]
SMALL = ("--size", "32x24", "--smooth", "1")
"""Options for a picture whose size is not the subject."""


class Ran(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str


Run = Callable[..., Ran]
Refused = Callable[..., str]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder: two.obj, a mesh of two parts, and scene/scene.toml, a scene of it."""
    (tmp_path / "two.obj").write_text(TWO_PARTS)
    scene_folder(tmp_path / "scene")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run `autocolor` with the arguments in this process."""

    def run_here(*arguments: str) -> Ran:
        monkeypatch.setattr(sys, "argv", ["autocolor", *arguments])
        capsys.readouterr()
        with pytest.raises(SystemExit) as left:
            run_command(autocolor, "autocolor")
        out, err = capsys.readouterr()
        assert isinstance(left.value.code, int)
        return Ran(left.value.code, out, err)

    return run_here


@pytest.fixture
def saved(folder: Path, run: Run) -> Path:
    """A saved picture of the scene, scene.npz, beside its picture scene.png."""
    assert run("render", "scene", *SMALL, "-o", "scene.png", "--save", "scene.npz").code == 0
    return folder / "scene.npz"


@pytest.fixture
def refused(folder: Path, run: Run) -> Refused:
    """Run a line that must end with a code, print nothing on stdout and leave all files as they are.

    Returns the last line on stderr, a sentence of the command or of click.
    """

    def run_refused(line: str, code: int) -> str:
        before = contents(folder)
        ran = run(*shlex.split(line))
        assert (ran.code, ran.out) == (code, "")
        assert contents(folder) == before
        *_, last = ran.err.splitlines()
        assert last.startswith(("autocolor: ", "Error: "))
        assert len(last) > 25
        return last.removeprefix("autocolor: ")

    return run_refused


@pytest.fixture
def process(folder: Path) -> Run:
    """Run `autocolor` with the arguments in a process of its own, without a screen."""

    def run_process(*arguments: str, **options: Any) -> Ran:
        hidden = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "OPENBLAS_NUM_THREADS")
        environment = {key: value for key, value in os.environ.items() if key not in hidden}
        environment |= {"PYTHONPATH": str(ROOT), **options.pop("environment", {})}
        command = options.pop("command", [sys.executable, "-m", "autocolor", *arguments])
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        done: subprocess.CompletedProcess[bytes] = subprocess.run(
            command, cwd=folder, env=environment, timeout=60, check=False, **streams
        )
        out, err = ((data or b"").decode(errors="replace") for data in (done.stdout, done.stderr))
        return Ran(done.returncode, out, err)

    return run_process


def pixels(path: str | Path) -> npt.NDArray[np.uint8]:
    """The colors of a picture file such as a PNG, (lines, elements, 3)."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def is_same(*names: str) -> bool:
    """Whether files have the same bytes."""
    return len({Path(name).read_bytes() for name in names}) == 1
