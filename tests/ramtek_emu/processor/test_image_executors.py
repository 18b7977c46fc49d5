"""Images, rasters, areas and copies, against twins that go word by word."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import FAMILY, Configuration, Ramtek9300, instructions
from ramtek_emu.memory.scan_orders import Point, Window
from tests.ramtek_emu import reference
from tests.ramtek_emu.displays import box, read, sent
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, sent_words, windows

Raster = NDArray[np.uint16]
addressings = st.sampled_from([0x00, 0x40, 0x80, 0xC0])
rasters = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).integers(0, 1024, (9, 13), np.uint16)
)
"""Words of a small display."""


class Scan(NamedTuple):
    """How an instruction goes over the memory."""

    window: Window
    code: int
    start: Point
    mask: int
    clip: Window


scans = st.builds(Scan, windows(), scan_codes, points, masks, windows())


def filled(raster: Raster) -> Ramtek9300:
    display = Ramtek9300(SMALL)
    display.send(instructions.write_image(raster))
    return display


def packed(data: bytes, low_first: bool) -> list[int]:
    padded = data + bytes(len(data) % 2)
    words: list[int] = np.frombuffer(padded, "<u2" if low_first else ">u2").tolist()
    return words


images = st.builds(
    lambda seed, count: np.random.default_rng(seed).bytes(count), st.integers(0, 99), st.integers(0, 300)
)
"""Bytes that often go over a window several times."""


@given(rasters, scans, st.tuples(*[st.booleans()] * 3), addressings, points, images)
def test_images_of_every_kind_equal_the_twin(
    raster: Raster, scan: Scan, kinds: tuple[bool, bool, bool], addressing: int, base: Point, data: bytes
) -> None:
    has_start, bytes_for_pixels, low_first = kinds
    display = filled(raster)
    window, code, start, mask, clip = scan
    display.send(instructions.set_parameters(mask=mask, start=base, index_1=(3, -4), index_2=(-7, 2)))
    display.send(instructions.set_parameters(scan_order=code, write_window=clip, read_mask=0x2F5))
    display.send(instructions.set_parameters(image_mode=int(bytes_for_pixels), start=base))
    operands = [0x8040 if has_start else 0x0040, *window, *(start if has_start else ())]
    low = 0x03 | addressing | (0x08 if low_first else 0)
    display.send(sent_words([0x0A00 | low, *operands, len(data), *packed(data, low_first)]))

    across, down = {0x00: (0, 0), 0x40: (3, -4), 0x80: (-7, 2), 0xC0: base}[addressing]
    moved = (window.left + across, window.top + down, window.right + across, window.bottom + down)
    begin = (start.element + across, start.line + down) if has_start else reference.corner(moved, code)
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


@given(rasters, scans, st.binary(max_size=60), st.booleans(), st.booleans(), st.booleans())
def test_rasters_of_every_kind_equal_the_twin(
    raster: Raster, scan: Scan, data: bytes, low_first: bool, swapped: bool, additive: bool
) -> None:
    display = filled(raster)
    window, code, start, mask, clip = scan
    display.send(instructions.set_parameters(mask=mask, foreground=700, background=300, write_window=clip))
    display.send(instructions.set_parameters(window=window, scan_order=code, start=start))
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
    rasters, st.integers(0, 3), points, windows(), st.integers(0, 1), st.sampled_from([0, 1, 2, 3, 0xFFFF])
)
def test_a_filled_area_has_the_pixels_that_a_walk_reaches(
    raster: Raster, foreground: int, start: Point, clip: Window, mode: int, read_mask: int
) -> None:
    raster = raster % 4
    display = filled(raster)
    display.send(instructions.set_parameters(foreground=foreground, start=start, write_window=clip))
    display.send(instructions.set_parameters(read_mask=read_mask))
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


@given(rasters, scans, masks, st.booleans())
def test_a_copy_is_every_word_of_the_window_at_once(
    raster: Raster, scan: Scan, read_mask: int, by_data: bool
) -> None:
    display = filled(raster)
    window, code, corner, mask, clip = scan
    display.send(instructions.set_parameters(mask=mask, read_mask=read_mask, window=window, scan_order=code))
    display.send(instructions.set_parameters(write_window=clip, start=corner))
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
    window = (1, 1, 2, 2)
    display.send(instructions.set_parameters(background=9, mask=0xFFF3, window=window, write_window=window))
    display.send(sent_words([0x2B00]))
    assert (display.words == 1).all()
    display.send(sent_words([0x2B12, 0x0003, 0xFFFF, 6]))
    assert (display.words == 6).all()


def test_erase_with_the_swap_flag_uses_the_foreground() -> None:
    display = sent("0912 0043 00FF 0007 0064 0032 00C7 0063")
    assert box(display) == (100, 50, 199, 99)
    assert set(np.unique(display.words)) == {0, 7}


def test_erase_heeds_the_mask_and_accepts_a_data_field_of_no_bytes() -> None:
    display = sent("0902 0044 000F 0 0 3 0", "0802 0001 0003", "0902 0044 0000 1 0 1 0")
    assert display.words[0, :5].tolist() == [15, 12, 15, 15, 0]
    assert sent("0802 0004 0005", "0909 0000", "0700").words.min() == 5


def test_an_image_without_operands_continues_the_last_image() -> None:
    display = sent("0A03 0040 0002 0001 0004 0005 0008 0001 0002 0003 0004", "0A01 0004 0005 FFFF")
    assert display.words[1:3, 2:5].tolist() == [[1, 2, 3], [4, 5, 1023]]


@given(st.integers(1, 70), st.integers(1, 1200), st.integers(-40, 40))
def test_images_of_any_shape_arrive_whole(lines: int, elements: int, left: int) -> None:
    words = (np.arange(lines * elements) % 1023 + 1).reshape(lines, elements)
    display = Ramtek9300(Configuration(name="WIDE", elements=1300, lines=80, planes=10))
    display.send(instructions.write_image(words, left, 3))
    first = min(elements, max(0, -left))
    assert (display.words[3 : 3 + lines, max(0, left) : max(0, left + elements)] == words[:, first:]).all()
    assert np.count_nonzero(display.words) == lines * (elements - first)


def test_a_run_of_bytes_goes_on_with_the_next_pair() -> None:
    whole, cut = Ramtek9300(FAMILY), Ramtek9300(FAMILY)
    head = [0x0A07, 0x0040, 0x0020, 5, 5, 9, 99, 1]
    data = packed(bytes(range(1, 61)), False)
    whole.send(sent_words([*head, 60, *data]))
    cut.send(sent_words([*head, 22, *data[:11], 0x0A01, 38, *data[11:]]))
    assert (cut.words == whole.words).all()
    assert whole.words[5:15, 5:11].reshape(-1).tolist() == list(range(1, 61))


def test_tables_that_are_not_there_take_and_give_nothing() -> None:
    display = sent("0301 0000 0004 FFFF FFFF", "0401 0000 0004")
    assert not display.entries.any()
    assert display.receive(2).tolist() == [0, 0]


def test_a_table_is_read_as_it_was_loaded_and_one_that_does_not_exist_reads_as_zeros() -> None:
    display = Ramtek9300(SMALL)
    display.send(instructions.load_entries(5, [[1, 2, 3], [200, 201, 202]]))
    (opcode, *rest) = instructions.read_entries(10, 4).tolist()
    assert read(display, opcode, *rest) == [0x0203, 0x0001, 0xC9CA, 0x00C8]
    assert read(display, opcode | 1, *rest) == [0] * 4
