from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, GMR_9300, NCAR_9460, PRINCETON_9300, Ramtek9300, ReplyError, instructions
from ramtek_emu.instruction_set.instruction import normal
from ramtek_emu.instruction_set.table import FORMATS, OPERANDS, Flags, InstructionFormat
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import colored, read, sent
from tests.ramtek_emu.recorded_streams import OUTLINE
from tests.ramtek_emu.strategies import SMALL, sent_words


def test_asking_for_more_than_waits_is_refused_by_name() -> None:
    display = sent("0B03 0040 0000 0000 0003 0000 0008")
    with pytest.raises(ReplyError) as refusal:
        display.receive(5)
    assert str(refusal.value) == (
        "the words received must be 0 to 4, which wait, not 5; send an instruction that reads them first"
    )
    assert display.receive(3).tolist() == [0, 0, 0]
    assert display.receive(1).tolist() == [0]


def test_unread_replies_do_not_fill_the_memory() -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array([0x0B01, 0xFFFF] * 400, np.uint16))
    assert display.processor.waiting == 1 << 22


@given(st.lists(st.integers(0, 9), max_size=6), st.lists(st.integers(0, 12), max_size=8))
def test_replies_are_read_in_order_however_many_words_are_taken(sizes: list[int], takes: list[int]) -> None:
    processor = Ramtek9300(SMALL).processor
    whole: list[int] = []
    for size in sizes:
        reply = np.arange(len(whole), len(whole) + size, dtype=np.uint16)
        whole += reply.tolist()
        processor.reply(reply)
    for count in takes:
        count = min(count, processor.waiting)
        taken, whole = whole[:count], whole[count:]
        assert processor.take_reply(count).tolist() == taken
        assert processor.waiting == len(whole)


def test_the_swap_flag_changes_the_two_colors() -> None:
    processor = Ramtek9300(SMALL).processor
    processor.parameters.foreground, processor.parameters.background = 7, 2
    assert processor.colors(normal("ERS", {})) == (7, 2)
    assert processor.colors(normal("ERS", {}, flags=Flags.SWAP)) == (2, 7)


@given(st.lists(st.tuples(*[st.integers(-0x8000, 0x7FFF)] * 2), min_size=1, max_size=5))
def test_relative_points_are_counted_on_in_registers_of_16_bits(points: list[tuple[int, int]]) -> None:
    processor = Ramtek9300(SMALL).processor
    element = line = 0
    expected = []
    for across, down in points:
        element, line = (
            (element + across + 0x8000) % 0x10000 - 0x8000,
            (line + down + 0x8000) % 0x10000 - 0x8000,
        )
        expected.append([element, line])
    assert processor.placed(np.array(points, np.int64), Flags.RELATIVE).tolist() == expected


def test_many_short_replies_take_little_more_memory_than_their_words() -> None:
    display = Ramtek9300()
    asked = np.full(2_000, 0x1700, np.uint16)
    display.send(asked)
    tracemalloc.start()
    display.send(asked)
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert display.processor.waiting == 8_000
    assert grown < 40_000


def test_replies_belong_to_the_host_that_received_them() -> None:
    display = Ramtek9300()
    display.send(np.full(4, 0x1700, np.uint16))
    words = display.receive(3)
    words[:] = 5
    assert display.receive(5).tolist() == [0] * 5


def test_recorded_cursors_are_read_back_as_they_were_written() -> None:
    display = Ramtek9300(PRINCETON_9300)
    # Cursor 0 at (100, 100), visible and blinking; cursor 1 visible at (100, 64).
    display.send(sent_words([0x1600, 0x0064, 0x0C64, 0x1601, 0x0064, 0x0440]))
    assert read(display, 0x1700) == [100, 0x0C64]
    assert read(display, 0x1701) == [100, 0x0440]
    assert display.cursors[0].is_visible
    assert display.cursors[0].blinks
    assert not display.cursors[1].blinks
    assert display.status == Status.READY


