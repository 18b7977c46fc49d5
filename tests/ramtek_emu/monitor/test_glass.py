"""The place of lines in a window, and the parts of the window that are sent to the screen."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.errors import escaped
from ramtek_emu.monitor.glass import Glass, enlarged, pixel_under, viewport
from ramtek_emu.monitor.pattern import pattern
from tests.virtual_screen import virtual_screen


@given(st.tuples(st.integers(1, 2000), st.integers(1, 1500)), st.booleans())
def test_runs_of_lines_that_touch_are_rectangles_that_touch(window: tuple[int, int], fit: bool) -> None:
    place = viewport((640, 480), window, fit)
    parts = [enlarged(run, place, (640, 480)) for run in itertools.pairwise([0, 1, 31, 32, 200, 479, 480])]
    assert parts[0].top == place.top
    assert parts[-1].bottom == place.top + place.height
    assert all(above.bottom == below.top for above, below in itertools.pairwise(parts))
    assert {(part.left, part.width) for part in parts} == {(place.left, place.width)}


@pytest.fixture
def glass(monkeypatch: pytest.MonkeyPatch) -> Iterator[Glass]:
    """An open window on a virtual screen."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    opened = Glass((640, 480))
    opened.open(full_screen=False)
    yield opened
    opened.close()


@pytest.mark.parametrize(
    ("desktop", "fit", "fills", "size"),
    [
        ((1366, 768), None, True, (921, 691)),
        ((1366, 768), False, False, (640, 480)),
        ((1400, 1100), None, False, (1280, 960)),
        ((1400, 1100), True, True, (1320, 990)),
    ],
)
def test_without_room_for_twice_its_size_the_field_may_fill_the_window(
    monkeypatch: pytest.MonkeyPatch,
    desktop: tuple[int, int],
    fit: bool | None,
    fills: bool,
    size: tuple[int, int],
) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [desktop])
    glass = Glass((640, 480), fit)
    glass.open(full_screen=False)
    assert (glass.fit, pygame.display.get_window_size()) == (fills, size)
    glass.close()


@pytest.mark.parametrize("title", ["\udcffcar", "car\0", "a\nb", "x" * 9000, "ünï→💥"])
def test_a_title_of_any_text_is_shown(glass: Glass, title: str) -> None:
    glass.set_title(title)
    assert pygame.display.get_caption()[0] == escaped(title)


def test_a_copied_text_can_be_pasted(glass: Glass) -> None:
    for text in ("#b01020", "grün"):
        assert glass.copy(text)
        assert glass.paste() == text
    # A name of a file that is no text is not copied.
    assert not glass.copy("car\udcff")
    glass.close()
    assert not glass.copy("#b01020")
    assert glass.paste() == ""


@pytest.mark.parametrize("scale", [1, 2])
def test_after_a_cursor_moved_only_its_old_and_new_lines_go_to_the_screen(
    glass: Glass, monkeypatch: pytest.MonkeyPatch, scale: int
) -> None:
    pygame.display.set_mode((640 * scale, 480 * scale), pygame.RESIZABLE)
    display, sent = Ramtek9300(), list[Any]()
    display.send(instructions.write_cursor(0, 100, 100))
    monkeypatch.setattr(pygame.display, "flip", lambda: sent.append("all"))
    monkeypatch.setattr(pygame.display, "update", lambda parts: sent.extend(map(tuple, parts)))

    def show() -> list[Any]:
        sent.clear()
        glass.show(display.scan_out, None, hides_mouse=True)
        return sent

    assert show() == ["all"]
    assert show() == []
    display.joystick.move_to(300, 200)
    assert show() == [
        (0, 85 * scale, 640 * scale, 32 * scale),
        (0, 185 * scale, 640 * scale, 32 * scale),
    ]
    display.joystick.move_to(300, 202)
    assert show() == [(0, 185 * scale, 640 * scale, 34 * scale)]
    display.send(instructions.erase((0, 0, 9, 9), 5))
    assert show() == [(0, 0, 640 * scale, 480 * scale)]


