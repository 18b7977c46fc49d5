from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.rounding import half_up
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, WHITE, YELLOW
from autocolor.widgets.level_bars import (
    DOWN,
    LANE,
    LEFT,
    RIGHT,
    UP,
    LevelBar,
    PercentBar,
    levels_along,
    pointer,
)
from autocolor.widgets.widget import Place
from ramtek_emu import Ramtek9300

LYING = Area(8, 100, 495, 139)
STANDING = Area(500, 24, 531, 439)


def bar_of(levels: int, level: int = 0, upright: bool = False, found: list[int] | None = None) -> LevelBar:
    found = [] if found is None else found
    return LevelBar(
        "bar",
        area=STANDING if upright else LYING,
        words=np.arange(200, 200 + levels, dtype=np.uint16),
        level=level,
        put=found.append,
        number="0.50" if upright else "",
        upright=upright,
    )


def drawn(bar: LevelBar | PercentBar, lit: bool = False) -> Ramtek9300:
    display = Ramtek9300()
    for item in bar.items(lit):
        display.send(np.frombuffer(item.stream, np.uint16))
    return display


@given(length=st.integers(2, 640), levels=st.integers(2, 1007))
def test_levels_rise_evenly_from_end_to_end(length: int, levels: int) -> None:
    found = levels_along(length, levels)
    assert found.tolist() == [half_up(place * (levels - 1) / (length - 1)) for place in range(length)]
    assert (found[0], found[-1]) == (0, levels - 1)


@pytest.mark.parametrize("levels", [2, 40, 488, 800])
def test_a_lying_bar_shows_the_levels_from_the_left(levels: int) -> None:
    bar = bar_of(levels)
    strip = bar.strip
    assert strip == Area(8, 100 + LANE, 495, 139 - LANE)
    words = drawn(bar).words[strip.top : strip.bottom + 1, strip.left : strip.right + 1]
    assert np.array_equal(words, np.broadcast_to(200 + levels_along(488, levels), words.shape))


@pytest.mark.parametrize("levels", [2, 40, 416, 800])
def test_an_upright_bar_shows_the_levels_from_below(levels: int) -> None:
    bar = bar_of(levels, upright=True)
    strip = bar.strip
    assert strip == Area(500 + LANE, 24, 531, 439)
    words = drawn(bar).words[strip.top : strip.bottom + 1, strip.left : strip.right + 1]
    assert np.array_equal(words, np.broadcast_to(200 + levels_along(416, levels)[::-1, None], words.shape))


@pytest.mark.parametrize("upright", [False, True])
def test_a_pick_selects_the_level_that_is_shown_there_and_beyond_the_ends_the_last_one(upright: bool) -> None:
    found: list[int] = []
    bar = bar_of(60, upright=upright, found=found)
    words = drawn(bar).words
    strip = bar.strip
    for share in (0, 0.3, 0.77, 1):
        element = strip.left + int(share * (strip.width - 1))
        line = strip.top + int(share * (strip.height - 1))
        bar.pick(Place(element, line))
        assert found[-1] == words[line, element] - 200
    bar.drag(Place(0, 0), Place(0, 0), Place(0, 1000))
    assert found[-1] == 0
    bar.drag(Place(0, 0), Place(0, 0), Place(1000, -5))
    assert found[-1] == 59


@pytest.mark.parametrize(("level", "steps", "to"), [(5, 1, 6), (5, -1, 4), (0, -1, 0), (59, 3, 59)])
def test_a_step_is_a_level(level: int, steps: float, to: int) -> None:
    found: list[int] = []
    bar_of(60, level, found=found).nudge(steps)
    assert found == [to]


@pytest.mark.parametrize("upright", [False, True])
@pytest.mark.parametrize("level", [0, 20, 59])
@pytest.mark.parametrize("lit", [False, True])
def test_the_handle_points_at_its_level_and_leaves_the_levels_uncovered(
    upright: bool, level: int, lit: bool
) -> None:
    bar = bar_of(60, level, upright)
    words = drawn(bar, lit).words
    strip, ink = bar.strip, YELLOW if lit else WHITE
    if upright:
        (line,) = np.flatnonzero(words[:, strip.left - 2] == ink)
        assert words[line, strip.left] == 200 + level
    else:
        for lane in (strip.top - 2, strip.bottom + 2):
            (element,) = np.flatnonzero(words[lane] == ink)
            assert words[strip.top, element] == 200 + level
    assert not np.isin(
        words[strip.top : strip.bottom + 1, strip.left : strip.right + 1], [WHITE, YELLOW]
    ).any()


@pytest.mark.parametrize("towards", [RIGHT, DOWN, LEFT, UP])
def test_the_tip_of_a_pointer_is_at_its_place(towards: int) -> None:
    item = pointer(100, 50, towards, WHITE)
    display = Ramtek9300()
    display.send(np.frombuffer(item.stream, np.uint16))
    lines, elements = np.nonzero(display.words == WHITE)
    # It is as wide as two steps from its base to the tip, and on the other side of it.
    assert len(lines) == 25
    across, down = ((-1, 0), (0, -1), (1, 0), (0, 1))[towards]
    assert display.words[50, 100] == WHITE
    assert elements.mean() == pytest.approx(100 + across * 2.8)
    assert lines.mean() == pytest.approx(50 + down * 2.8)


def test_a_percentage_is_a_share_of_the_height() -> None:
    found: list[float] = []
    bar = PercentBar("percent", area=Area(600, 0, 635, 200), value=25.0, put=found.append)
    for line in (200, 100, 0, -9, 400):
        bar.pick(Place(610, line))
    assert found == [0, 50, 100, 100, 0]
    found.clear()
    bar.drag(Place(0, 0), Place(0, 0), Place(0, 50))
    bar.nudge(1)
    bar.nudge(-200)
    assert found == [75, 26, 0]
    words = drawn(bar).words
    assert np.flatnonzero(words[:, 602] == WHITE).tolist() == [150]


@pytest.mark.parametrize("upright", [False, True])
def test_a_bar_is_framed_so_that_its_ends_are_seen_on_a_dark_picture(upright: bool) -> None:
    bar = bar_of(40, level=20, upright=upright)
    words = drawn(bar).words
    left, top, right, bottom = bar.strip
    assert (words[[top - 1, bottom + 1], left - 1] == GRAY).all()
    assert (words[[top - 1, bottom + 1], right + 1] == GRAY).all()
    assert words[top - 1, left + 1] == words[bottom + 1, left + 1] == GRAY
