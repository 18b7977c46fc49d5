from __future__ import annotations

import json
import subprocess
from pathlib import Path

from ramtek_emu.commands.diff import lines_of
from tests.ramtek_emu import processes
from tests.ramtek_emu.recorded_streams import SQUARES


def run(*arguments: str, data: bytes = b"", code: int = 0) -> subprocess.CompletedProcess[bytes]:
    done = processes.run(*arguments, data=data)
    assert done.returncode == code, done.stderr
    return done


def test_streams_that_part(tmp_path: Path) -> None:
    other = SQUARES.copy()
    other[8] = 5
    paths = []
    for name, words in (("first", SQUARES), ("second", other)):
        path = tmp_path / name
        path.write_bytes(words.astype("<u2").tobytes())
        paths.append(str(path))
    text = run("diff", *paths, code=1).stdout.decode()
    assert "differ after instruction 2" in text
    assert "BACK=4" in text
    assert "BACK=5" in text
    assert "words: 1024 differ, in 0,0..31,31" in text
    found = json.loads(run("diff", *paths, "--json", code=1).stdout)
    assert found["number"] == 2
    assert found["background"] == [4, 5]
    assert json.loads(run("diff", paths[0], paths[0], "--json").stdout) is None
    assert "the same" in run("diff", paths[0], "-", data=SQUARES.astype("<u2").tobytes()).stdout.decode()
    assert "only one" in run("diff", "-", "-", code=2).stderr.decode()


def test_streams_that_differ_without_a_difference(tmp_path: Path) -> None:
    (tmp_path / "first").write_bytes(b"\x00\x07\x00\x07")
    (tmp_path / "second").write_bytes(b"\x00\x07\x01\x07")
    text = run("diff", str(tmp_path / "first"), str(tmp_path / "second")).stdout.decode()
    assert "alike after every instruction; the streams differ from 2 on" in text


def test_an_incomplete_end_is_dropped_and_reported_with_its_file(tmp_path: Path) -> None:
    path = tmp_path / "cut"
    path.write_bytes(SQUARES.astype("<u2").tobytes() + b"\x00\x03\x00\x00!")
    done = run("diff", "-", str(path), data=SQUARES.astype("<u2").tobytes())
    assert "the streams are the same" in done.stdout.decode()
    assert done.stderr.decode().splitlines() == [
        f"the stream {path} ends within an instruction: its 2 words were dropped",
        f"the stream {path} ends within a word: its last byte was dropped",
    ]


def test_a_reply_is_printed_from_its_first_difference_on() -> None:
    lines = lines_of({"reply": [[5, 6, *range(20)], [5, 6]], "status": ["READY", "ILLEGAL|READY"]})
    assert list(lines) == [
        "reply: 22 and 2 words; from word 2 on 0 1 2 3 4 5 6 7 ... and nothing",
        'status: "READY" and "ILLEGAL|READY"',
    ]