def test_a_loaded_shape_has_its_left_dots_in_the_high_bits_of_the_low_byte() -> None:
    display = colored(Ramtek9300(NCAR_9460))
    plain = display.field()
    # The first row: its first, second and last dot; the others empty.
    display.send(sent_words([0x3001, 0x0080, 0x00C0, 0x0100, *[0] * 62]))
    display.send(sent_words([0x2D01, 1000, 500, 0x0600]))
    lines, elements = np.nonzero((display.field() != plain).any(axis=2))
    assert lines.tolist() == [485] * 3
    assert elements.tolist() == [985, 986, 1016]
    assert read(display, 0x2F01) == [1000, 500, 0x0600]


def test_pixel_coordinates_go_through_origin_zoom_and_video_origin() -> None:
    display = Ramtek9300(NCAR_9460)
    display.send(sent_words([0x2C00, 1200, 0x400 | 900]))
    assert read(display, 0x2E00) == [1200, 0x400 | 900]
    display.send(sent_words([0x0802, 0x0020, 100, 50, 0x2600, 0x0103, 0x2C00, 110, 0x400 | 60]))
    assert (display.cursors[0].element, display.cursors[0].line) == (40, 20)
    assert read(display, 0x2E00) == [110, 0x400 | 60]
    display.send(sent_words([0x2701, 0x2C00, 110, 0x400 | 60]))
    assert (display.cursors[0].element, display.cursors[0].line) == (40, 1003)
    assert read(display, 0x2E00) == [110, 0x400 | 60]
    # If the origin wraps, the pixel under the cursor wraps too.
    display.send(sent_words([0x2700, 0x0802, 0x0020, 1270, 1020, 0x1600, 80, 0x400 | 20]))
    assert read(display, 0x2E00) == [(1270 + 20) % 1280, 0x400 | (1020 + 10) % 1024]


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300])
def test_cursors_that_are_not_there_answer_and_are_flagged(configuration: object) -> None:
    display = Ramtek9300(configuration)  # type: ignore[arg-type]
    display.send(sent_words([0x1607, 5, 6]))
    assert read(display, 0x1709) == [0, 0]
    assert Status.ILLEGAL in display.status


def test_recorded_rrr_draws_its_figure_and_its_letters() -> None:
    display = Ramtek9300()
    display.send(OUTLINE)
    words = display.words
    assert set(np.unique(words)) == {0, 128, 256}
    assert (words[200, 201:350] == 256).all()
    assert (words[51:200, 200] == 256).all()
    assert (words[100, 101:200] == 128).all()
    shapes = characters()
    for letter, element, line, word in (("a", 90, 90, 256), ("c", 205, 40, 256), ("f", 240, 110, 128)):
        cell = words[line : line + 9, element : element + 7]
        assert (cell == np.where(shapes[ord(letter)], word, 0)).all()
    assert display.status == Status.READY


def test_a_circle_that_was_drawn_is_filled_from_its_center() -> None:
    display = Ramtek9300(FAMILY)
    # The disabled code of the weather driver: circle, then fill until the foreground.
    display.send(sent_words([0x6D0B, 0x0002, 9, 6, 300, 200, 50, 0x3A0D, 0x0001, 0xFF, 2, 0]))
    lines, elements = np.ogrid[:480, :640]
    away = np.sqrt((lines - 200) ** 2 + (elements - 300) ** 2)
    assert (display.words[away < 49.5] == 9).all()
    assert not display.words[away > 50.5].any()


