from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, PRINCETON_9300
from ramtek_emu.instruction_set.decoder import MOST_WORDS, Decoder
from ramtek_emu.instruction_set.instruction import encode
from ramtek_emu.instruction_set.table import ILLEGAL
from ramtek_emu.testing import streams
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import cuts


def decoded(pieces: list[np.ndarray[tuple[int], np.dtype[np.uint16]]]) -> tuple[list[list[int]], Decoder]:
    decoder = Decoder()
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
    decoder = Decoder()
    for word in np.random.default_rng(seed).integers(0, 1 << 16, (2000, 1), np.uint16):
        list(decoder.feed(word))
        assert decoder.pending_words < MOST_WORDS


def test_data_are_views_of_the_words_sent() -> None:
    stream = np.array([0x0A01, 6, 1, 2, 3], np.uint16)
    (instruction,) = Decoder().feed(stream)
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
    instructions = list(Decoder().feed(np.array([*six, *twelve], np.uint16)))
    assert [instruction.data.tolist() for instruction in instructions] == [[90, 110], [90, 110]]
    assert [instruction.operands["start"] for instruction in instructions] == [(100, 100)] * 2


@given(streams(300), st.booleans())
def test_rows_of_illegal_words_equal_single_illegal_words(stream: list[int], extended: bool) -> None:
    configuration = GMR_9300 if extended else PRINCETON_9300
    single, rows = Decoder(configuration), Decoder(configuration)
    words = np.array(stream, np.uint16)
    one_by_one = [encode(instruction).tolist() for instruction in single.feed(words)]
    in_rows = [encode(instruction).tolist() for instruction in rows.feed(words, in_rows=True)]
    assert list(itertools.chain(*in_rows)) == list(itertools.chain(*one_by_one))
    assert rows.pending_words == single.pending_words


def test_an_instruction_known_by_name_only_is_consumed_whole() -> None:
    # WPB with a foreground and data, a keyboard instruction, a display list's.
    stream = np.array([0x1003, 0x0002, 7, 3, 1, 2, 0x1800, 0x4100, 0x0700], np.uint16)
    names = [instruction.format.name for instruction in Decoder().feed(stream)]
    assert names == ["WPB", "WKB", "CDL", "NOP"]
    strict = [instruction.format.name for instruction in Decoder(PRINCETON_9300).feed(stream)]
    assert strict == ["???"] * 8 + ["NOP"]


def test_a_9300_knows_no_second_operand_flag_word() -> None:
    stream = np.array([0x0804, 0x0001, 0x0700], np.uint16)
    strict = [instruction.format for instruction in Decoder(PRINCETON_9300).feed(stream)]
    assert strict[0] is ILLEGAL
    (instruction,) = Decoder().feed(stream)
    assert instruction.operands == {"read_mask": (0x0700,)}
