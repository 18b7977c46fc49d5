from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image

from ramtek_emu import Ramtek9300
from tests.ramtek_emu import processes
from tests.ramtek_emu.recorded_streams import SQUARES, words

DATA = SQUARES.astype("<u2").tobytes()


def run(*arguments: str, data: bytes = b"", code: int = 0) -> subprocess.CompletedProcess[bytes]:
    done = processes.run(*arguments, data=data)
    assert done.returncode == code, done.stderr
    return done


def test_a_picture_at_an_instruction(tmp_path: Path) -> None:
    display = Ramtek9300()
    display.send(SQUARES[:9])
    run("inspect", "-", "--at", "2", "-o", str(tmp_path / "a.png"), data=DATA)
    assert (np.asarray(Image.open(tmp_path / "a.png").convert("RGB")) == display.field()).all()
    refused = run("inspect", "-", "-o", str(tmp_path / "a.png"), data=DATA, code=73)
    assert "--force" in refused.stderr.decode()


def test_who_wrote_a_pixel_is_listed_with_the_newest_first() -> None:
    lines = run("inspect", "-", "--who", "31", "31", data=DATA).stdout.decode().splitlines()
    assert [line.split()[:4] for line in lines] == [["2", "0000", "->", "0004"]]
    assert lines[0].endswith("ERS BACK=4")
    asked = json.loads(run("inspect", "-", "--who", "0", "0", "--json", data=DATA).stdout)
    assert [write["number"] for write in asked] == [4, 2]
    assert asked[0]["instruction"]["name"] == "WT"
    early = json.loads(run("inspect", "-", "--who", "0", "0", "--json", "--at", "3", data=DATA).stdout)
    assert early == asked[1:]


def test_who_wrote_an_entry() -> None:
    data = np.array([0x0300, 20, 4, 0xFF00, 0x0012, 0x0700], "<u2").tobytes()
    (line,) = run("inspect", "-", "--who-entry", "10", data=data).stdout.decode().splitlines()
    assert line.split()[:4] == ["1", "000000", "->", "12FF00"]
    silent = run("inspect", "-", "--who-entry", "11", data=data)
    assert silent.stdout == b""
    assert "writes entry 11" in silent.stderr.decode()


def test_a_moment_in_json() -> None:
    moment = json.loads(run("inspect", "-", "--at", "3", "--json", data=DATA).stdout)
    assert moment["number"] == 3
    assert moment["instruction"]["name"] == "SET"
    assert (moment["foreground"], moment["background"]) == (4, 0)


def test_the_number_of_an_instruction_is_its_line_in_a_listing_in_json() -> None:
    data = words("A3FF").astype("<u2").tobytes() + DATA
    lines = run("list", "-", "--json", data=data).stdout.decode().splitlines()
    for number in (1, 2, len(lines)):
        listed = json.loads(lines[number - 1].strip("[ ,]"))
        moment = json.loads(run("inspect", "-", "--at", str(number), "--json", data=data).stdout)
        assert (moment["of"], moment["instruction"]["place"]) == (len(lines), listed["place"])


def test_numbers_beyond_the_stream_and_the_memory_are_refused() -> None:
    for arguments in (
        ("--at", "9999"),
        ("--who", "480", "0"),
        ("--who", "0", "640"),
        ("--who-entry", "1024"),
    ):
        refused = run("inspect", "-", *arguments, "--json", data=DATA, code=2).stderr.decode()
        assert "choose a smaller number" in refused
    refused = run("inspect", "-", "--who", "0", "0", "--who-entry", "1", data=DATA, code=2).stderr.decode()
    assert "ask twice" in refused
