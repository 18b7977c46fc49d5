from __future__ import annotations

import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.instruction_set.table import (
    FORMAT_OF_NAME,
    FORMATS,
    OPERAND_BITS,
    OPERANDS,
    OPERANDS_1,
    OPERANDS_2,
    SUBSTANTIATED,
    UNIMPLEMENTED,
    operands_named,
)

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
        "03:LAM 04:RAM 05:RSET 06:INIT 07:NOP 08:SET 09:ERS 0A:WI 0B:RI 0C:WT 0D:WR 0E:WVL 0F:WC 13:PUSHE"
        " 14:POPE 15:LPF 16:WCSS 17:RCSS 21:LPFRP 24:READP 25:RERR 26:ZOOM 27:SELVO 29:WAITVR 2A:WAITL"
        " 2B:BERS 2C:WCSP 2D:WCSG 2E:RCSP 2F:RCSG 30:LCF 33:DDCC 35:WVU 38:WPT 39:WRP 3A:FILL 4E:ATTPF"
        " 69:COPY 6D:CIRC"
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
    assert of_9300 == "LAM RAM RSET INIT NOP SET ERS WI RI WT WR WVL WC LPF WCSS RCSS"
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
