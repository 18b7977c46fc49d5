from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Configuration, Ramtek9300, instructions
from ramtek_emu.drawing.curves import MOST_PIXELS, conic_pixels, traced
from ramtek_emu.memory.scan_orders import Point, Window
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, masks, sent_words, windows

far = st.integers(-40, 60)


def circle_places(center: tuple[int, int], radius: int) -> set[tuple[int, int]]:
    """The pixels nearest to the circle: by columns where the circle is flat, by rows where it is steep."""
    places = set()
    for across in range(-radius, radius + 1):
        away = np.abs(np.sqrt(radius**2 - across**2) - np.arange(radius + 1))
        down = int(away.argmin())
        if abs(across) <= down:
            for x, y in ((across, down), (across, -down), (down, across), (-down, across)):
                places.add((center[0] + x, center[1] + y))
    return places


def test_every_circle_is_the_nearest_pixels_around_its_center() -> None:
    for radius in range(32):
        display = Ramtek9300(Configuration(name="ROUND", elements=64, lines=64, planes=1))
        display.send(instructions.write_circles([(32, 31, radius)], 1))
        places = {(element, line) for line, element in np.argwhere(display.words).tolist()}
        assert places == circle_places((32, 31), radius)


@given(
    st.lists(st.tuples(far, far, st.integers(0, 90)), min_size=1, max_size=12),
    st.sampled_from([0x00, 0x40, 0xC0]),
    masks,
    windows(),
)
def test_circles_are_the_nearest_pixels(
    circles: list[tuple[int, int, int]], addressing: int, mask: int, clip: Window
) -> None:
    display = Ramtek9300(SMALL)
    display.send(sent_words([0x0806, 0x800B, 0x0002, mask, 999, 4, -3, 5, 6, *clip]))
    display.send(
        sent_words([0x6D01 | addressing, 6 * len(circles), *(n for circle in circles for n in circle)])
    )
    twin = [[0] * 13 for _ in range(9)]
    base = {0x00: (0, 0), 0x40: (4, -3), 0xC0: (5, 6)}[addressing]
    for across, down, radius in circles:
        center = (base[0] + across, base[1] + down)
        base = center if addressing == 0xC0 else base
        for place in circle_places(center, radius):
            reference.write_pixel(twin, place, 999, mask & 1023, clip)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == center


def trace(conic: tuple[int, ...], stop: Point | None = None) -> list[tuple[int, int]]:
    elements, lines = conic_pixels((*conic, 0) if len(conic) == 5 else conic, Point(0, 0), stop)
    return list(zip(elements.tolist(), lines.tolist(), strict=True))


def is_connected(pixels: list[tuple[int, int]]) -> bool:
    steps = np.diff(np.array(pixels), axis=0)
    return bool((np.abs(steps).max(axis=1) == 1).all())


@given(st.integers(2, 120), st.integers(0, 3))
def test_a_closed_conic_is_a_circle_once_around(radius: int, quarter: int) -> None:
    across, down = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter]
    pixels = trace((1, 1, 0, -2 * radius * across, -2 * radius * down))
    center = (radius * across, radius * down)
    assert set(pixels) <= {
        (x + i, y + j) for x, y in circle_places(center, radius) for i in (-1, 0, 1) for j in (-1, 0, 1)
    }
    away = [abs(np.hypot(x - center[0], y - center[1]) - radius) for x, y in pixels]
    assert max(away) <= 0.75
    assert is_connected([*pixels, pixels[0]])
    assert len(set(pixels)) == len(pixels)
    # Clockwise on the screen, whose lines count down.
    turned = sum(
        (x - center[0]) * (n - center[1]) - (y - center[1]) * (m - center[0])
        for (x, y), (m, n) in zip(pixels, [*pixels[1:], pixels[0]], strict=True)
    )
    assert turned > 0


def test_a_conic_stops_after_its_number_of_pixels() -> None:
    assert len(trace((1, 1, 0, -200, 0, 17))) == 17
    assert trace((0, 0, 0, 0, 0)) == [(0, 0)]
    # A straight line has no end of its own.
    assert len(trace((0, 0, 0, 0, 1))) == MOST_PIXELS
    assert trace((0, 0, 0, 1, 1, 4)) == [(0, 0), (-1, 1), (-2, 2), (-3, 3)]


whole = (
    st.integers(-3, 3) | st.integers(-600, 600) | st.sampled_from([0x7FFF, -0x8000, 0x7FFFFFFF, -0x80000000])
)


@given(
    st.tuples(whole, whole, whole, whole, whole),
    st.integers(0, 60),
    st.tuples(far, far),
    st.none() | st.tuples(far, far),
)
def test_a_conic_of_any_coefficients_equals_the_twin(
    coefficients: tuple[int, ...], most: int, start: tuple[int, int], stop: tuple[int, int] | None
) -> None:
    elements, lines = conic_pixels(
        (*coefficients, most), Point(*start), None if stop is None else Point(*stop)
    )
    expected = reference.conic_places(coefficients, most or MOST_PIXELS, start, stop)
    assert list(zip(elements.tolist(), lines.tolist(), strict=True)) == expected


def test_a_conic_ends_where_a_coordinate_leaves_its_register() -> None:
    elements, lines = conic_pixels((0, 0, 0, 0, 1, 0), Point(-0x7FFE, 9), None)
    assert (elements.tolist(), lines.tolist()) == ([-0x7FFE, -0x7FFF, -0x8000], [9, 9, 9])


def test_a_conic_that_is_asked_for_again_is_not_traced_again() -> None:
    display = Ramtek9300()
    traced.cache_clear()
    display.send(sent_words([0x0802, 0x1000, 0, 1, 0, 1, 0, 0, 0, 80, 0, 0, 0, 0]))
    display.send(sent_words([0x0802, 0x8002, 5, 300, 200, 0x0F00, 0x0802, 0x8002, 5, 500, 300, 0x0F00]))
    assert traced.cache_info().misses == 1
    assert (display.words[160:241, 200:301] == display.words[260:341, 400:501]).all()
    assert np.count_nonzero(display.words) > 400


def test_only_circles_that_reach_into_the_memory_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    display = Ramtek9300()
    points: list[int] = []

    def write_points(elements: NDArray[np.int64], *rest: object) -> None:
        points.append(len(elements))

    monkeypatch.setattr(display.frame_buffer, "write_points", write_points)
    far_away, around_everything = [2000, 100, 500], [320, 240, 30000]
    display.send(sent_words([0x6D01, 65532, *(far_away + around_everything) * 5461]))
    assert sum(points) == 0
