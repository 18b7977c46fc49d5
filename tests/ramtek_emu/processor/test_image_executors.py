"""Images, rasters, areas and copies, against twins that go word by word."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import PRINCETON_9300, Configuration, Ramtek9300, instructions
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.testing import rasters
from tests.ramtek_emu import reference
from tests.ramtek_emu.displays import box, sent
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, sent_words, windows

addressings = st.sampled_from([0x00, 0x40, 0x80, 0xC0])


def filled(raster: NDArray[np.uint16]) -> Ramtek9300:
    display = Ramtek9300(SMALL)
    display.send(instructions.write_image(raster))
    return display


def packed(data: bytes, low_first: bool) -> list[int]:
    padded = data + bytes(len(data) % 2)
    words: list[int] = np.frombuffer(padded, "<u2" if low_first else ">u2").tolist()
    return words


@given(
    rasters(),
    windows(),
    scan_codes,
    points | st.none(),
    addressings,
    points,
    st.binary(max_size=300),
    st.booleans(),
    st.booleans(),
    masks,
    windows(),
)
def test_images_of_every_kind_equal_the_twin(
    raster: NDArray[np.uint16],
    window: Window,
    code: int,
    start: Point | None,
    addressing: int,
    base: Point,
    data: bytes,
    bytes_for_pixels: bool,
    low_first: bool,
    mask: int,
    clip: Window,
) -> None:
    display = filled(raster)
    display.send(
        instructions.set_parameters(
            mask=mask,
            start=base,
            index_1=(3, -4),
            index_2=(-7, 2),
            scan_order=code,
            write_window=clip,
            image_mode=int(bytes_for_pixels),
            read_mask=0x2F5,
        )
    )
    operands = [0x0040 | (0x8000 if start else 0), *window, *(start or ())]
    low = 0x03 | addressing | (0x08 if low_first else 0)
    display.send(sent_words([0x0A00 | low, *operands, len(data), *packed(data, low_first)]))

    across, down = {0x00: (0, 0), 0x40: (3, -4), 0x80: (-7, 2), 0xC0: base}[addressing]
    moved = (window.left + across, window.top + down, window.right + across, window.bottom + down)
    begin = reference.corner(moved, code) if start is None else (start.element + across, start.line + down)
    words = list(data) if bytes_for_pixels else packed(data, low_first)[: len(data) // 2]
    twin = raster.tolist()
    after = reference.write_scan(twin, moved, code, begin, words, mask & 1023, clip, bytes_for_pixels)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == after

    # Read the words back from the start of the run.
    display.send(sent_words([0x0B03 | low, 0x8000, begin[0], begin[1], len(data)]))
    if addressing:
        return
    read, _ = reference.read_scan(twin, moved, code, begin, len(words), bytes_for_pixels)
    read = [word & 0x2F5 for word in read]
    if bytes_for_pixels:
        read = packed(bytes(word & 0xFF for word in read), low_first)
    assert display.receive(display.processor.waiting).tolist() == read


@given(
    rasters(),
    windows(),
    scan_codes,
    points,
    st.binary(max_size=60),
    st.booleans(),
    st.booleans(),
    st.booleans(),
    masks,
    windows(),
)
def test_rasters_of_every_kind_equal_the_twin(
    raster: NDArray[np.uint16],
    window: Window,
    code: int,
    start: Point,
    data: bytes,
    low_first: bool,
    swapped: bool,
    additive: bool,
    mask: int,
    clip: Window,
) -> None:
    display = filled(raster)
    display.send(
        instructions.set_parameters(
            mask=mask, foreground=700, background=300, window=window, scan_order=code, start=start,
            write_window=clip,
        )
    )  # fmt: skip
    low = 0x01 | (0x08 if low_first else 0) | (0x10 if swapped else 0) | (0x20 if additive else 0)
    display.send(sent_words([0x0D00 | low, len(data), *packed(data, low_first)]))
    twin = raster.tolist()
    bits = [byte >> bit & 1 for byte in data for bit in range(7, -1, -1)]
    places = reference.walk(window, code, start, len(bits))
    one, zero = (300, 700) if swapped else (700, 300)
    for place, bit in zip(places, bits, strict=False):
        if bit or not additive:
            reference.write_pixel(twin, place, one if bit else zero, mask & 1023, clip)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == places[-1]


@given(
    rasters(), st.integers(0, 3), points, windows(), st.integers(0, 1), st.sampled_from([0, 1, 2, 3, 0xFFFF])
)
def test_a_filled_area_has_the_pixels_that_a_walk_reaches(
    raster: NDArray[np.uint16], foreground: int, start: Point, clip: Window, mode: int, read_mask: int
) -> None:
    raster = raster % 4
    display = filled(raster)
    display.send(
        instructions.set_parameters(
            foreground=foreground, start=start, write_window=clip, read_mask=read_mask
        )
    )
    display.send(sent_words([0x3A01, 2, mode]))
    twin = raster.tolist()

    def is_open(place: tuple[int, int]) -> bool:
        element, line = place
        if not (0 <= element < 13 and 0 <= line < 9 and reference.inside(place, clip)):
            return False
        word = int(raster[line, element]) & read_mask
        seed = int(raster[start.line, start.element]) & read_mask
        return word == seed if mode else word != foreground & read_mask

    in_memory = 0 <= start.element < 13 and 0 <= start.line < 9
    waiting = [tuple(start)] if in_memory and is_open(start) else []
    reached = set(waiting)
    while waiting:
        element, line = waiting.pop()
        twin[line][element] = foreground
        for place in ((element + 1, line), (element - 1, line), (element, line + 1), (element, line - 1)):
            if place not in reached and is_open(place):
                reached.add(place)
                waiting.append(place)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == start


@given(rasters(), windows(), scan_codes, points, masks, masks, windows(), st.booleans())
def test_a_copy_is_every_word_of_the_window_at_once(
    raster: NDArray[np.uint16],
    window: Window,
    code: int,
    corner: Point,
    mask: int,
    read_mask: int,
    clip: Window,
    by_data: bool,
) -> None:
    display = filled(raster)
    display.send(
        instructions.set_parameters(
            mask=mask, read_mask=read_mask, window=window, scan_order=code, write_window=clip, start=corner
        )
    )
    display.send(sent_words([0x6901, 4, *corner] if by_data else [0x6900]))
    twin = raster.tolist()
    first = reference.corner(window, code)
    across, down = corner.element - first[0], corner.line - first[1]
    for line in range(9):
        for element in range(13):
            if reference.inside((element, line), window):
                place, word = (element + across, line + down), int(raster[line, element]) & read_mask
                reference.write_pixel(twin, place, word, mask & 1023, clip)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == corner


def test_a_bulk_erase_heeds_the_mask_and_no_window() -> None:
    display = Ramtek9300(SMALL)
    display.send(
        instructions.set_parameters(background=9, mask=0xFFF3, window=(1, 1, 2, 2), write_window=(1, 1, 2, 2))
    )
    display.send(sent_words([0x2B00]))
    assert (display.words == 1).all()
    display.send(sent_words([0x2B12, 0x0003, 0xFFFF, 6]))
    assert (display.words == 6).all()


@given(st.integers(0, 40), st.integers(0, 300))
def test_dots_that_go_around_a_small_window_leave_the_last_ones(width: int, count: int) -> None:
    display = Ramtek9300(SMALL)
    data = bytes(np.random.default_rng(count).integers(0, 256, count, np.uint8))
    display.send(sent_words([0x0D23, 0x0042, 5, 1, 1, 1 + width % 4, 2, len(data), *packed(data, False)]))
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    size = 2 * (1 + width % 4)
    expected = [5 if bits[number::size].any() else 0 for number in range(size)]
    assert display.words[1:3, 1 : 2 + width % 4].reshape(-1).tolist() == expected


@pytest.mark.parametrize("noise", [0.3, 0.5, 0.62, 0.9])
def test_a_large_area_is_filled_whole(noise: float) -> None:
    display = Ramtek9300()
    words = (np.random.default_rng(3).random((480, 640)) < noise).astype(np.uint16)
    words[240, 320] = 0
    display.send(instructions.write_image(words))
    display.send(sent_words([0x0802, 0x8002, 1, 320, 240, 0x3A01, 2, 0]))
    filled_words = display.words == 1
    # No open pixel is left beside the filled area.
    new = filled_words & (words == 0)
    left = ~filled_words
    assert not (new[1:] & left[:-1]).any()
    assert not (new[:-1] & left[1:]).any()
    assert not (new[:, 1:] & left[:, :-1]).any()
    assert not (new[:, :-1] & left[:, 1:]).any()


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


def test_an_image_without_operands_continues_the_last_image() -> None:
    display = sent("0A03 0040 0002 0001 0004 0005 0008 0001 0002 0003 0004", "0A01 0004 0005 0006")
    assert display.words[1:3, 2:5].tolist() == [[1, 2, 3], [4, 5, 6]]


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
    reference.write_scan(
        twin, corners, code, reference.corner(corners, code), row, 1023, (-(10**6), -(10**6), 10**6, 10**6)
    )
    assert display.words.tolist() == twin
    display.send(np.array([0x0B03, 0x0040, *(number & 0xFFFF for number in window), 2 * len(row)], np.uint16))
    read, _ = reference.read_scan(twin, corners, code, reference.corner(corners, code), len(row))
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


@given(st.integers(1, 70), st.integers(1, 1200), st.integers(-40, 40))
def test_images_of_any_shape_arrive_whole(lines: int, elements: int, left: int) -> None:
    configuration = Configuration(name="WIDE", elements=1300, lines=80, planes=10)
    words = (np.arange(lines * elements) % 1023 + 1).reshape(lines, elements)
    display = Ramtek9300(configuration)
    display.send(instructions.write_image(words, left, 3))
    first = min(elements, max(0, -left))
    assert (display.words[3 : 3 + lines, max(0, left) : max(0, left + elements)] == words[:, first:]).all()
    assert np.count_nonzero(display.words) == lines * (elements - first)


def test_byte_images_hold_two_pixels_a_word() -> None:
    # A 4 x 4 image of the NCAR driver, reverse packed.
    display = sent(
        "0A0F 00C0 0020 0008 0010 000B 0013 0000 0001 0010 0201 0403 0605 0807 0A09 0C0B 0E0D 100F",
        "0B0B 0040 0008 0010 000B 0013 0005",
        "0B03 0040 0008 0010 000B 0013 0004",
    )
    assert display.words[16:20, 8:12].tolist() == np.arange(1, 17).reshape(4, 4).tolist()
    assert display.receive(5).tolist() == [0x0201, 0x0403, 0x0005, 0x0102, 0x0304]


def test_recorded_byte_image_line_of_the_vicar_driver() -> None:
    display = sent(
        "0A0F 80C1 0020 00FF 0000 0000 027F 01DF 0000 000A 0001 0001 0010 "
        "0100 0302 0504 0706 0908 0B0A 0D0C 0F0E"
    )
    assert display.words[1, 10:26].tolist() == list(range(16))
    assert display.processor.parameters.start == (26, 1)


def test_byte_images_write_whole_pairs_also_at_the_edge_of_an_odd_window() -> None:
    # Three elements, two lines: each line takes two words, and its fourth pixel lies beside the window.
    display = sent(
        "0802 0004 0009 0900",
        "0A0F 0040 0020 000A 0014 000C 0015 0001 0008 0201 0403 0605 0807",
        "0B0F 0040 0020 000A 0014 000C 0015 0001 0008",
    )
    assert display.words[20:22, 9:15].tolist() == [[9, 1, 2, 3, 4, 9], [9, 5, 6, 7, 8, 9]]
    assert display.receive(4).tolist() == [0x0201, 0x0403, 0x0605, 0x0807]
    assert display.processor.parameters.start == (10, 20)


def test_lines_that_are_not_padded_are_offset_in_an_odd_window_as_on_the_hardware() -> None:
    # Nine bytes without padding for three lines of three: each line begins one byte too late.
    display = sent("0A0F 0040 0020 000A 0014 000C 0016 0001 0009 0201 0403 0605 0807 0009")
    assert display.words[20:23, 10:14].tolist() == [[1, 2, 3, 4], [5, 6, 7, 8], [9, 0, 0, 0]]


def test_the_write_window_keeps_the_second_pixel_of_a_pair_inside() -> None:
    window = "000A 0014 000C 0015"
    display = sent(f"0A0F 0040 0022 {window} {window} 0001 0008 0201 0403 0605 0807")
    assert display.words[20:22, 10:14].tolist() == [[1, 2, 3, 0], [5, 6, 7, 0]]


def test_a_run_of_bytes_goes_on_with_the_next_pair() -> None:
    whole, cut = Ramtek9300(), Ramtek9300()
    head = [0x0A07, 0x0040, 0x0020, 5, 5, 9, 99, 1]
    data = packed(bytes(range(1, 61)), False)
    whole.send(sent_words([*head, 60, *data]))
    cut.send(sent_words([*head, 22, *data[:11], 0x0A01, 38, *data[11:]]))
    assert (cut.words == whole.words).all()
    assert whole.words[5:15, 5:11].reshape(-1).tolist() == list(range(1, 61))


def test_pairs_that_begin_inside_a_line_end_past_the_edge_of_an_even_window() -> None:
    display = sent("0A0F 8040 0020 000A 0014 000D 0015 000B 0014 0001 0008 0201 0403 0605 0807")
    assert display.words[20:22, 10:15].tolist() == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 0]]
    assert display.processor.parameters.start == (10, 20)


def test_tables_that_are_not_there_take_and_give_nothing() -> None:
    display = sent("0301 0000 0004 FFFF FFFF", "0401 0000 0004")
    assert not display.entries.any()
    assert display.receive(2).tolist() == [0, 0]


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
