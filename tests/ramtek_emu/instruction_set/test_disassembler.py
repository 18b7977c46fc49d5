from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import DECODED, RECORDED, listing, words
from tests.ramtek_emu.strategies import cuts


def texts(text: str) -> list[str]:
    """The right side of the listing of hexadecimal words."""
    lines = listing(words(text).astype("<u2").tobytes())
    return [line[38:].strip() for line in lines if line[38:].strip()]


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
