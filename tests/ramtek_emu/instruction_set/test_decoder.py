from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, Configuration, InstructionError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.instruction_set.instruction import encode, normal
from ramtek_emu.instruction_set.table import (
    FORMAT_OF_NAME,
    FORMATS,
    OPERAND_BITS,
    OPERANDS,
    OPERANDS_1,
    OPERANDS_2,
    SUBSTANTIATED,
    operands_named,
)
from ramtek_emu.testing import streams
from tests.ramtek_emu import reference
from tests.ramtek_emu.recorded_streams import DECODED, RECORDED, listing, words
from tests.ramtek_emu.strategies import cuts
from tests.tables import call, refused

conics = st.builds(
    lambda flag_word, low_byte, row: [0x0F02 | low_byte, flag_word | 0x1000, *row],
    st.integers(0, 0xFFFF),
    st.integers(0, 255),
    st.lists(st.sampled_from([0, 1, 4, 8, 0xFFFF]), max_size=60),
)


@given(streams() | conics, st.lists(st.integers(0, 60), max_size=8) | st.just([*range(100)]))
def test_a_stream_is_split_as_by_a_reader_of_single_words_however_it_is_cut(
    stream: list[int], places: list[int]
) -> None:
    decoder = Decoder(FAMILY)
    parts: list[list[int]] = []
    for piece in cuts(stream, places):
        used = 0
        for part in decoder.split(piece):
            used = decoder.used
            if decoder.is_within_row:
                parts[-1] += part.tolist()
            else:
                parts.append(part.tolist())
        assert used <= len(piece)
    twin = reference.split(stream)
    assert parts == twin
    assert decoder.pending_words == len(stream) - sum(map(len, twin))


def test_data_are_views_of_the_words_sent() -> None:
    stream = np.array([0x0A01, 6, 1, 2, 3], np.uint16)
    (instruction,) = Decoder(FAMILY).feed(stream)
    assert np.shares_memory(instruction.data, stream)


def names(text: str, configuration: Configuration = FAMILY) -> str:
    return " ".join(instruction.format.name for instruction in Decoder(configuration).feed(words(text)))


def test_coefficients_are_twelve_words_in_wc_alone_and_six_where_twelve_make_no_sense() -> None:
    six, twelve = "1 2 3 4 5 6", "0 1 0 2 0 3 0 4 0 5 0 6"
    stream = f"0802 1000 {six} 0902 4 7 0F03 9000 {six} 64 64 4 5A 6E 0F03 9000 {twelve} 64 64 4 5A 6E"
    decoded = list(Decoder(FAMILY).feed(words(stream)))
    assert [part.format.name for part in decoded] == ["SET", "ERS", "WC", "WC"]
    assert [part.operands["conic"] for part in decoded if part.format.name != "ERS"] == [
        tuple(words(six)),
        tuple(words(six)),
        tuple(words(twelve)),
    ]
    assert [part.data.tolist() for part in decoded[2:]] == [[0x5A, 0x6E]] * 2


def test_an_instruction_known_by_name_only_is_consumed_whole_where_the_display_has_it() -> None:
    # A scroll with a foreground and data, a keyboard instruction, a display list's.
    stream = "1103 0002 7 3 1 2 1800 4100 0700"
    assert names(stream) == "SCRX WKB CDL NOP"
    assert names(stream, PRINCETON_9300) == "SCRX ??? NOP"


def test_a_9300_knows_no_second_operand_flag_word() -> None:
    assert names("0804 0001") == ""
    assert names("0804 0001 0700") == "SET"
    assert names("0804 0001 0700", PRINCETON_9300) == "??? NOP"


def test_data_and_operands_are_taken_up_to_their_limits() -> None:
    for length in (0, 65534, 65535):
        assert normal("WI", {}, length=length).length == length
    assert normal("SET", {"start": (-32768, 65535)}).operands == {"start": (0x8000, 0xFFFF)}
    assert encode(normal("SET", {"read_mask": 5, "mask": 7})).tolist() == [0x0806, 1, 1, 7, 5]


