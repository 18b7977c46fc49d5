from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import assemble
from tests.ramtek_emu.listings import listing
from tests.ramtek_emu.recorded_streams import words
from tests.ramtek_emu.strategies import streams, thorough


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
