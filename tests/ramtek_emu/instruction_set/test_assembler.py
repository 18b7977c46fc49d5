from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import MOST_LINE, assemble, string_of, tokens_of
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import listing, words
from tests.tables import refused


def assembled(program: str) -> list[int]:
    data = b"".join(assemble(program.splitlines()))
    numbers: list[int] = np.frombuffer(data, "<u2").tolist()
    return numbers


@given(streams(), st.binary(max_size=1), st.sampled_from([FAMILY, PRINCETON_9300]))
def test_assembling_a_listing_gives_any_words_back(
    stream: list[int], odd_byte: bytes, configuration: Configuration
) -> None:
    data = np.array(stream, "<u2").tobytes() + odd_byte
    assert b"".join(assemble(listing(data, configuration))) == data


@given(st.binary(max_size=3000))
def test_assembling_a_listing_gives_any_bytes_back(data: bytes) -> None:
    assert b"".join(assemble(listing(data))) == data


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_a_utf_8_mark_is_no_part_of_a_listing(encoding: str) -> None:
    program = "\ufeffRSET\nERS BACK=2\n".encode().decode(encoding)
    assert assembled(program) == assembled("RSET\nERS BACK=2\n")
    with pytest.raises(ListingError):
        assembled("RSET\n" + program)


def test_a_program_written_by_hand_is_assembled() -> None:
    program = """
    ; a box and a line
    set fore=1 start=10,501
    ERS WIN=100,331..200,411 BACK=2 BK
    WV
      to 100,451   -1,0x10
    WT RP
      text "a;b"   ; not a comment in the string
    raw 0007*3 FFFF
    """
    assert (
        assembled(program)
        == words(
            "0802 8002 0001 000A 01F5 0912 0044 0002 0064 014B 00C8 019B"
            " 0E01 0008 0064 01C3 FFFF 0010 0C09 0003 3B61 0062 0007 0007 0007 FFFF"
        ).tolist()
    )


A_NUMBER = "a number must be -32768 to 65535, decimal or after 0x, not"
A_WORD = "a word must be 0000 to FFFF, or one with *times to 32768, not"

test_wrong_listings_are_refused_with_their_line = refused(
    assembled,
    [
        ("DRAW", "line 1: an instruction must be one of the table, not 'DRAW'; write its words after raw"),
        ("SET FORE=1,2", "line 1: FORE must be 1 numbers, not '1,2'; give all"),
        ("SET FORE=65536", f"line 1: {A_NUMBER} '65536'; write it so"),
        ("NOP\nSET FORE=-32769", f"line 2: {A_NUMBER} '-32769'; write it so"),
        (
            "SET COLOR=1",
            "line 1: what follows SET must be a flag, an operand or a length, not 'COLOR=1'; "
            "see `ramtek list`",
        ),
        ("to 1,2", "line 1: data must follow an instruction that takes them, not 'to'; put one before it"),
        (
            "WVL 4 bytes",
            "line 1: WVL must have data of 4 bytes, not of 0; leave the length out to have it counted",
        ),
        (
            "WT 65536 bytes",
            "line 1: a length must be 0 to 65535 and stand before the word bytes, not '65536'; write it so",
        ),
        ("raw XYZ", f"line 1: {A_WORD} 'XYZ'; mend it"),
        ("raw 0001*32769", f"line 1: {A_WORD} '0001*32769'; mend it"),
        ("raw 0001*32768 0002", "line 1: a line must be at most 32768 words, not 32769; break it"),
        ('WT\ntext "a', "line 2: a string must end with a quotation mark, not as '\"a'; add it"),
        (
            'WT\ntext "a\u20ac"',
            "line 2: text must be in quotation marks, its codes 0 to 255, not '\"a\u20ac\"'; write it so",
        ),
        ("WVL\nto 1", "line 2: a point must be element,line, not '1'; write it so"),
        ("WCSS element=1", "line 1: WCSS must have all its operands; add line_and_state"),
        ("byte 100", "line 1: a byte must be 00 to FF, not '100'; write one"),
        ("byte", "line 1: a byte must be 00 to FF, not ''; write one"),
        ("byte 01\nNOP", "line 2: the byte of line 1 must be the last of the stream; delete one of them"),
        (
            "x" * (MOST_LINE + 1),
            f"line 1: a line must be at most {MOST_LINE} characters, not {MOST_LINE + 1}; break it",
        ),
    ],
)


def test_the_largest_numbers_words_and_lines_are_taken() -> None:
    assert assembled("SET STRT=-32768,65535") == [0x0802, 0x8000, 0x8000, 0xFFFF]
    for count in (32767, 32768):
        assert assembled(f"raw 0001*{count}") == [1] * count
    for characters in (MOST_LINE - 1, MOST_LINE):
        assert tokens_of("x" * characters, 7) == ["x" * characters]


TEXTS = st.text('SETWVrawto1290,.;=*"\\ \0\u0663\u20ac', max_size=30)


@given(st.lists(TEXTS | st.sampled_from(["SET", "WT", "to 1,2", 'text "a"', "raw 0"]), max_size=8))
def test_any_text_is_assembled_or_refused(lines: list[str]) -> None:
    with suppress(ListingError):
        assert all(isinstance(part, bytes) for part in assemble(lines))


@pytest.mark.parametrize(
    ("line", "tokens"),
    [
        ("", []),
        ("  ; only a comment", []),
        ("00004: 0802 8000 000A 01F5            SET STRT=10,501", ["SET", "STRT=10,501"]),
        ("SET FORE=1;BK", ["SET", "FORE=1"]),
        (r'text "a;b" "say \"no\""', ["text", '"a;b"', r'"say \"no\""']),
        ("0802 0002", ["0802", "0002"]),
    ],
)
def test_a_line_is_split_into_tokens(line: str, tokens: list[str]) -> None:
    assert tokens_of(line, 1) == tokens


@given(st.binary(max_size=20))
def test_a_string_of_escapes_holds_any_bytes(data: bytes) -> None:
    assert string_of('"' + "".join(f"\\x{byte:02X}" for byte in data) + '"', 1) == data


@pytest.mark.parametrize("line", ["9" * 9000, "SET " + "9" * 9000, "WVL\nto " + "7 " * 9000])
def test_a_message_quotes_the_beginning_of_a_long_word(line: str) -> None:
    with pytest.raises(ListingError, match=r", not '\w.{58}\.\.\.; \w") as caught:
        assembled(line)
    assert len(str(caught.value)) < 250
