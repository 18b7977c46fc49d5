from __future__ import annotations

import json
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from tests.ramtek_emu.recorded_streams import DECODED, OUTLINE, RECORDED, SQUARES, words
from tests.ramtek_emu.strategies import cuts, streams, thorough

ROOT = Path(__file__).parents[2]


def listing(stream: bytes, configuration: Configuration = GMR_9300) -> list[str]:
    return [line for item in items([stream], configuration) for line in item.lines()]


def texts(text: str) -> list[str]:
    """What stands at the right of the listing of some hexadecimal words."""
    lines = listing(words(text).astype("<u2").tobytes())
    return [line[38:].strip() for line in lines if line[38:].strip()]


@thorough
@given(streams(), st.binary(max_size=1), st.sampled_from([GMR_9300, PRINCETON_9300]))
def test_assembling_a_listing_gives_any_words_back(
    stream: list[int], odd_byte: bytes, configuration: Configuration
) -> None:
    data = np.array(stream, "<u2").tobytes() + odd_byte
    assert b"".join(assemble(listing(data, configuration))) == data


@thorough
@given(st.binary(max_size=3000))
def test_assembling_a_listing_gives_any_bytes_back(data: bytes) -> None:
    assert b"".join(assemble(listing(data))) == data


@thorough
@given(streams(), st.lists(st.integers(0, 200), max_size=5))
def test_a_listing_does_not_depend_on_how_the_stream_was_cut(stream: list[int], places: list[int]) -> None:
    whole = np.array(stream, "<u2").tobytes()
    pieces = [part.astype("<u2").tobytes() for part in cuts(stream, places)]
    pieces = [half for piece in pieces for half in (piece[:1], piece[1:])]
    assert [line for item in items(pieces) for line in item.lines()] == listing(whole)


@pytest.mark.parametrize("number", range(len(RECORDED)))
def test_recorded_streams_are_listed_without_raw_words_and_come_back(number: int) -> None:
    data = RECORDED[number].astype("<u2").tobytes()
    lines = listing(data)
    assert not [line for line in lines if " raw " in line]
    assert b"".join(assemble(lines)) == data


def test_the_words_stand_at_the_left_and_their_meaning_at_the_right() -> None:
    assert listing(DECODED[:12].astype("<u2").tobytes()) == [
        "00000: 0500                           RSET",
        "00001: 0802 0002 0001                 SET FORE=1",
        "00004: 0802 8000 000A 01F5            SET STRT=10,501",
        "00008: 0E01 0004                      WVL 4 bytes",
        "0000A: 0064 01C3                        to 100,451",
    ]


@pytest.mark.parametrize(
    ("stream", "lines"),
    [
        (
            "0912 0043 00FF 0007 0064 0032 00C7 0063",
            ["ERS BK SUB=0x00FF FORE=7 WIN=100,50..199,99"],
        ),
        ("0902 0044 0002 0064 014B 00C8 019B", ["ERS BACK=2 WIN=100,331..200,411"]),
        (
            "0C0B 0040 0064 01C3 026B 01FF 0006 4548 4C4C 204F",
            ["WT RP WIN=100,451..619,511 6 bytes", 'text "HELLO "'],
        ),
        (
            "0C13 0040 0000 0000 0020 0020 0003 3030 3400",
            ["WT BK WIN=0,0..32,32 3 bytes", 'text "004"'],
        ),
        (
            "0A0F 80C1 0020 00FF 0 0 027F 01DF 0 000A 1 1 0004 0100 0302",
            [
                "WI RP SUB=0x00FF WIN=0,0..639,479 SCAN=0 STRT=10,1 IMG=1 4 bytes",
                "words 0100 0302",
            ],
        ),
        ("0802 0020 000A 0014 2600 0101", ["SET ORIG=10,20", "ZOOM zoom=0x0101"]),
        (
            "0E0F 8002 0008 0007 000A 0214 FF00 1000 0008 0064 0214 0064 025A",
            ["WVL RP FORE=7 STRT=10,532 VTX=0xFF00,0x1000 8 bytes", "to 100,532  100,602"],
        ),
        ("0B01 0008", ["RI 8 bytes"]),
        ("0802 8000 FFFF FFFE", ["SET STRT=-1,-2"]),
        ("0A01 0010 7 7 7 7 7 7 7 1", ["WI 16 bytes", "words 0007*7 0001"]),
        ("0C01 0003 4122 5C01", ["WT 3 bytes", "words 4122 5C01"]),
        ("0C01 0004 4122 5C07", ["WT 4 bytes", r'text "A\"\\\x07"']),
        ("1601 0064 0440", ["WCSS #1 element=100 line_and_state=0x0440"]),
        ("0300 03FF 0002 0000", ["LAM address=1023 2 bytes", "words 0000"]),
        ("A3FF", ["raw A3FF ; begins no instruction"]),
        ("0E01 0008 0001", ["raw 0E01 0008 0001 ; the stream ends within this instruction"]),
        ("0802 0000", ["SET OF1"]),
    ],
)
def test_an_instruction_is_listed_with_its_operands_by_name(stream: str, lines: list[str]) -> None:
    assert texts(stream) == lines


