"""Images, rasters, areas and copies, against twins that go word by word."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.memory.scan_orders import Point, Window
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import (
    SMALL,
    masks,
    points,
    quick,
    rasters,
    scan_codes,
    sent_words,
    thorough,
    windows,
)

EVERYWHERE = (-(10**6), -(10**6), 10**6, 10**6)
addressings = st.sampled_from([0x00, 0x40, 0x80, 0xC0])


def filled(raster: NDArray[np.uint16]) -> Ramtek9300:
    display = Ramtek9300(SMALL)
    display.send(instructions.write_image(raster))
    return display


def packed(data: bytes, low_first: bool) -> list[int]:
    padded = data + bytes(len(data) % 2)
    words: list[int] = np.frombuffer(padded, "<u2" if low_first else ">u2").tolist()
    return words


@thorough
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
def test_images_of_every_kind_are_those_of_the_twin(
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
    after = reference.write_run(twin, moved, code, begin, words, mask & 1023, clip)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == after

    # Read it back from where the run began.
    display.send(sent_words([0x0B03 | low, 0x8000, begin[0], begin[1], len(data)]))
    if addressing:
        return
    read, _ = reference.read_run(twin, moved, code, begin, len(words))
    read = [word & 0x2F5 for word in read]
    if bytes_for_pixels:
        read = packed(bytes(word & 0xFF for word in read), low_first)
    assert display.receive(display.processor.waiting).tolist() == read


@thorough
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
def test_rasters_of_every_kind_are_those_of_the_twin(
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


@thorough
@given(
    rasters(), st.integers(0, 3), points, windows(), st.integers(0, 1), st.sampled_from([0, 1, 2, 3, 0xFFFF])
)
def test_a_filled_area_is_what_a_walk_reaches(
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


@thorough
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


@quick
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
    # Nothing open is left beside what was filled.
    new = filled_words & (words == 0)
    left = ~filled_words
    assert not (new[1:] & left[:-1]).any()
    assert not (new[:-1] & left[1:]).any()
    assert not (new[:, 1:] & left[:, :-1]).any()
    assert not (new[:, :-1] & left[:, 1:]).any()