def test_a_conic_comes_as_pairs_of_words_or_as_single_ones() -> None:
    pairs, singles = Ramtek9300(FAMILY), Ramtek9300(FAMILY)
    pairs.send(sent_words([0x0F03, 0x9002, 7, 0, 1, 0, 1, 0, 0, 0, -80, 0, 0, 0, 0, 100, 100, 4, 140, 60]))
    singles.send(sent_words([0x0F03, 0x9002, 7, 1, 1, 0, -80, 0, 0, 100, 100, 4, 140, 60]))
    assert (pairs.words == singles.words).all()
    assert pairs.processor.parameters.start == (140, 60)
    assert np.count_nonzero(pairs.words) > 40
    lines, elements = np.nonzero(pairs.words)
    assert np.abs(np.hypot(elements - 140, lines - 100) - 40).max() < 0.75
    # The coefficients stay: another quarter with a number of pixels, as extended pairs.
    pairs.send(sent_words([0x0F02, 0x9000, 0, 1, 0, 1, 0, 0, -1, -80, 0, 0, 0, 5, 300, 300]))
    assert np.count_nonzero(pairs.words[250:350, 250:350]) == 5
    # READP replies six words, which SET takes.
    pairs.send(sent_words([0x2402, 0x1000]))
    assert pairs.receive(6).tolist() == [1, 1, 0, 0xFFB0, 0, 5]