def test_a_program_written_by_hand_is_assembled() -> None:
    program = """
    ; a box and a line
    set fore=1 start=10,501
    ERS WIN=100,331..200,411 BACK=2 BK
    WV
      to 100,451   -1,0x10
    WT RP
      text "a;b"   ; not a comment in the string
    """
    assert (
        b"".join(assemble(program.splitlines()))
        == words(
            "0802 8002 0001 000A 01F5 0912 0044 0002 0064 014B 00C8 019B"
            "0E01 0008 0064 01C3 FFFF 0010 0C09 0003 3B61 0062".replace("019B0E01", "019B 0E01")
        )
        .astype("<u2")
        .tobytes()
    )


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("DRAW", "an instruction must be one of the table, not 'DRAW'; write its words after raw"),
        ("SET FORE=1,2", "FORE must be 1 numbers, not '1,2'; give all"),
        ("SET FORE=70000", "a number must be -32768 to 65535, decimal or after 0x, not '70000'; write it so"),
        ("SET COLOR=1", "what follows SET must be a flag, an operand or a length, not 'COLOR=1'"),
        ("to 1,2", "data must follow an instruction that takes them, not 'to'; put one before it"),
        ("WVL 4 bytes", "WVL must have data of 4 bytes, not of 0; leave the length out to have it counted"),
        ("WT 70000 bytes", "a length must be 0 to 65535 and stand before the word bytes, not '70000'"),
        ("raw XYZ", "a word must be 0000 to FFFF, or one with *times to 32768, not 'XYZ'; mend it"),
        ("raw 0001*99999", "a word must be 0000 to FFFF, or one with *times to 32768, not '0001*99999'"),
        ('WT\ntext "a', "a string must end with a quotation mark, not as '\"a'; add it"),
        ('WT\ntext "a\u20ac"', "text must be in quotation marks, its codes 0 to 255"),
        ("WVL\nto 1", "a point must be element,line, not '1'; write it so"),
        ("WCSS element=1", "WCSS must have all its operands; add line_and_state"),
        ("byte 100", "a byte must be 00 to FF, not '100'; write one"),
        ("byte", "a byte must be 00 to FF, not ''; write one"),
        ("byte 01\nNOP", "the byte of line 1 must be the last of the stream; delete one of them"),
    ],
)
def test_what_cannot_be_assembled_is_refused_with_its_line(line: str, sentence: str) -> None:
    with pytest.raises(ListingError) as refusal:
        list(assemble(line.splitlines()))
    number = 1 + line.count("\n")
    assert str(refusal.value).startswith(f"line {number}: {sentence}")


@thorough
@given(
    st.lists(st.text(max_size=30) | st.sampled_from(["SET", "WT", "to 1,2", 'text "a"', "raw 0"]), max_size=8)
)
def test_any_text_is_assembled_or_refused(lines: list[str]) -> None:
    with suppress(ListingError):
        assert all(isinstance(part, bytes) for part in assemble(lines))


def run(*arguments: str, data: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *arguments],
        cwd=ROOT,
        input=data,
        capture_output=True,
        timeout=60,
        check=False,
    )


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


def test_a_listing_in_json_holds_every_word() -> None:
    data = np.concatenate((OUTLINE, words("A3FF 0A01 0008"))).astype("<u2").tobytes() + b"!"
    listed = json.loads(run("list", "-", "--json", data=data).stdout)
    stream = [word for item in listed for word in item["words"]]
    assert np.array(stream, "<u2").tobytes() == data[:-1]
    assert listed[0] == {
        "place": 0,
        "words": [0x0802, 0x0002, 0x0100],
        "name": "SET",
        "meaning": "set parameters",
        "flags": [],
        "operands": {"foreground": [256]},
    }
    assert listed[-1]["byte"] == ord("!")
    assert json.loads(run("list", "-", "--json").stdout) == []
