from __future__ import annotations

from contextlib import suppress

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import listing
from tests.tables import refused


def assembled(program: str) -> list[int]:
    data = b"".join(assemble(program.splitlines()))
    numbers: list[int] = np.frombuffer(data, "<u2").tolist()
    return numbers


@given(
    streams().map(lambda stream: np.array(stream, "<u2").tobytes()) | st.binary(max_size=3000),
    st.sampled_from([FAMILY, PRINCETON_9300]),
)
def test_assembling_a_listing_gives_any_words_back(stream: bytes, configuration: Configuration) -> None:
    assert b"".join(assemble(listing(stream, configuration))) == stream[: len(stream) & ~1]


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
        ("raw XYZ", "line 1: a word must be 0000 to FFFF, or one with *times, not 'XYZ'; mend it"),
        ("R\0S\0", "line 1: a listing must be text in UTF-8, not in UTF-16; save it as UTF-8"),
        (
            'WT\ntext "a\u20ac"',
            "line 2: text must be in quotation marks, its codes 0 to 255, not '\"a\u20ac\"'; write it so",
        ),
        (
            "WI\nwords 0*32768",
            "line 1: the data must be at most 65535 bytes, not 65536; write two instructions",
        ),
        ("WVL\nto 1", "line 2: a point must be element,line, not '1'; write it so"),
        ("WCSS element=1", "line 1: WCSS must have all its operands; add line_and_state"),
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
