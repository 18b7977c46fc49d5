from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import ListingError
from ramtek_emu.instruction_set.listing_tokens import (
    MOST_LINE,
    hexadecimal_words,
    numbers_of,
    string_of,
    tokens_of,
)
from tests.ramtek_emu.strategies import quick


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
def test_a_line_is_cut_into_what_an_instruction_is_written_with(line: str, tokens: list[str]) -> None:
    assert tokens_of(line, 1) == tokens


@quick
@given(st.lists(st.integers(-0x8000, 0xFFFF), min_size=1, max_size=6), st.booleans())
def test_numbers_become_words_in_decimal_and_in_hexadecimal(numbers: list[int], in_hexadecimal: bool) -> None:
    words = [number & 0xFFFF for number in numbers]
    text = ",".join(f"0x{word:X}" for word in words) if in_hexadecimal else ",".join(map(str, numbers))
    assert numbers_of(text, 1) == tuple(words)


def test_a_window_is_two_points_with_two_dots_between_them() -> None:
    assert numbers_of("-1,2..639,479", 1) == (0xFFFF, 2, 639, 479)


@quick
@given(st.lists(st.tuples(st.integers(0, 0xFFFF), st.integers(1, 9)), max_size=8))
def test_a_product_is_its_word_so_many_times(products: list[tuple[int, int]]) -> None:
    tokens = [f"{word:04X}*{times}" for word, times in products]
    expected = [word for word, times in products for _ in range(times)]
    assert hexadecimal_words(tokens, 1).tolist() == expected


@quick
@given(st.binary(max_size=20))
def test_a_string_of_escapes_holds_any_bytes(data: bytes) -> None:
    assert string_of('"' + "".join(f"\\x{byte:02X}" for byte in data) + '"', 1) == data


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
