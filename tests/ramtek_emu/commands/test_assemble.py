from __future__ import annotations

from pathlib import Path

import numpy as np

from tests.ramtek_emu.processes import run
from tests.ramtek_emu.recorded_streams import OUTLINE, SQUARES


def test_the_commands_list_and_assemble_over_pipes_and_files(tmp_path: Path) -> None:
    data = np.concatenate((OUTLINE, SQUARES)).astype("<u2").tobytes() + b"!"
    listed = run("list", "-", data=data)
    assert listed.returncode == 0
    assert listed.stderr == b""
    assert run("assemble", "-", "-o", "-", data=listed.stdout).stdout == data
    (tmp_path / "listing.txt").write_bytes(listed.stdout)
    target = tmp_path / "again.ramtek"
    assert run("assemble", str(tmp_path / "listing.txt"), "-o", str(target)).returncode == 0
    assert target.read_bytes() == data
    assert run("assemble", str(tmp_path / "listing.txt"), "-o", str(target)).returncode == 73
    assert run("assemble", str(tmp_path / "none.txt"), "-o", "-").returncode == 66
    wrong = run("assemble", "-", "-o", "-", data=b"NOP\nDRAW\n")
    assert wrong.returncode == 65
    assert wrong.stderr.startswith(b"ramtek: line 2: an instruction must be one of the table")
