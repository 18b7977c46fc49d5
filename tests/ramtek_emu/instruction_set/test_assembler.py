from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, ListingError
from ramtek_emu.instruction_set.assembler import (
    MOST_LINE,
    assemble,
    hexadecimal_words,
    numbers_of,
    string_of,
    tokens_of,
)
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import listing, words


@given(streams(), st.binary(max_size=1), st.sampled_from([GMR_9300, PRINCETON_9300]))
def test_assembling_a_listing_gives_any_words_back(
    stream: list[int], odd_byte: bytes, configuration: Configuration
) -> None:
    data = np.array(stream, "<u2").tobytes() + odd_byte
    assert b"".join(assemble(listing(data, configuration))) == data


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
def test_wrong_listings_are_refused_with_their_line(line: str, sentence: str) -> None:
    with pytest.raises(ListingError) as refusal:
        list(assemble(line.splitlines()))
    number = 1 + line.count("\n")
    assert str(refusal.value).startswith(f"line {number}: {sentence}")


@given(
    st.lists(st.text(max_size=30) | st.sampled_from(["SET", "WT", "to 1,2", 'text "a"', "raw 0"]), max_size=8)
)
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


@given(st.lists(st.integers(-0x8000, 0xFFFF), min_size=1, max_size=6), st.booleans())
def test_numbers_become_words_in_decimal_and_in_hexadecimal(numbers: list[int], in_hexadecimal: bool) -> None:
    words = [number & 0xFFFF for number in numbers]
    text = ",".join(f"0x{word:X}" for word in words) if in_hexadecimal else ",".join(map(str, numbers))
    assert numbers_of(text, 1) == tuple(words)


def test_a_window_is_two_points_with_two_dots_between_them() -> None:
    assert numbers_of("-1,2..639,479", 1) == (0xFFFF, 2, 639, 479)


@given(st.lists(st.tuples(st.integers(0, 0xFFFF), st.integers(1, 9)), max_size=8))
def test_a_product_is_its_word_so_many_times(products: list[tuple[int, int]]) -> None:
    tokens = [f"{word:04X}*{times}" for word, times in products]
    expected = [word for word, times in products for _ in range(times)]
    assert hexadecimal_words(tokens, 1).tolist() == expected


@given(st.binary(max_size=20))
def test_a_string_of_escapes_holds_any_bytes(data: bytes) -> None:
    assert string_of('"' + "".join(f"\\x{byte:02X}" for byte in data) + '"', 1) == data


def test_a_line_may_have_as_many_characters_and_words_as_it_may() -> None:
    for characters in (MOST_LINE - 1, MOST_LINE):
        assert tokens_of("x" * characters, 7) == ["x" * characters]
    for count in (32767, 32768):
        assert len(hexadecimal_words([f"0001*{count}"], 3)) == count
    with pytest.raises(ListingError, match="to 32768, not"):
        hexadecimal_words(["0001*32769"], 3)
    with pytest.raises(ListingError, match="at most 32768 words, not 32769"):
        hexadecimal_words(["0001*32768", "0002"], 3)
    assert [numbers_of(text, 5) for text in ("-32768", "65535")] == [(32768,), (65535,)]
    with pytest.raises(ListingError, match="a number must be -32768 to 65535"):
        numbers_of("-32769", 5)


def test_a_refusal_names_its_line_and_what_to_do() -> None:
    with pytest.raises(ListingError) as refusal:
        tokens_of("x" * (MOST_LINE + 1), 7)
    assert str(refusal.value) == (
        f"line 7: a line must be at most {MOST_LINE} characters, not {MOST_LINE + 1}; break it"
    )
    with pytest.raises(ListingError) as refusal:
        hexadecimal_words(["0000*30000", "0001*30000"], 3)
    assert str(refusal.value) == "line 3: a line must be at most 32768 words, not 60000; break it"
    with pytest.raises(ListingError, match="line 5: a number must be -32768 to 65535"):
        numbers_of("65536", 5)


@pytest.mark.parametrize("line", ["9" * 9000, "SET " + "9" * 9000, "WVL\nto " + "7 " * 9000])
def test_a_message_quotes_the_beginning_of_a_long_word(line: str) -> None:
    with pytest.raises(ListingError, match=r", not '\w.{58}\.\.\.; \w") as caught:
        b"".join(assemble(line.split("\n")))
    assert len(str(caught.value)) < 250
