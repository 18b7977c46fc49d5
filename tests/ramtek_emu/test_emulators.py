"""Programs that are not in Python: a client in C, and a simulated PDP-11."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from docs.generate.blocks import blocks_of
from docs.guides.pictures import GUIDES, path_of
from docs.guides.pictures_of_displays import emulators_lines, simulated
from tests.ramtek_emu.processes import ROOT, field_of
from tests.ramtek_emu.serving import serving_at, until

CLIENT = ROOT / "examples" / "ramtek_client.c"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no Unix sockets of packets")
@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc compiles the client")
def test_a_client_in_c_draws_reads_back_and_resets(tmp_path: Path) -> None:
    program = tmp_path / "client"
    subprocess.run(["gcc", "-Wall", "-Wextra", "-Werror", "-o", program, CLIENT], check=True, timeout=60)
    with serving_at(tmp_path / "display") as server:
        done = subprocess.run(
            [program, server.address], stdout=subprocess.PIPE, text=True, check=True, timeout=60
        )
        until(lambda: server.served == 1)
        assert not server.display.words.any()
    assert done.stdout == "the pixel is 5\nafter a reset it is 0\n"


@pytest.mark.skipif(shutil.which("pdp11") is None, reason="SIMH simulates the PDP-11")
def test_a_simulated_pdp11_draws_and_reads_back(tmp_path: Path) -> None:
    printed = simulated(tmp_path)
    (shown,) = (
        block.text
        for block in blocks_of((GUIDES / "emulators.md").read_text("utf-8"))
        if block.text.startswith("HALT")
    )
    assert printed.replace("\r", "").endswith(shown)
    with Image.open(path_of(emulators_lines)) as picture:
        assert (field_of(tmp_path / "lines.png") == np.asarray(picture.convert("RGB"))).all()
