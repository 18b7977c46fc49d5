"""The instructions, by what they leave in the words; and streams recorded from programs of the time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import PRINCETON_9300, Configuration, Ramtek9300, ReplyError, instructions
from ramtek_emu.instruction_set.table import FORMATS
from ramtek_emu.processor.processor import EXECUTORS, Status
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, cuts, quick, scan_codes, streams, thorough, windows


def sent(*texts: str, configuration: Configuration | None = None) -> Ramtek9300:
    """A display that was sent these words, in hexadecimal."""
    display = Ramtek9300() if configuration is None else Ramtek9300(configuration)
    for text in texts:
        display.send(np.array([int(word, 16) for word in text.split()], np.uint16))
    return display


def box(display: Ramtek9300) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of the words that are not 0."""
    lines, elements = np.nonzero(display.words)
    return (int(elements.min()), int(lines.min()), int(elements.max()), int(lines.max()))


def test_every_row_of_the_table_has_its_function() -> None:
    assert {format.name for format in FORMATS} <= set(EXECUTORS)


@thorough
@given(streams(200), st.lists(st.integers(0, 200), max_size=5))
def test_no_words_at_all_raise_or_leave_the_planes(stream: list[int], places: list[int]) -> None:
    whole = Ramtek9300(SMALL)
    whole.send(np.array(stream, np.uint16))
    assert whole.words.max() <= 1023
    assert whole.field().shape == (9, 13, 3)
    cut = Ramtek9300(SMALL)
    for piece in cuts(stream, places):
        cut.send(piece)
    assert (cut.words == whole.words).all()
    assert (cut.entries == whole.entries).all()
    assert cut.status == whole.status
    assert cut.processor.parameters == whole.processor.parameters
    assert cut.processor.waiting == whole.processor.waiting
    assert (cut.receive(cut.processor.waiting) == whole.receive(whole.processor.waiting)).all()


def test_an_illegal_word_sets_the_status_and_reset_clears_it() -> None:
    display = sent("FFFF 0700")
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.processor.illegal_words == 1
    display.send(instructions.reset())
    assert display.status == Status.READY


def test_operands_stay_until_they_are_set_again() -> None:
    display = sent("0802 0004 0007", "0902 0040 0001 0001 0002 0002", "0900")
    assert display.words[1:3, 1:3].tolist() == [[7, 7], [7, 7]]
    assert display.frame_buffer.written == 8
    display.send(instructions.reset())
    display.send(instructions.erase())
    assert not display.words.any()


def test_initialize_restores_the_parameters_and_leaves_words_and_entries() -> None:
    display = sent("0300 0000 0002 1234", "0902 0044 0009 0000 0000 0000 0000", "0600")
    assert display.words[0, 0] == 9
    assert display.processor.parameters.background == 0
    assert display.processor.parameters.window == (0, 0, 639, 479)
    display.send(instructions.reset())
    assert display.words[0, 0] == 0
    assert display.entries[0].tolist() == [0, 0x12, 0x34]


def test_the_mask_keeps_the_other_planes() -> None:
    display = sent(
        "0902 0044 000F 0000 0000 0003 0000", "0802 0001 0003", "0902 0044 0000 0001 0000 0001 0000"
    )
    assert display.words[0, :5].tolist() == [15, 12, 15, 15, 0]


def test_bits_beyond_the_planes_are_dropped() -> None:
    display = sent("0A03 0040 0000 0000 0001 0000 0004 FFFF 0401")
    assert display.words[0, :3].tolist() == [1023, 1, 0]


def test_erase_with_the_swap_flag_uses_the_foreground() -> None:
    display = sent("0912 0043 00FF 0007 0064 0032 00C7 0063")
    assert box(display) == (100, 50, 199, 99)
    assert set(np.unique(display.words)) == {0, 7}


def test_erase_accepts_a_data_field_of_no_bytes() -> None:
    assert sent("0802 0004 0005", "0909 0000", "0700").words.min() == 5


def test_an_image_without_operands_goes_on_where_the_last_one_ended() -> None:
    display = sent("0A03 0040 0002 0001 0004 0005 0008 0001 0002 0003 0004", "0A01 0004 0005 0006")
    assert display.words[1:3, 2:5].tolist() == [[1, 2, 3], [4, 5, 6]]


