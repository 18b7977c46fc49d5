from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import Studio, read_journal, read_scene
from autocolor.commands.demo import demo_folder
from autocolor.commands.show import folder_of
from autocolor.journal.autosave import JOURNAL, left_sessions
from autocolor.journal.places import Source
from ramtek_emu import Ramtek9300
from ramtek_emu.host.server import TcpServer
from tests.autocolor.commands.conftest import Run

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng lid\nf 1 2 3 4\n"


def test_a_picture_is_shown_once_on_a_display_behind_a_port(tmp_path: Path, run: Run) -> None:
    mesh, picture = tmp_path / "square.obj", tmp_path / "shown.png"
    mesh.write_text(SQUARE)
    command = [sys.executable, "-m", "ramtek_emu", "serve", "--port", "0", "--once", "-o", str(picture)]
    root = Path(__file__).parents[3]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=root
    ) as server:
        assert server.stdout is not None
        address = server.stdout.readline().split()[-1]
        ran = run("show", str(mesh), "--to", address, "--once")
        if ran.code:
            # It would wait for its host forever.
            server.kill()
        assert (ran.code, ran.out) == (0, "")
        assert ran.err == f"shown on {address}\n"
        server.communicate(timeout=60)
        assert server.returncode == 0
    display = Ramtek9300()
    Studio(read_scene(mesh), display)
    with Image.open(picture) as image:
        assert (np.asarray(image.convert("RGB")) == display.field()).all()


@pytest.mark.parametrize("address", ["127.0.0.1:9300", "tcp://127.0.0.1:0", "http://x:1"])
def test_what_is_no_address_is_refused_in_a_sentence(address: str, tmp_path: Path, run: Run) -> None:
    (tmp_path / "square.obj").write_text(SQUARE)
    ran = run("show", str(tmp_path / "square.obj"), "--to", address)
    assert ran.code == 2
    assert ran.err.startswith("autocolor: --to: an address must be tcp://host:port")


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        ((), "show must have SCENE or --recover, one of them; name a scene"),
        (("scene", "--recover", "newest"), "show must have SCENE or --recover, one of them; name a scene"),
        (("--recover", "--once"), "--set and --once are for SCENE, not for sessions; leave them out"),
    ],
)
def test_a_scene_or_a_session_is_shown(folder: Path, run: Run, arguments: tuple[str, ...], rule: str) -> None:
    ran = run("show", "--to", "tcp://127.0.0.1:1", *arguments)
    assert (ran.code, ran.err) == (2, f"autocolor: {rule}\n")


def test_a_display_that_is_not_there_is_told(folder: Path, run: Run) -> None:
    ran = run("show", "scene", "--to", "tcp://127.0.0.1:1")
    assert ran.code == 69
    assert ran.err.startswith("autocolor: a display must listen at tcp://127.0.0.1:1, and it is not reached")


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 128 + signal.SIGTERM)])
def test_a_session_that_is_ended_by_a_signal_is_recovered(
    folder: Path, number: int, code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The joystick turns the object by TRACK, before and after the session is recovered."""
    with TcpServer(Ramtek9300()) as server:

        def start(*arguments: str) -> subprocess.Popen[str]:
            return subprocess.Popen(
                [sys.executable, "-m", "autocolor", "show", *arguments, "--to", server.address],
                cwd=folder,
                env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])},
                stderr=subprocess.PIPE,
                text=True,
            )

        polls = 0
        state_of = server.display.cursors.state_of

        def counted(number: int) -> int:
            nonlocal polls
            polls += 1
            return state_of(number)

        monkeypatch.setattr(server.display.cursors, "state_of", counted)

        def serve_polls(process: subprocess.Popen[str]) -> None:
            """Serve until the program has handled the joystick as it is now."""
            end, wanted = time.monotonic() + 60, polls + 3
            while polls < wanted and process.poll() is None:
                assert time.monotonic() < end
                server.step(0.01)

        for arguments in (("scene", "--set", "ambient=0.3"), ("--recover",)):
            process = start(*arguments)
            joystick = server.display.joystick
            serve_polls(process)
            joystick.move_to(300, 200)
            serve_polls(process)
            joystick.track = True
            serve_polls(process)
            joystick.move_to(340, 210)
            serve_polls(process)
            joystick.track = False
            serve_polls(process)
            process.send_signal(number)
            while process.poll() is None or server.busy:
                server.step(0.01)
            _, err = process.communicate(timeout=60)
            assert process.returncode == code, err
    (left,) = left_sessions()
    history = read_journal(left / JOURNAL).history
    assert len(history.to_undo) == 2
    assert history.start.ambient == 0.3


def test_files_are_in_the_folder_of_the_scene_and_never_in_that_of_the_demo(folder: Path) -> None:
    assert folder_of(Source("scene")) == folder / "scene"
    assert folder_of(Source("scene/scene.toml")) == folder / "scene"
    assert folder_of(Source("two.obj")) == folder
    assert folder_of(Source(str(demo_folder()))) == folder
