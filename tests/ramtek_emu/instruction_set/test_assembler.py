from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import listing, words
from tests.tables import refused


def assembled(program: str) -> list[int]:
    data = b"".join(assemble(program.splitlines()))
    numbers: list[int] = np.frombuffer(data, "<u2").tolist()
    return numbers


@given(
    streams().map(lambda stream: np.array(stream, "<u2").tobytes()) | st.binary(max_size=3000),
    st.binary(max_size=1),
    st.sampled_from([FAMILY, PRINCETON_9300]),
)
def test_assembling_a_listing_gives_any_bytes_back(
    stream: bytes, odd_byte: bytes, configuration: Configuration
) -> None:
    assert b"".join(assemble(listing(stream + odd_byte, configuration))) == stream + odd_byte


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_a_utf_8_mark_is_no_part_of_a_listing(encoding: str) -> None:
    program = "\ufeffRSET\nERS BACK=2\n".encode().decode(encoding)
    assert assembled(program) == assembled("RSET\nERS BACK=2\n")
    with pytest.raises(ListingError):
        assembled("RSET\n" + program)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_a_listing_in_utf_16_is_refused_by_name(encoding: str) -> None:
    with pytest.raises(ListingError, match="line 1: a listing must be text in UTF-8, not in UTF-16; save"):
        assembled("\ufeffRSET\n".encode(encoding).decode("latin-1"))


def test_a_program_written_by_hand_is_assembled() -> None:
    program = r"""
    ; a box and a line
    set fore=1;BK is no flag here
    00004: 0802 8000 000A 01F5            SET START=10,-32768
    ERS WIN=100,331..200,411 BACK=2 BK
    WV
      to 100,451   -1,0x10
    WT RP
      text "a;b"  "\"\\\x1B"   ; not a comment in the string
    SET IX10 CONE=1,2,3,4,5,6
    WCSS #1 element=65535 line_and_state=0x0440
    READP MASK VTX
    raw 0007*3 FFFF
    """
    expected = """
        0802 0002 0001 0802 8000 000A 8000 0912 0044 0002 0064 014B 00C8 019B
        0E01 0008 0064 01C3 FFFF 0010 0C09 0006 3B61 2262 1B5C 0882 1000 1 2 3 4 5 6
        1601 FFFF 0440 2406 0001 0008 7 7 7 FFFF
    """
    assert assembled(program) == words(expected).tolist()
    assert assembled("raw 0001*32768") == [1] * 32768


A_NUMBER = "a number must be -32768 to 65535, decimal or after 0x, not"

test_wrong_listings_are_refused_with_their_line = refused(
    assembled,
    [
        ("DRAW", "line 1: an instruction must be one of the table, not 'DRAW'; write its words after raw"),
        ("SET FORE=1,2", "line 1: FORE must be 1 numbers, not '1,2'; give all"),
        ("WC CONE=1", "line 1: CONE must be 6 or 12 numbers, not '1'; give all"),
        ("SET FORE=65536", f"line 1: {A_NUMBER} '65536'; write it so"),
        ("NOP\nSET FORE=-32769", f"line 2: {A_NUMBER} '-32769'; write it so"),
        (
            "SET COLOR=1",
            "line 1: what follows SET must be a flag, an operand or a length, not 'COLOR=1'; "
            "see `ramtek list`",
        ),
        (
            "RSET #256",
            "line 1: what follows RSET must be a flag, an operand or a length, not '#256'; see `ramtek list`",
        ),
        ("to 1,2", "line 1: data must follow an instruction that takes them, not 'to'; put one before it"),
        (
            "WVL 4 bytes\nNOP",
            "line 1: WVL must have data of 4 bytes, not of 0; leave the length out to have it counted",
        ),
        (
            "WT 65536 bytes",
            "line 1: a length must be 0 to 65535 and stand before the word bytes, not '65536'; write it so",
        ),
        ("raw XYZ", "line 1: a word must be 0000 to FFFF, or one with *times, not 'XYZ'; mend it"),
        ("raw 0001*32768 0002", "line 1: a line must be at most 32768 words, not 32769; break it"),
        ('WT\ntext "a', "line 2: a string must end with a quotation mark, not as '\"a'; add it"),
        (
            'WT\ntext "a\u20ac"',
            "line 2: text must be in quotation marks, its codes 0 to 255, not '\"a\u20ac\"'; write it so",
        ),
        (
            'WT\ntext "a"\ntext "b"',
            "line 3: text must follow an even number of bytes; join it with the line before",
        ),
        (
            "WI\nwords 0*32768\nwords 0",
            "line 3: the data must be at most 65535 bytes, not 65538; write two instructions",
        ),
        ("WVL\nto 1", "line 2: a point must be element,line, not '1'; write it so"),
        ("WCSS element=1", "line 1: WCSS must have all its operands; add line_and_state"),
        ("byte 100", "line 1: a byte must be 00 to FF, not '100'; write one"),
        ("byte 01\nNOP", "line 2: the byte of line 1 must be the last of the stream; delete one of them"),
        (
            "9" * 9000,
            f"line 1: an instruction must be one of the table, not '{'9' * 59}; write its words after raw",
        ),
    ],
)

TEXTS = st.text('SETWVrawto1290,.;=*"\\ \0\u0663\u20ac', max_size=30)


@given(st.lists(TEXTS | st.sampled_from(["SET", "WT", "to 1,2", 'text "a"', "raw 0"]), max_size=8))
def test_any_text_is_assembled_or_refused(lines: list[str]) -> None:
    with suppress(ListingError):
        assert all(isinstance(part, bytes) for part in assemble(lines))