@quick
@given(windows(), scan_codes, st.lists(st.integers(0, 1023), min_size=1, max_size=60))
def test_images_follow_the_scan_order_and_are_read_back(
    window: tuple[int, ...], code: int, row: list[int]
) -> None:
    display = Ramtek9300(SMALL)
    head = [0x0A03, 0x00C0, *(number & 0xFFFF for number in window), code, 2 * len(row)]
    display.send(np.array(head + row, np.uint16))
    twin = [[0] * 13 for _ in range(9)]
    left, top, right, bottom = window
    corners = (left, top, right, bottom)
    reference.write_run(
        twin, corners, code, reference.corner(corners, code), row, 1023, (-(10**6), -(10**6), 10**6, 10**6)
    )
    assert display.words.tolist() == twin
    display.send(np.array([0x0B03, 0x0040, *(number & 0xFFFF for number in window), 2 * len(row)], np.uint16))
    read, _ = reference.read_run(twin, corners, code, reference.corner(corners, code), len(row))
    assert display.receive(len(row)).tolist() == read


def test_a_whole_picture_survives_the_stream() -> None:
    words = np.random.default_rng(7).integers(0, 1024, (480, 640))
    display = Ramtek9300()
    display.send(instructions.write_image(words))
    assert (display.words == words).all()
    received: list[NDArray[np.uint16]] = []
    for stream, count in instructions.read_image(0, 0, 640, 480):
        display.send(stream)
        received.append(display.receive(count))
    assert (np.concatenate(received).reshape(480, 640) == words).all()


@quick
@given(st.integers(1, 70), st.integers(1, 1200), st.integers(-40, 40))
def test_images_of_any_shape_arrive_whole(lines: int, elements: int, left: int) -> None:
    configuration = Configuration(name="WIDE", elements=1300, lines=80, planes=10)
    words = (np.arange(lines * elements) % 1023 + 1).reshape(lines, elements)
    display = Ramtek9300(configuration)
    display.send(instructions.write_image(words, left, 3))
    first = min(elements, max(0, -left))
    assert (display.words[3 : 3 + lines, max(0, left) : max(0, left + elements)] == words[:, first:]).all()
    assert np.count_nonzero(display.words) == lines * (elements - first)


def test_addresses_count_from_index_registers_and_the_operating_point() -> None:
    display = sent("0802 0008 0005 0006", "0942 0044 0003 0000 0000 0001 0000")
    assert box(display) == (5, 6, 6, 6)
    display = sent("0802 0010 0009 0007", "0982 0044 0003 FFFF 0000 0000 0000")
    assert box(display) == (8, 7, 9, 7)
    # The text window of wtr() lies at the operating point.
    display = sent("0802 8000 0014 001E", "09C2 0044 0003 0000 0000 0006 0008")
    assert box(display) == (20, 30, 26, 38)


def test_byte_images_hold_two_pixels_a_word() -> None:
    # A 4 x 4 image of the NCAR driver, reverse packed.
    display = sent(
        "0A0F 00C0 0020 0008 0010 000B 0013 0000 0001 0010 0201 0403 0605 0807 0A09 0C0B 0E0D 100F",
        "0B0B 0040 0008 0010 000B 0013 0005",
        "0B03 0040 0008 0010 000B 0013 0004",
    )
    assert display.words[16:20, 8:12].tolist() == np.arange(1, 17).reshape(4, 4).tolist()
    assert display.receive(5).tolist() == [0x0201, 0x0403, 0x0005, 0x0102, 0x0304]


def test_asking_for_more_than_waits_is_refused_by_name() -> None:
    display = sent("0B03 0040 0000 0000 0003 0000 0008")
    with pytest.raises(ReplyError) as refusal:
        display.receive(5)
    assert str(refusal.value) == (
        "the words received must be 0 to 4, which wait, not 5; send an instruction that reads them first"
    )
    assert display.receive(3).tolist() == [0, 0, 0]
    assert display.receive(1).tolist() == [0]


def test_what_a_host_never_reads_does_not_fill_the_memory() -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array([0x0B01, 0xFFFF] * 400, np.uint16))
    assert display.processor.waiting == 1 << 22


def test_tables_that_are_not_there_take_and_give_nothing() -> None:
    display = sent("0301 0000 0004 FFFF FFFF", "0401 0000 0004")
    assert not display.entries.any()
    assert display.receive(2).tolist() == [0, 0]


def test_recorded_zp_clears_the_screen() -> None:
    display = sent("0802 0004 0009", "0900", "0910 0500")
    assert not display.words.any()


