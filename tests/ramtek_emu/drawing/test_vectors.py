from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.drawing.vectors import numbered, points, slices
from ramtek_emu.memory.scan_orders import Window
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, masks, sent_words, windows

far = st.integers(-40, 60)


addressings = st.sampled_from([0x00, 0x40, 0x80, 0xC0])
textures = st.tuples(st.integers(0, 0xFFFF) | st.just(0xFFFF), st.integers(0, 15))


@given(
    st.lists(st.tuples(far, far), min_size=1, max_size=12),
    st.tuples(far, far),
    addressings,
    textures,
    st.tuples(*[st.booleans()] * 3),
    masks,
    windows(),
)
def test_vectors_of_every_kind_equal_the_twin(
    vertices: list[tuple[int, int]],
    start: tuple[int, int],
    addressing: int,
    texture: tuple[int, int],
    kinds: tuple[bool, bool, bool],
    mask: int,
    clip: Window,
) -> None:
    (pattern, repeat), (linked, swapped, additive) = texture, kinds
    bases = {0x00: (0, 0), 0x40: (3, -2), 0x80: (-5, 4), 0xC0: start}
    if not linked and len(vertices) % 2:
        vertices = [*vertices, (1, 2)]
    display = Ramtek9300(SMALL)
    display.send(instructions.erase(word=170))
    display.send(instructions.set_parameters(index_1=bases[0x40], index_2=bases[0x80], start=start))
    display.send(instructions.set_parameters(mask=mask, foreground=600, background=421))
    display.send(instructions.set_parameters(write_window=clip, texture=(pattern, 0x1000 | repeat)))
    opcode = 0x0E if linked else 0x35
    flags = 0x01 | addressing | (0x10 if swapped else 0) | (0x20 if additive else 0)
    numbers = [number for vertex in vertices for number in vertex]
    display.send(sent_words([opcode << 8 | flags, 2 * len(numbers), *numbers]))

    twin = [[170] * 13 for _ in range(9)]
    places, last = [], bases[addressing]
    for across, down in vertices:
        here = (last[0] + across, last[1] + down)
        places.append(here)
        last = here if addressing == 0xC0 else last
    lines = (
        list(itertools.pairwise([start, *places]))
        if linked
        else list(zip(places[::2], places[1::2], strict=True))
    )
    one, zero = (421, 600) if swapped else (600, 421)
    before = 0
    for begin, end in lines:
        row = reference.line_places(begin, end)
        for number, place in enumerate(row):
            bit = pattern >> (15 - (before + number) // (repeat + 1) % 16) & 1
            if bit or not additive:
                reference.write_pixel(twin, place, one if bit else zero, mask & 1023, clip)
        before += len(row) - 1 if linked else 0
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == places[-1]


@given(st.lists(st.tuples(far, far, st.integers(0, 0xFFFF)), min_size=1, max_size=30), masks)
def test_random_pixels_and_points_land_where_they_say(pixels: list[tuple[int, int, int]], mask: int) -> None:
    display = Ramtek9300(SMALL)
    display.send(instructions.set_parameters(mask=mask, foreground=77))
    display.send(sent_words([0x3901, 6 * len(pixels), *itertools.chain(*pixels)]))
    twin = [[0] * 13 for _ in range(9)]
    everywhere = (-99, -99, 99, 99)
    for element, line, word in pixels:
        reference.write_pixel(twin, (element, line), word, mask & 1023, everywhere)
    assert display.words.tolist() == twin
    places = [number for pixel in pixels for number in pixel[:2]]
    display.send(sent_words([0x3801, 4 * len(pixels), *places]))
    for element, line, _ in pixels:
        reference.write_pixel(twin, (element, line), 77, mask & 1023, everywhere)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == pixels[-1][:2]


@pytest.mark.parametrize("count", [1, 4, 5, 3000])
def test_few_and_many_lines_are_drawn_alike(count: int) -> None:
    ends = np.random.default_rng(count).integers(-300, 900, (count + 1, 2))
    together, apart = Ramtek9300(), Ramtek9300()
    together.send(instructions.write_vectors(ends, 9))
    for start, end in itertools.pairwise(ends.tolist()):
        apart.send(instructions.write_vectors([end], 9, start=start))
    assert (together.words == apart.words).all()


wide = st.tuples(st.integers(-900, 900), st.integers(-900, 900))


@given(st.lists(st.tuples(wide, wide), min_size=1, max_size=5), windows())
def test_only_the_points_inside_are_computed(
    lines: list[tuple[tuple[int, int], tuple[int, int]]], window: Window
) -> None:
    starts, ends = (np.array([line[end] for line in lines]) for end in (0, 1))
    drawn = [
        point
        for part in points(starts, ends, window)
        for point in zip(*(numbers.tolist() for numbers in part), strict=True)
    ]
    expected = [
        (*place, number, row)
        for row, (start, end) in enumerate(lines)
        for number, place in enumerate(reference.line_places(start, end))
        if reference.inside(place, window)
    ]
    assert drawn == expected


def test_a_vector_across_the_whole_range_takes_no_more_points_than_the_memory_shows() -> None:
    window = Window(0, 0, 639, 479)
    far = np.array([[-0x8000, -0x8000], [-0x8000, 0x7FFF], [0x7FFF, 100], [-0x8000, -3]])
    near = np.array([[0x7FFF, 0x7FFF], [0x7FFF, -0x8000], [-0x8000, 100], [0x7FFF, -3]])
    (part,) = points(far, near, window)
    assert np.bincount(part[3], minlength=4).tolist() == [480, 0, 640, 0]


@given(st.lists(st.integers(0, 9), max_size=12))
def test_every_row_is_numbered_from_0_in_order(counts: list[int]) -> None:
    rows, numbers = [], []
    end = 0
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ramtek_emu.drawing.vectors.MOST_POINTS", 7)
        for part in slices(np.array(counts, np.int64)):
            assert part.start == end
            assert part.stop - part.start == 1 or sum(counts[part]) <= 7
            assert part.stop == len(counts) or sum(counts[part]) + counts[part.stop] > 7
            end = part.stop
            which, numbers_of_part = numbered(np.array(counts[part], np.int64))
            rows += (which + part.start).tolist()
            numbers += numbers_of_part.tolist()
    assert end == len(counts)
    assert rows == [row for row, count in enumerate(counts) for _ in range(count)]
    assert numbers == [number for count in counts for number in range(count)]
