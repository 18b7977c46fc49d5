"""`ramtek list`, `assemble`, `inspect` and `diff`, which read a stream and print what they find."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from ramtek_emu import PRINCETON_9300, Ramtek9300, WordsError
from ramtek_emu.commands import displays
from ramtek_emu.commands.diff import lines_of
from ramtek_emu.commands.ramtek import ramtek
from tests.ramtek_emu.processes import field_of, stream
from tests.ramtek_emu.recorded_streams import OUTLINE, SQUARES, words

DATA = stream(SQUARES)


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run(*arguments: str, data: bytes = b"", code: int = 0) -> tuple[str, list[str]]:
    """What a command prints, and its lines on stderr."""
    done = CliRunner().invoke(ramtek, arguments, input=data)
    assert getattr(done.exception, "exit_code", done.exit_code) == code, done.output
    return done.stdout, done.stderr.splitlines()


def run_json(*arguments: str, data: bytes = b"", code: int = 0) -> Any:
    return json.loads(run(*arguments, "--json", data=data, code=code)[0])


def test_a_listing_is_assembled_into_its_stream() -> None:
    data = stream(np.concatenate((OUTLINE, SQUARES)))
    listed, said = run("list", "-", data=data)
    assert said == []
    assert run("assemble", "-", "-o", "again.ramtek", data=listed.encode())[1] == ["wrote again.ramtek"]
    assert Path("again.ramtek").read_bytes() == data
    run("assemble", "-", "-o", "again.ramtek", data=listed.encode(), code=73)
    run("assemble", "-", "-o", "again.ramtek", "--force", data=b"\xef\xbb\xbfNOP\n")
    assert Path("again.ramtek").read_bytes() == b"\0\7"
    assert CliRunner().invoke(ramtek, ["assemble", "-", "-o", "-"], listed).stdout_bytes == data
    run("assemble", "-", "-o", "-", data=b"NOP\nDRAW\n", code=65)


def test_a_listing_in_json_holds_every_word(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ramtek_emu.commands.list.PIECE", 2)
    data = stream(np.concatenate((OUTLINE, words("A3FF 0A01 0008")))) + b"!"
    listed = run_json("list", "-", data=data)
    assert stream(np.concatenate([words(item["words"]) for item in listed])) == data[:-1]
    assert listed[0] == {
        "place": 0,
        "words": "0802 0002 0100",
        "name": "SET",
        "meaning": "set parameters",
        "flags": [],
        "operands": {"foreground": [256]},
    }
    assert [item["note"] for item in listed if "note" in item] == [
        "begins no instruction",
        "the stream ends within a word",
    ]
    assert run_json("list", "-") == []


def test_a_picture_at_an_instruction() -> None:
    for number, end in ((0, 0), (2, 9)):
        display = Ramtek9300()
        display.send(SQUARES[:end])
        said = run("inspect", "-", "--at", str(number), "-o", "a.png", "--force", data=DATA)[1]
        assert said[-1] == "wrote a.png"
        assert (field_of(Path("a.png")) == display.field()).all()
    run("inspect", "-", "-o", "a.png", data=DATA, code=73)


def test_who_wrote_a_pixel_is_listed_with_the_newest_first() -> None:
    (line,) = run("inspect", "-", "--who", "31,31", data=DATA)[0].splitlines()
    assert line.split()[:4] == ["2", "0000", "->", "0004"]
    assert line.endswith("ERS BACK=4")
    asked = run_json("inspect", "-", "--who", "0,0", data=DATA)
    assert [write["number"] for write in asked] == [4, 2]
    assert asked[0]["instruction"]["name"] == "WT"
    assert run_json("inspect", "-", "--who", "0,0", "--at", "3", data=DATA) == asked[1:]
    assert run_json("inspect", "-", "--who", "639,479", data=DATA) == []
    said = run("inspect", "-", "--who", "639,479", data=DATA)[1]
    assert said == ["none of the first 8 instructions writes element 639, line 479"]


def test_the_number_of_an_instruction_is_its_line_in_a_listing_in_json() -> None:
    data = stream(words("A3FF")) + DATA
    lines = run("list", "-", "--json", data=data)[0].splitlines()
    for number in (1, 2, len(lines)):
        listed = json.loads(lines[number - 1].strip("[ ,]"))
        moment = run_json("inspect", "-", "--at", str(number), data=data)
        assert (moment["of"], moment["instruction"]["place"]) == (len(lines), listed["place"])
    moment = run_json("inspect", "-", "--at", "3", data=DATA)
    assert (moment["number"], moment["instruction"]["name"]) == (3, "SET")
    assert (moment["foreground"], moment["background"]) == (4, 0)
    assert "whole_word" not in moment
    assert run_json("inspect", "-", "--at", "0", data=DATA)["instruction"] is None


def test_streams_that_part() -> None:
    Path("first").write_bytes(DATA)
    Path("second").write_bytes(stream(np.where(np.arange(len(SQUARES)) == 8, 5, SQUARES)))
    text = run("diff", "first", "second", code=1)[0].splitlines()
    assert text[0] == "the displays differ after instruction 2"
    assert [line.split()[0] for line in text[1:3]] == ["first:", "second:"]
    assert [line.split()[-1] for line in text[1:3]] == ["BACK=4", "BACK=5"]
    assert "  words: 1024 differ, in 0,0..31,31; the first at line 0, element 0: 4 and 5" in text
    found = run_json("diff", "first", "second", code=1)
    assert (found["number"], found["background"]) == (2, [4, 5])
    assert run_json("diff", "first", "first") is None
    assert run("diff", "first", "-", data=DATA)[0] == "the streams are the same: 8 instructions\n"
    Path("second").write_bytes(DATA[:18])
    assert "  second: ended before" in run("diff", "first", "second", code=1)[0].splitlines()


def test_streams_that_differ_without_a_difference() -> None:
    Path("first").write_bytes(b"\x00\x07\x00\x07")
    assert run("diff", "first", "-", data=b"\x00\x07\x01\x07")[0] == (
        "the displays are alike after every instruction; the streams differ from 2 on\n"
    )


def test_the_differences_of_replies_and_entries_are_printed_from_the_first_on() -> None:
    where = {
        "reply": [[5, 6, *range(20)], [5, 6]],
        "status": ["READY", "ILLEGAL|READY"],
        "entries": {"count": 2, "first": 7, "values": [[1, 2, 3], [0, 0, 0]]},
        "sizes": "differ",
    }
    assert list(lines_of(where)) == [
        "reply: 22 and 2 words, which differ from word 2 on",
        'status: "READY" and "ILLEGAL|READY"',
        "entries: 2 differ; the first is 7: [1, 2, 3] and [0, 0, 0]",
        "sizes: they differ",
    ]
    assert list(lines_of({"reply": [[*range(8)], [0, 9]]})) == [
        "reply: 8 and 2 words, which differ from word 1 on"
    ]


def test_an_incomplete_end_is_dropped_and_reported_with_its_file() -> None:
    Path("cut").write_bytes(DATA + b"\x00\x03\x00\x00!")
    shown, said = run("diff", "-", "cut", data=DATA)
    assert "the streams are the same" in shown
    assert said == [
        "the stream cut ends within an instruction: its 2 words were dropped",
        "the stream cut ends within a word: its last byte was dropped",
    ]


def test_a_stream_that_is_read_whole_has_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("long").write_bytes(bytes(10))
    monkeypatch.setattr(displays, "MOST_READ", 10)
    assert len(displays.read_stream("long", PRINCETON_9300).words) == 5
    monkeypatch.setattr(displays, "MOST_READ", 9)
    with pytest.raises(WordsError, match="at most 9 bytes here"):
        displays.read_stream("long", PRINCETON_9300)