def test_recorded_rrr_draws_its_figure_and_its_letters() -> None:
    display = sent(
        "0802 0002 0100", "0802 8000 0064 0064", "0E01 0004 00C8 00C8", "0E01 0004 015E 00C8",
        "0E01 0004 015E 0032", "0E01 0004 00C8 0032", "0E01 0004 0064 0064", "0802 0102 0100 0007 0009",
        "0C03 0040 005A 005A 0064 0064 0001 6100", "0C03 0040 00CD 00CD 00D7 00D7 0001 6200",
        "0C03 0040 00CD 0028 00D7 0032 0001 6300", "0C03 0040 0163 0028 016D 0032 0001 6400",
        "0C03 0040 0163 00CD 016D 00D7 0001 6500", "0802 8002 0080 0064 0064", "0E01 0004 00FA 0064",
        "0E01 0004 015E 0032", "0802 8000 00FA 0064", "0E01 0004 015E 00C8", "0802 8002 0100 00C8 00C8",
        "0E01 0004 00C8 0032", "0802 0002 0080", "0C03 0040 00F0 006E 00FA 0078 0001 6600",
    )  # fmt: skip
    words = display.words
    assert set(np.unique(words)) == {0, 128, 256}
    assert (words[200, 201:350] == 256).all()
    assert (words[51:200, 200] == 256).all()
    assert (words[100, 101:200] == 128).all()
    shapes = display.processor.characters
    for letter, element, line, word in (("a", 90, 90, 256), ("c", 205, 40, 256), ("f", 240, 110, 128)):
        cell = words[line : line + 9, element : element + 7]
        assert (cell == np.where(shapes[ord(letter)], word, 0)).all()
    assert display.status == Status.READY


def test_recorded_sqap_numbers_its_squares_in_the_background() -> None:
    display = sent(
        "0802 0040 0000 0000 001F 001F", "0902 0004 0004", "0802 0006 0004 0000",
        "0C13 0040 0000 0000 0020 0020 0003 3030 3400",
        "0802 0040 0020 0000 003F 001F", "0902 0004 0006", "0802 0006 0006 0000",
        "0C13 0040 0020 0000 0040 0020 0003 3030 3600",
    )  # fmt: skip
    words = display.words
    assert (words[9:32, :32] == 4).all()
    assert (words[9:32, 32:64] == 6).all()
    shapes = display.processor.characters
    for number, letter in enumerate("004"):
        assert (words[:9, 7 * number : 7 * number + 7] == np.where(shapes[ord(letter)], 0, 4)).all()
    assert (words[:9, 46:53] == np.where(shapes[ord("6")], 0, 6)).all()


def test_recorded_band_draws_vertical_bars() -> None:
    texts = [f"0802 0040 {2 * i:04X} 0000 {2 * i + 1:04X} 0100 0902 0004 {i:04X}" for i in range(320)]
    display = sent(*texts)
    assert (display.words[:257] == np.arange(640) // 2).all()
    assert not display.words[257:].any()


def test_recorded_color_map_3_splits_the_word_four_three_three() -> None:
    table = [(i & 0o1700) << 2 | (i & 0o070) << 2 | (i & 0o007) << 1 for i in range(1024)]
    assert table[:9] == [0, 2, 4, 6, 8, 0xA, 0xC, 0xE, 0x20]
    display = sent(
        "0300 0000 0800 " + " ".join(f"{word:04X}" for word in table),
        "0300 03FF 0002 0000",
        configuration=PRINCETON_9300,
    )
    assert display.entries[0x1FF].tolist() == [7 * 17, 14 * 17, 14 * 17]
    assert display.entries[1022].tolist() == [255, 14 * 17, 12 * 17]
    # Parking the counter overwrites the last entry.
    assert display.entries[1023].tolist() == [0, 0, 0]
    assert display.lookup_table.address == 0


def test_recorded_byte_image_line_of_the_vicar_driver() -> None:
    display = sent(
        "0A0F 80C1 0020 00FF 0000 0000 027F 01DF 0000 000A 0001 0001 0010 "
        "0100 0302 0504 0706 0908 0B0A 0D0C 0F0E"
    )
    assert display.words[1, 10:26].tolist() == list(range(16))
    assert display.processor.parameters.start == (26, 1)


def test_recorded_polyline_of_the_vicar_driver() -> None:
    display = sent("0E03 8003 00FF 0005 0000 0000 0008 027F 01DF 013F 00EF")
    assert display.words[0, 0] == 5
    assert display.words[479, 639] == 5
    assert display.processor.parameters.start == (319, 239)


def test_text_packed_low_byte_first_is_the_same_text() -> None:
    low_first = sent("0C0B 0040 0064 01C3 026B 01FF 0006 4548 4C4C 204F")
    high_first = sent("0C03 0040 0064 01C3 026B 01FF 0006 4845 4C4C 4F20")
    assert (low_first.words == high_first.words).all()
    assert box(low_first)[:2] == (101, 452)
