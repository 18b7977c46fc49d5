from __future__ import annotations

from pathlib import Path

import numpy as np

from ramtek_emu import read_snapshot
from tests.ramtek_emu.processes import field_of, run, stream
from tests.ramtek_emu.recorded_streams import COLOR_MAP, OUTLINE


def test_a_played_stream_gives_its_picture_its_recording_and_its_snapshot(tmp_path: Path) -> None:
    path, picture, record = tmp_path / "a.ramtek", tmp_path / "a.png", tmp_path / "b.ramtek"
    path.write_bytes(stream(np.concatenate((COLOR_MAP, OUTLINE))) + b"!")
    arguments = ("play", path, "-o", picture, "--record", record, "--snapshot", tmp_path / "s.png")
    played = run(*arguments, "--configuration", "Princeton-9300")
    assert played.returncode == 0, played.stderr
    display = read_snapshot(tmp_path / "s.png")
    assert display.configuration.name == "PRINCETON_9300"
    assert display.words.any()
    assert (field_of(picture) == display.field()).all()
    assert record.read_bytes() == path.read_bytes()[:-1]
    again = run(*arguments)
    assert again.returncode == 73
    assert (
        b"which exists; choose another name, or overwrite it with --force (overwrite=True in Python)"
        in again.stderr
    )
    assert run("play", "-", "-o", picture, "--force", data=record.read_bytes()).returncode == 0
    assert run("play", path, "--loads-per-second", "30").returncode == 69
