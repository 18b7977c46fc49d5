from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.instruction_set.instruction import encode, normal
from ramtek_emu.instruction_set.table import (
    FORMAT_OF_NAME,
    FORMATS,
    OPERANDS,
    SUBSTANTIATED,
)
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import listing, words
from tests.ramtek_emu.strategies import cuts
from tests.tables import call, refused


def test_data_are_views_of_the_words_sent() -> None:
    stream = np.array([0x0A01, 6, 1, 2, 3], np.uint16)
    (instruction,) = Decoder(FAMILY).feed(stream)
    assert np.shares_memory(instruction.data, stream)


@pytest.mark.parametrize("length", [1, 24, 25, 90])
def test_a_row_of_illegal_words_is_one_instruction(length: int) -> None:
    parts = [*Decoder(FAMILY).split(words(f"FFFF*{length} 0700"))]
    assert list(map(len, parts)) == [length, 1]


def test_after_it_is_cleared_a_decoder_begins_a_new_row_of_illegal_words() -> None:
    decoder, rows = Decoder(FAMILY), []
    for is_cleared in (False, False, True):
        if is_cleared:
            decoder.clear()
        rows += [decoder.is_within_row for _ in decoder.feed(words("FFFF"))]
    assert rows == [False, True, False]


def test_data_and_operands_are_taken_up_to_their_limits() -> None:
    for length in (0, 65534, 65535):
        assert normal("WI", {}, length=length).length == length
    assert normal("SET", {"start": (-32768, 65535)}).operands == {"start": (0x8000, 0xFFFF)}
    assert encode(normal("SET", {"read_mask": 5, "mask": 7})).tolist() == [0x0806, 1, 1, 7, 5]


NAMES = ", ".join(OPERANDS)
WI_BYTES = "the data of WI must be 0 to 65535 bytes, not {}; send them in several instructions"
START_NUMBERS = "start must be {}-32768 to 65535, not {}; round or clip it"
test_what_is_no_instruction = refused(
    call,
    [
        (lambda: normal("WI", {}, length=-1), WI_BYTES.format(-1)),
        (lambda: normal("WI", {}, length=65536), WI_BYTES.format(65536)),
        (lambda: normal("SET", {"x": 1}), f"an operand must be one of {NAMES}, not 'x'; choose one"),
        (lambda: normal("SET", {"start": 5}), "start must be 2 numbers, not 1; give all of them"),
        (lambda: normal("SET", {"start": (0, 65536)}), START_NUMBERS.format("", 65536)),
        (lambda: normal("SET", {"start": (-32769, 0)}), START_NUMBERS.format("", -32769)),
        (lambda: normal("SET", {"start": (0.5, 0)}), START_NUMBERS.format("a whole number from ", 0.5)),  # type: ignore[dict-item]
    ],
)


@given(streams(), st.lists(st.integers(0, 200), max_size=5))
def test_a_listing_does_not_depend_on_how_the_stream_was_cut(stream: list[int], places: list[int]) -> None:
    whole = np.array(stream, "<u2").tobytes()
    pieces = [part.astype("<u2").tobytes() for part in cuts(stream, places)]
    pieces = [half for piece in pieces for half in (piece[:1], piece[1:])]
    assert [line for item in items(pieces, FAMILY) for line in item.lines()] == listing(whole)


DOCS = Path(__file__).parents[3] / "docs"


def test_no_two_rows_have_an_opcode_or_a_name_in_common() -> None:
    assert len({format.opcode for format in FORMATS}) == len(FORMATS) == len(FORMAT_OF_NAME)
    assert {*range(0x8E)} - {format.opcode for format in FORMATS} == {0, *range(0x78, 0x7F)}


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
