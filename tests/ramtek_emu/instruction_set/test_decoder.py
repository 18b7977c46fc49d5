from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, InstructionError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.decoder import MOST_WORDS, Decoder
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.instruction_set.instruction import encode, normal
from ramtek_emu.instruction_set.table import (
    FORMAT_OF_NAME,
    FORMATS,
    ILLEGAL,
    OPERAND_BITS,
    OPERANDS,
    OPERANDS_1,
    OPERANDS_2,
    SUBSTANTIATED,
    UNIMPLEMENTED,
    operands_named,
)
from ramtek_emu.testing import streams
from tests.ramtek_emu import reference
from tests.ramtek_emu.recorded_streams import DECODED, RECORDED, listing, words
from tests.ramtek_emu.strategies import cuts
from tests.tables import call, refused


def decoded(pieces: list[np.ndarray[tuple[int], np.dtype[np.uint16]]]) -> tuple[list[list[int]], Decoder]:
    decoder = Decoder(FAMILY)
    encoded = [encode(instruction).tolist() for piece in pieces for instruction in decoder.feed(piece)]
    return encoded, decoder


@given(streams(), st.lists(st.integers(0, 60), max_size=8))
def test_instructions_do_not_depend_on_the_cuts(stream: list[int], places: list[int]) -> None:
    whole, _ = decoded([np.array(stream, np.uint16)])
    assert decoded(cuts(stream, places))[0] == whole
    assert decoded([np.array([word], np.uint16) for word in stream])[0] == whole


@given(streams())
def test_the_decoder_splits_as_a_reader_of_single_words_does(stream: list[int]) -> None:
    encoded, decoder = decoded([np.array(stream, np.uint16)])
    twin = reference.split(stream)
    # Flag bits that no source names carry no words, and are not sent again.
    assert [len(part) for part in encoded] == [len(part) for part in twin]
    assert decoder.pending_words == len(stream) - sum(map(len, twin))


@given(st.integers(0, 2**32 - 1))
def test_pending_words_are_never_more_than_one_instruction(seed: int) -> None:
    decoder = Decoder(FAMILY)
    for word in np.random.default_rng(seed).integers(0, 1 << 16, (2000, 1), np.uint16):
        list(decoder.feed(word))
        assert decoder.pending_words < MOST_WORDS


def test_data_are_views_of_the_words_sent() -> None:
    stream = np.array([0x0A01, 6, 1, 2, 3], np.uint16)
    (instruction,) = Decoder(FAMILY).feed(stream)
    assert np.shares_memory(instruction.data, stream)


@given(
    st.integers(0, 0xFFFF), st.integers(0, 255), st.lists(st.sampled_from([0, 1, 4, 8, 0xFFFF]), max_size=60)
)
def test_conics_of_six_and_twelve_words_are_distinguished(
    flag_word: int, low_byte: int, row: list[int]
) -> None:
    stream = [0x0F03 | low_byte, flag_word | 0x1000, *row]
    encoded, decoder = decoded([np.array(stream, np.uint16)])
    twin = reference.split(stream)
    assert [len(part) for part in encoded] == [len(part) for part in twin]
    assert decoder.pending_words == len(stream) - sum(map(len, twin))
    assert decoded([np.array([word], np.uint16) for word in stream])[0] == encoded


def test_six_coefficients_are_taken_where_twelve_make_no_sense() -> None:
    six = [0x0F03, 0x9000, 1, 1, 0, 10, 0, 0, 100, 100, 4, 90, 110]
    twelve = [0x0F03, 0x9000, 0, 1, 0, 1, 0, 0, 0, 10, 0, 0, 0, 0, 100, 100, 4, 90, 110]
    instructions = list(Decoder(FAMILY).feed(np.array([*six, *twelve], np.uint16)))
    assert [instruction.data.tolist() for instruction in instructions] == [[90, 110], [90, 110]]
    assert [instruction.operands["start"] for instruction in instructions] == [(100, 100)] * 2


@given(streams(300), st.booleans())
def test_rows_of_illegal_words_equal_single_illegal_words(stream: list[int], extended: bool) -> None:
    configuration = FAMILY if extended else PRINCETON_9300
    single, rows = Decoder(configuration), Decoder(configuration)
    words = np.array(stream, np.uint16)
    one_by_one = [encode(instruction).tolist() for instruction in single.feed(words)]
    in_rows = [encode(instruction).tolist() for instruction in rows.feed(words, in_rows=True)]
    assert list(itertools.chain(*in_rows)) == list(itertools.chain(*one_by_one))
    assert rows.pending_words == single.pending_words


def test_an_instruction_known_by_name_only_is_consumed_whole() -> None:
    # WPP with a foreground and data, a keyboard instruction, a display list's.
    stream = np.array([0x3603, 0x0002, 7, 3, 1, 2, 0x1800, 0x4100, 0x0700], np.uint16)
    names = [instruction.format.name for instruction in Decoder(FAMILY).feed(stream)]
    assert names == ["WPP", "WKB", "CDL", "NOP"]
    strict = [instruction.format.name for instruction in Decoder(PRINCETON_9300).feed(stream)]
    assert strict == ["???"] * 8 + ["NOP"]


def test_a_9300_knows_no_second_operand_flag_word() -> None:
    stream = np.array([0x0804, 0x0001, 0x0700], np.uint16)
    strict = [instruction.format for instruction in Decoder(PRINCETON_9300).feed(stream)]
    assert strict[0] is ILLEGAL
    (instruction,) = Decoder(FAMILY).feed(stream)
    assert instruction.operands == {"read_mask": (0x0700,)}