WI_BYTES = "the data of WI must be 0 to 65535 bytes, not {}; send them in several instructions"
START_NUMBERS = "start must be whole numbers from -32768 to 65535, not {}; round or clip it"
test_what_is_no_instruction = refused(
    call,
    [
        (lambda: normal("WI", {}, length=-1), WI_BYTES.format(-1)),
        (lambda: normal("WI", {}, length=65536), WI_BYTES.format(65536)),
        (lambda: normal("SET", {"start": 5}), "start must be 2 numbers, not 1; give all of them"),
        (lambda: normal("SET", {"start": (0, 65536)}), START_NUMBERS.format(65536)),
        (lambda: normal("SET", {"start": (-32769, 0)}), START_NUMBERS.format(-32769)),
        (lambda: normal("SET", {"start": (0.5, 0)}), START_NUMBERS.format(0.5)),  # type: ignore[dict-item]
    ],
)


@pytest.mark.parametrize(
    ("name", "advice"), [("foregrund", "did you mean foreground?"), ("zzz", "choose one of them")]
)
def test_an_unknown_operand_is_answered_with_the_nearest(name: str, advice: str) -> None:
    with pytest.raises(InstructionError, match=f"an operand must be one of mask, .*, not '{name}'; {advice}"):
        normal("SET", {name: 1})


@given(streams(), st.lists(st.integers(0, 200), max_size=5))
def test_a_listing_does_not_depend_on_how_the_stream_was_cut(stream: list[int], places: list[int]) -> None:
    whole = np.array(stream, "<u2").tobytes()
    pieces = [part.astype("<u2").tobytes() for part in cuts(stream, places)]
    pieces = [half for piece in pieces for half in (piece[:1], piece[1:])]
    assert [line for item in items(pieces, FAMILY) for line in item.lines()] == listing(whole)


@pytest.mark.parametrize("number", range(len(RECORDED)))
def test_recorded_streams_are_listed_without_raw_words_and_come_back(number: int) -> None:
    data = RECORDED[number].astype("<u2").tobytes()
    lines = listing(data)
    assert not [line for line in lines if " raw " in line]
    assert b"".join(assemble(lines)) == data


def test_the_words_stand_at_the_left_and_their_meaning_at_the_right() -> None:
    row = words("0 " * 32770)
    assert listing(np.concatenate((DECODED[:12], row)).astype("<u2").tobytes()) == [
        "00000: 0500                           RSET",
        "00001: 0802 0002 0001                 SET FORE=1",
        "00004: 0802 8000 000A 01F5            SET STRT=10,501",
        "00008: 0E01 0004                      WVL 4 bytes",
        "0000A: 0064 01C3                        to 100,451",
        "0000C:                                raw 0000*32768 ; begins no instruction",
        "0800C: 0000 0000                      raw 0000 0000 ; begins no instruction",
    ]