def test_a_loaded_character_takes_the_place_of_its_code() -> None:
    display = Ramtek9300(FAMILY)
    rows = [0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01, 0xFF, 0x00, 0xAA, 0x55]
    display.send(sent_words([0x1541] + [rows[row] << 8 | rows[row + 1] for row in range(0, 12, 2)]))
    # Cells of 8 x 12, at (20, 30).
    display.send(sent_words([0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    dots = np.unpackbits(np.array(rows, np.uint8)[:, np.newaxis], axis=1)
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    # The standard font is the ROM; the loaded font can be attached again, and survives RSET.
    display.send(sent_words([0x4EFF, 0x0C03, 0x0140, 20, 30, 99, 99, 7, 9, 1, 0x4100]))
    assert (display.words[30:39, 20:27] == 5 * characters()[0x41]).all()
    display.send(sent_words([0x0500, 0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    display.send(sent_words([0x2142] + [rows[row + 1] << 8 | rows[row] for row in range(0, 12, 2)]))
    assert (display.processor.loaded_characters[0x42] == dots).all()


def test_the_recorded_polyline_of_the_weather_driver_has_gaps() -> None:
    display = Ramtek9300(NCAR_9460)
    display.send(sent_words([0x0E0F, 0x8002, 8, 7, 10, 532, 0xFF00, 0x1000, 8, 100, 532, 100, 602]))
    assert display.words[532, 10:42].tolist() == ([7] * 8 + [0] * 8) * 2
    # The pattern runs on around the corner: 90 pixels before it, 5 more eights and 10.
    assert display.words[533:541, 100].tolist() == [0] * 5 + [7] * 3


@pytest.mark.parametrize(
    ("text", "pixels"),
    [
        ("0EC3 8002 5 2 2 8 3 0 FFFF 2", [(2, 2), (3, 2), (4, 2), (5, 2), (4, 3), (4, 4)]),
        ("3503 0002 5 10 1 1 3 1 6 4 6 4", [(1, 1), (2, 1), (3, 1), (6, 4)]),
        ("3803 0002 5 8 2 3 4 5", [(2, 3), (4, 5)]),
        ("6D03 0002 5 C 5 5 1 3 6 0", [(5, 4), (4, 5), (6, 5), (5, 6), (3, 6)]),
    ],
)
def test_lines_points_and_circles_leave_the_operating_point_at_the_last(
    text: str, pixels: list[tuple[int, int]]
) -> None:
    display = sent(text)
    lines, elements = np.nonzero(display.words == 5)
    assert sorted(zip(elements.tolist(), lines.tolist(), strict=True)) == sorted(pixels)
    assert np.count_nonzero(display.words) == len(pixels)
    assert display.processor.parameters.start == pixels[-1]


@given(st.lists(st.sampled_from(list(OPERANDS)), unique=True), st.integers(0, 0x7FFF))
def test_parameters_are_read_as_they_were_set(chosen: list[str], seed: int) -> None:
    display = Ramtek9300(FAMILY)
    operands = {
        name: [(seed + 77 * place) & 0x7FFF for place in range(OPERANDS[name].words)] for name in chosen
    }
    display.send(instructions.set_parameters(**operands))
    names = [name for name in OPERANDS if name in chosen]
    bits = sum(1 << list(OPERANDS).index(name) for name in names)
    display.send(sent_words([0x2406, bits & 0xFFFF, bits >> 16]))
    received = display.receive(display.processor.waiting).tolist()
    if names:
        assert received == [word for name in names for word in operands[name]]
    else:
        assert len(received) == sum(operand.words for operand in OPERANDS.values())


def test_saved_environments_come_back_in_reverse() -> None:
    display = Ramtek9300(FAMILY)
    display.send(sent_words([0x0802, 2, 5, 0x1300, 0x0802, 2, 6, 0x2600, 0x0101, 0x1300, 0x0802, 2, 7]))
    assert display.processor.parameters.foreground == 7
    display.send(sent_words([0x1400]))
    assert (display.processor.parameters.foreground, display.processor.parameters.zoom) == (6, (2, 2))
    display.send(sent_words([0x1400]))
    assert (display.processor.parameters.foreground, display.processor.parameters.zoom) == (5, (1, 1))
    assert display.status == Status.READY
    display.send(sent_words([0x1400]))
    assert display.processor.parameters.foreground == 5
    assert display.processor.status == Status.READY | Status.ILLEGAL


def test_environments_beyond_the_most_are_flagged_and_not_saved() -> None:
    display = Ramtek9300(FAMILY)
    display.send(np.full(16, 0x1300, np.uint16))
    assert len(display.processor.saved) == 16
    assert Status.ILLEGAL not in display.status
    display.send(np.full(5000, 0x1300, np.uint16))
    assert len(display.processor.saved) == 16
    assert Status.ILLEGAL in display.status
    display.send(instructions.initialize())
    assert not display.processor.saved


def test_zoom_and_video_origin_have_the_lowest_bits_of_their_words() -> None:
    display = Ramtek9300(FAMILY)
    for word, zoom in [(0, (1, 1)), (0x0102, (3, 2)), (0x0F0F, (16, 16)), (0xF3F5, (6, 4))]:
        display.send(sent_words([0x2600, word]))
        assert display.processor.parameters.zoom == zoom
    for low_byte in (1, 0, 3, 2, 0xFF, 0xFE):
        display.send(sent_words([0x2700 | low_byte]))
        assert display.processor.parameters.origin_at_bottom is bool(low_byte % 2)


def test_the_error_status_is_read_and_cleared() -> None:
    display = Ramtek9300(FAMILY)
    display.send(sent_words([0xFFFF, 0x2500, 0x2500]))
    assert display.receive(2).tolist() == [Status.ILLEGAL, 0]
    assert display.status == Status.READY


@pytest.mark.parametrize("row", [row for row in FORMATS if row.unimplemented], ids=lambda row: row.name)
def test_instructions_known_by_name_only_are_consumed_and_flagged(row: InstructionFormat) -> None:
    display = Ramtek9300(SMALL)
    display.send(sent_words([row.opcode << 8 | 3, 2, 5, 4, 0x0500, 0x0600, 0x0902, 0x44, 3, 0, 0, 1, 1]))
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.processor.unimplemented == 1
    assert display.processor.parameters.foreground == 5
    assert (display.words[:2, :2] == 3).all()


def test_instructions_of_the_9460_are_illegal_words_on_the_9300_and_reset_clears_the_status() -> None:
    display = Ramtek9300(PRINCETON_9300)
    extended = [row for row in FORMATS if row.extended]
    for row in extended:
        display.send(instructions.reset())
        assert display.status == Status.READY
        display.send(sent_words([row.opcode << 8]))
        assert display.status == Status.READY | Status.ILLEGAL, row.name
        assert not display.decoder.pending_words
    assert display.processor.illegal_words == len(extended)


def test_initialize_restores_the_parameters_and_leaves_words_and_entries() -> None:
    display = sent("0300 0000 0002 1234", "0902 0044 0009 0000 0000 0000 0000", "0600")
    assert display.words[0, 0] == 9
    assert display.processor.parameters == Ramtek9300().processor.parameters
    display.send(instructions.reset())
    assert display.words[0, 0] == 0
    assert display.entries[0].tolist() == [0, 0x12, 0x34]
