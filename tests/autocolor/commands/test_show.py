from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from autocolor import Studio, read_scene
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Run

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng lid\nf 1 2 3 4\n"


def test_a_scene_is_shown_on_a_display_behind_a_port(tmp_path: Path, run: Run) -> None:
    mesh, picture = tmp_path / "square.obj", tmp_path / "shown.png"
    mesh.write_text(SQUARE)
    command = [sys.executable, "-m", "ramtek_emu", "serve", "--port", "0", "--once", "-o", str(picture)]
    root = Path(__file__).parents[3]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=root
    ) as server:
        assert server.stdout is not None
        address = server.stdout.readline().split()[-1]
        ran = run("show", str(mesh), "--to", address)
        if ran.code:
            # It would wait for its host forever.
            server.kill()
        assert (ran.code, ran.out) == (0, "")
        assert ran.err == f"shown on {address}\n"
        server.communicate(timeout=30)
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