@pytest.mark.parametrize(
    ("stream", "lines"),
    [
        ("0912 0043 FF 7 64 32 C7 63", ["ERS BK SUB=0x00FF FORE=7 WIN=100,50..199,99"]),
        (
            "0C0B 0040 0064 01C3 026B 01FF 0006 4548 4C4C 204F",
            ["WT RP WIN=100,451..619,511 6 bytes", 'text "HELLO "'],
        ),
        ("0C13 0040 0 0 20 20 3 3030 3400", ["WT BK WIN=0,0..32,32 3 bytes", 'text "004"']),
        (
            "0A0F 80C1 0020 00FF 0 0 027F 01DF 0 000A 1 1 0004 0100 0302",
            ["WI RP SUB=0x00FF WIN=0,0..639,479 SCAN=0 STRT=10,1 IMG=1 4 bytes", "words 0100 0302"],
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
        ("0E01 0008 0001", ["raw 0E01 0008 0001 ; the stream ends within this instruction"]),
        ("0804 8001 5", ["raw 0804 8001 0005 ; SET with flags that name nothing"]),
        ("0802 0000", ["raw 0802 0000 ; SET with flags that name nothing"]),
    ],
)
def test_an_instruction_is_listed_with_its_operands_by_name(stream: str, lines: list[str]) -> None:
    listed = listing(words(stream).astype("<u2").tobytes())
    assert [line[38:].strip() for line in listed if line[38:].strip()] == lines


DOCS = Path(__file__).parents[3] / "docs"


def test_no_two_rows_have_an_opcode_or_a_name_in_common() -> None:
    assert len({format.opcode for format in FORMATS}) == len(FORMATS) == len(FORMAT_OF_NAME)
    assert {*range(0x8E)} - {format.opcode for format in FORMATS} == {0, *range(0x78, 0x7F)}


def test_the_operands_have_their_lengths_and_their_bits() -> None:
    counts = [f"{operand.mnemonic}:{operand.words}" for operand in (*OPERANDS_1, *OPERANDS_2)]
    assert " ".join(counts) == (
        "SUB:1 FORE:1 BACK:1 INX1:2 INX2:2 ORIG:2 WIN:4 SCAN:1 DIM:2 SPACE:2 SCALE:1 FUNC:1 CONE:6 BASE:1"
        " SCRO:1 STRT:2 RMSK:1 WEW:4 WOF:2 VTX:2 DCL:1 IMG:1"
    )
    assert {name: 1 << bit for bit, name in enumerate(OPERANDS)} == OPERAND_BITS
    named = " ".join(operand.mnemonic for operand in operands_named(0xA002, 0x21))
    assert named == "FORE BASE STRT RMSK IMG"


def test_every_instruction_has_its_number() -> None:
    numbers = " ".join(f"{format.opcode:02X}:{format.name}" for format in SUBSTANTIATED)
    assert numbers == (
        "03:LAM 04:RAM 05:RSET 06:INIT 07:NOP 08:SET 09:ERS 0A:WI 0B:RI 0C:WT 0D:WR 0E:WVL 0F:WC 10:WPB"
        " 13:PUSHE 14:POPE 15:LPF 16:WCSS 17:RCSS 21:LPFRP 24:READP 25:RERR 26:ZOOM 27:SELVO 29:WAITVR"
        " 2A:WAITL 2B:BERS 2C:WCSP 2D:WCSG 2E:RCSP 2F:RCSG 30:LCF 33:DDCC 35:WVU 38:WPT 39:WRP 3A:FILL"
        " 4E:ATTPF 69:COPY 6D:CIRC"
    )
    of_9300 = " ".join(format.name for format in FORMATS if not format.extended)
    assert of_9300 == "LAM RAM RSET INIT NOP SET ERS WI RI WT WR WVL WC WPB LPF WCSS RCSS SCRX SCRY"


def test_every_row_cites_sources_of_the_list_and_their_files() -> None:
    keys = set(re.findall(r"^## ([A-Z0-9]+):", (DOCS / "SOURCES.md").read_text("utf-8"), re.MULTILINE))
    assert len(keys) > 8
    for source in [row.source for row in FORMATS] + [operand.source for operand in OPERANDS.values()]:
        *cited, last = source.split(", ")
        cited += [] if last in ("format assumed", "length assumed") else [last]
        assert cited, source
        for citation in cited:
            key, file = citation.split(" ")
            assert key in keys, source
            assert re.fullmatch(r"\w+\.[ch]|longlib\.tex|libdoc", file), source


def test_the_data_sheet_and_the_table_name_the_same_assumed_formats() -> None:
    assumed = [row.name for row in FORMATS if row.source.endswith("format assumed")]
    sheet = " ".join((DOCS / "RAMTEK.md").read_text("utf-8").split())
    named = re.findall("[A-Z]+", re.findall("the formats of ([A-Z, and]+);", sheet)[0])
    assert sorted(named) == sorted(assumed)


def test_the_guide_to_the_display_names_every_instruction_that_is_done() -> None:
    names = set(re.findall(r"[A-Z]+", (DOCS / "guides" / "display.md").read_text("utf-8")))
    assert {row.name for row in SUBSTANTIATED} <= names