@given(streams())
def test_an_instruction_is_equal_to_its_own_words_read_again(stream: list[int]) -> None:
    for instruction in Decoder(FAMILY).feed(np.array(stream, np.uint16)):
        (again,) = Decoder(FAMILY).feed(encode(instruction))
        assert again == instruction
        assert hash(again) == hash(instruction)
        assert str(again) == str(instruction)


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
    with pytest.raises(InstructionError, match=f"an operand must be one of mask, .*, not '{name}'") as caught:
        normal("SET", {name: 1})
    assert str(caught.value).endswith(f"; {advice}")


def test_a_listing_names_operands_and_flags() -> None:
    assert str(normal("SET", {"mask": 15, "window": (0, 0, 9, 9)})) == "SET  mask 15; window 0, 0, 9, 9"
    (text,) = Decoder(FAMILY).feed(np.array([0x0C13, 0x0040, 0, 0, 32, 32, 3, 0x3030, 0x3400], np.uint16))
    assert str(text) == "WT   BK; window 0, 0, 32, 32; 3 bytes"
    assert text.data_bytes() == b"004"
    assert repr(text) == f"Instruction({str(text)!r})"


def texts(text: str) -> list[str]:
    """The right side of the listing of hexadecimal words."""
    lines = listing(words(text).astype("<u2").tobytes())
    return [line[38:].strip() for line in lines if line[38:].strip()]


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


DOCS = Path(__file__).parents[3] / "docs"

ARGNO = [1, 1, 1, 2, 2, 2, 4, 1, 2, 2, 1, 1, 12, 1, 1, 2]
"""Words of each operand of the first flag word (Hardware: LIN, Argno; 12 for CONE as its client sends)."""


def test_no_two_rows_have_an_opcode_or_a_name_in_common() -> None:
    assert len({format.opcode for format in FORMATS}) == len(FORMATS) == len(FORMAT_OF_NAME)
    assert all(0 <= format.opcode <= 0xFF for format in FORMATS)


def test_the_operands_have_their_lengths_and_their_bits() -> None:
    assert [operand.words for operand in OPERANDS_1] == ARGNO
    assert {operand.mnemonic: operand.words for operand in OPERANDS_2} == {
        "RMSK": 1, "WEW": 4, "WOF": 2, "VTX": 2, "DCL": 1, "IMG": 1
    }  # fmt: skip
    operands = OPERANDS_1 + OPERANDS_2
    assert {operand.name: 1 << bit for bit, operand in enumerate(operands)} == OPERAND_BITS
    words = [word for operand in operands for word in {operand.name.upper(), operand.mnemonic}]
    assert len(words) == len(set(words))


def test_every_instruction_has_its_number() -> None:
    numbers = " ".join(f"{format.opcode:02X}:{format.name}" for format in SUBSTANTIATED)
    assert numbers == (
        "03:LAM 04:RAM 05:RSET 06:INIT 07:NOP 08:SET 09:ERS 0A:WI 0B:RI 0C:WT 0D:WR 0E:WVL 0F:WC 10:WPB"
        " 13:PUSHE 14:POPE 15:LPF 16:WCSS 17:RCSS 21:LPFRP 24:READP 25:RERR 26:ZOOM 27:SELVO 29:WAITVR"
        " 2A:WAITL 2B:BERS 2C:WCSP 2D:WCSG 2E:RCSP 2F:RCSG 30:LCF 33:DDCC 35:WVU 38:WPT 39:WRP 3A:FILL"
        " 4E:ATTPF 69:COPY 6D:CIRC"
    )
    # The numbers without a row.
    assert {*range(0x8E)} - {format.opcode for format in FORMATS} == {0, *range(0x78, 0x7F)}
    assert FORMAT_OF_NAME["LPF"].fixed == tuple(f"rows_{row}_{row + 1}" for row in range(0, 12, 2))
    assert {format.name for format in FORMATS if format.replies} == {"RAM", "RI"}
    assert [format.name for format in FORMATS if format.requests_operands] == ["READP"]


@given(st.integers(0, 0xFFFF), st.integers(0, 0xFFFF))
def test_flag_words_name_operands_in_the_order_of_their_bits(first: int, second: int) -> None:
    expected = []
    for word, operands in ((first, OPERANDS_1), (second, OPERANDS_2)):
        expected += [operands[bit] for bit in range(16) if word >> bit & 1 and bit < len(operands)]
    assert list(operands_named(first, second)) == expected


def test_a_9300_has_no_instruction_that_only_the_later_models_know() -> None:
    of_9300 = " ".join(format.name for format in FORMATS if not format.extended)
    assert of_9300 == "LAM RAM RSET INIT NOP SET ERS WI RI WT WR WVL WC WPB LPF WCSS RCSS SCRX SCRY"
    assert not any(format.unimplemented for format in SUBSTANTIATED)


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


def test_each_name_is_a_row_of_the_table_that_does_nothing() -> None:
    rows = {(format.opcode, format.name, format.meaning) for format in FORMATS if format.unimplemented}
    assert rows == set(UNIMPLEMENTED)


def test_the_guide_to_the_display_names_every_instruction_that_is_done() -> None:
    names = set(re.findall(r"[A-Z]+", (DOCS / "guides" / "display.md").read_text("utf-8")))
    assert {row.name for row in SUBSTANTIATED} <= names