@pytest.mark.parametrize("scale", [1, 2])
def test_the_parts_that_are_sent_are_seen_on_the_screen(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scale: int
) -> None:
    size = 660 * scale, 500 * scale
    with virtual_screen(tmp_path, f"{size[0]}x{size[1]}") as screen:
        monkeypatch.setenv("DISPLAY", screen.name)
        monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
        glass, display = Glass((640, 480)), Ramtek9300()
        display.send(pattern())
        display.send(instructions.write_cursor(0, 100, 100))
        glass.open(full_screen=True)
        left, top, width, height = viewport((640, 480), size)
        try:
            for number, place in enumerate(((100, 100), (300, 200), (310, 210), (639, 0))):
                display.joystick.move_to(*place)
                if number == 3:
                    display.send(instructions.load_entries(9, [[200, 100, 50]]))
                glass.show(display.scan_out, None, hides_mouse=True)
                field = display.field().repeat(scale, axis=0).repeat(scale, axis=1)
                until = time.monotonic() + 60
                while time.monotonic() < until:
                    seen = screen.pixels()[top : top + height, left : left + width]
                    if np.array_equal(seen, field):
                        break
                assert np.array_equal(seen, field), place
        finally:
            glass.close()


@given(st.integers(1, 700), st.integers(1, 500), st.integers(1, 4000), st.integers(1, 3000))
def test_the_field_is_placed_at_the_largest_whole_multiple(w: int, h: int, width: int, height: int) -> None:
    left, top, across, down = viewport((w, h), (width, height))
    if width < w or height < h:
        # A window that is smaller than the field shows it whole.
        assert (left, top, across, down) == viewport((w, h), (width, height), fit=True)
        assert (across, down) == (width, down) or (across, down) == (across, height)
        return
    multiple = across // w
    assert (across, down) == (multiple * w, multiple * h)
    assert (multiple + 1) * w > width or (multiple + 1) * h > height
    assert across <= width
    assert down <= height
    assert abs(2 * left + across - width) <= 1
    assert abs(2 * top + down - height) <= 1


@given(st.integers(1, 70), st.integers(1, 50), st.integers(70, 400), st.integers(50, 300), st.booleans())
def test_every_place_of_the_window_is_over_the_nearest_pixel(
    w: int, h: int, width: int, height: int, fit: bool
) -> None:
    left, top, across, down = viewport((w, h), (width, height), fit)
    for element, line in itertools.product({0, w // 2, w - 1}, {0, h // 2, h - 1}):
        # The first place that shows the pixel, and the last one.
        first = left - (-element * across // w), top - (-line * down // h)
        last = left - (-(element + 1) * across // w) - 1, top - (-(line + 1) * down // h) - 1
        for place in (first, last):
            assert pixel_under(place, (w, h), (width, height), fit) == (element, line)
    for x, y in itertools.product((-9999, 9999), repeat=2):
        corner = 0 if x < 0 else w - 1, 0 if y < 0 else h - 1
        assert pixel_under((x, y), (w, h), (width, height), fit) == corner


def test_the_mouse_is_hidden_where_a_cursor_stands_for_it(glass: Glass) -> None:
    for hides in (True, False):
        glass.show(Ramtek9300().scan_out, None, hides_mouse=hides)
        assert pygame.mouse.get_visible() is not hides


def test_a_window_smaller_than_the_field_shows_it_whole(glass: Glass) -> None:
    assert viewport((640, 480), (700, 300)) == (150, 0, 400, 300)
    assert viewport((640, 480), (1000, 1000), fit=True) == (0, 125, 1000, 750)
    display = Ramtek9300()
    display.send(instructions.load_entries(9, [[255, 255, 255]]))
    for corner in ((0, 0, 9, 9), (630, 470, 639, 479)):
        display.send(instructions.erase(corner, 9))
    pygame.display.set_mode((700, 300), pygame.RESIZABLE)
    glass.show(display.scan_out, None, hides_mouse=False)
    pixels = pygame.surfarray.array3d(pygame.display.get_surface())[:, :, 0]
    assert (pixels[150:154, :4] > 200).all()
    assert (pixels[546:550, 296:] > 200).all()
    assert (pixels[200:500, 50:250] == 0).all()
