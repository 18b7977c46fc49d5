from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Words
from autocolor.widgets.items import WHITE, Area, Item, filled, lines, text
from autocolor.widgets.sheet import Page, Sheet, uncovered
from ramtek_emu import GMR_9300, PRINCETON_9300, Configuration, EntryFormat, PortError, Ramtek9300
from tests.autocolor.widgets.drawing import TINY, items

SHORT = Configuration(
    name="short", elements=48, lines=40, planes=10, entry_format=EntryFormat.WORD_12, extended=False
)
PICTURE = np.arange(40 * 48, dtype=np.uint16).reshape(40, 48) % 1000
OTHER = PICTURE.copy()
OTHER[12:20, 10:30] = 700
BASES: tuple[Words | int, ...] = (
    7,
    1008,
    PICTURE,
    OTHER,
    np.full((30, 50), 3, np.uint16),
    np.full((44, 20), 9, np.uint16),
)
TABLES = tuple(np.random.default_rng(seed).integers(0, 256, (1024, 3)).astype(np.uint8) for seed in range(2))


@st.composite
def sessions(draw: st.DrawFn) -> list[Page]:
    """Pages of a few items, overlapping, in any order, repeated, that come and go."""
    known = draw(st.lists(items(), min_size=1, max_size=6))
    pages = []
    for _ in range(draw(st.integers(1, 6))):
        chosen = draw(st.lists(st.sampled_from(known), max_size=8))
        table = draw(st.sampled_from(TABLES))
        if draw(st.booleans()):
            # Some entries differ, as those that a screen borrows.
            table = table.copy()
            first = draw(st.integers(0, 1000))
            table[first : first + draw(st.integers(1, 24))] = 17
        pages.append(Page(draw(st.sampled_from(BASES)), chosen, table))
    return pages


@pytest.mark.parametrize("configuration", [TINY, SHORT], ids=["tiny", "short"])
@given(data=st.data())
def test_after_any_pages_the_display_has_what_the_last_page_alone_gives(
    configuration: Configuration, data: st.DataObject
) -> None:
    display, replayed, entries_alone, fresh = (Ramtek9300(configuration) for _ in range(4))
    sheet, pages = Sheet(display), data.draw(sessions())
    for page in pages:
        sent = sheet.show(page)
        assert sent.base_words == 0 or not isinstance(page.base, int)
        replayed.send(sent.words)
        entries_alone.send(sent.words[: sent.entry_words])
    Sheet(fresh).show(pages[-1])
    for shown in (display, replayed):
        assert np.array_equal(shown.words, fresh.words)
        assert np.array_equal(shown.entries, fresh.entries)
    # No item and no base changes an entry.
    assert np.array_equal(entries_alone.entries, fresh.entries)


@given(pages=st.lists(st.sampled_from([PICTURE, OTHER]), min_size=1, max_size=4))
def test_the_words_for_pictures_alone_show_the_last_picture(pages: list[Words]) -> None:
    display, replayed = Ramtek9300(TINY), Ramtek9300(TINY)
    sheet = Sheet(display)
    for picture in pages:
        sent = sheet.show(Page(picture, (), TABLES[0]))
        assert len(sent.words) == sent.entry_words + sent.base_words
        replayed.send(sent.words)
    assert np.array_equal(replayed.words, display.words)


def page(*shown: Item, base: int = 0) -> Page:
    return Page(base, shown, TABLES[0])


ROWS = [filled(Area(500, 20 * n, 639, 20 * n + 15), 5) for n in range(10)]


def test_a_page_writes_what_differs_alone() -> None:
    display = Ramtek9300()
    sheet = Sheet(display)
    cross = lines([[(10, 10), (30, 30)], [(10, 30), (30, 10)]], WHITE, Area(10, 10, 30, 30))
    sheet.show(page(*ROWS, cross, base=4))
    received = display.words_received
    sheet.show(Page(4, [*ROWS, cross], TABLES[0].copy()))
    assert display.words_received == received
    entries = display.lookup_table.written
    lit = filled(ROWS[3].area, 9)
    for shown, written in (
        ((*ROWS[:3], lit, *ROWS[4:], cross), 140 * 16),
        # Of the row below a text, what the text covered alone is drawn again when it goes.
        ((*ROWS[:3], lit, *ROWS[4:], cross, text("go", 510, 62)), 14 * 9),
        ((*ROWS[:3], lit, *ROWS[4:], cross), 14 * 9),
        # What the cross covered is drawn again when it goes.
        ((*ROWS[:3], lit, *ROWS[4:]), 21 * 21),
    ):
        before = display.frame_buffer.written
        sheet.show(page(*shown, base=4))
        assert display.frame_buffer.written - before == written
    assert (display.words[:40, :40] == 4).all()
    assert (display.words[60:76, 500:640] == 9).all()
    assert display.lookup_table.written == entries
    before = display.frame_buffer.written
    sheet.show(page(*shown, base=4)._replace(entries=TABLES[1]))
    assert display.frame_buffer.written == before
    assert np.array_equal(display.entries, TABLES[1])


def test_a_page_that_could_not_be_sent_is_drawn_whole_the_next_time() -> None:
    class Broken(Ramtek9300):
        fails = False

        def send(self, words: Words) -> None:
            if self.fails:
                raise PortError("a display must listen")
            super().send(words)

    display = Broken()
    sheet = Sheet(display)
    sheet.show(page(*ROWS))
    display.fails = True
    with pytest.raises(PortError):
        sheet.show(page(base=3))
    display.fails = False
    sheet.show(page(base=3))
    assert (display.words == 3).all()


def test_where_a_picture_changed_that_area_is_sent_and_what_stands_beside_stays() -> None:
    picture = np.full((480, 640), 3, np.uint16)
    other = picture.copy()
    other[100:110, 20:30] = 4
    display = Ramtek9300()
    sheet = Sheet(display)
    menu, mark = filled(Area(504, 0, 639, 479), 5), filled(Area(25, 104, 28, 107), 6)
    far, row = filled(Area(50, 200, 53, 203), 7), filled(Area(520, 100, 630, 115), 8)
    sheet.show(Page(picture, [menu, row, mark, far], TABLES[0]))
    written = display.frame_buffer.written
    sheet.show(Page(other, [menu, row, mark, far], TABLES[0]))
    assert display.frame_buffer.written - written == 10 * 10 + 4 * 4
    assert (display.words[100:104, 20:30] == 4).all()
    assert (display.words[104:108, 25:29] == 6).all()
    written = display.frame_buffer.written
    sheet.show(Page(other.copy(), [menu, row, mark, far], TABLES[0]))
    assert display.frame_buffer.written == written


def test_below_the_menu_no_word_of_the_base_is_sent() -> None:
    menu, message = filled(Area(504, 0, 639, 463), 5), filled(Area(0, 464, 639, 479), 6)
    screen = Area(0, 0, 639, 479)
    assert uncovered(screen, [menu, message]) == (0, 0, 503, 463)
    assert uncovered(screen, [message, menu]) == (0, 0, 503, 463)
    assert uncovered(screen, [menu]) == screen
    strip, below = filled(Area(0, 0, 639, 15), 1), filled(Area(504, 16, 639, 463), 1)
    assert uncovered(screen, [below, strip, message]) == (0, 16, 503, 463)
    assert uncovered(screen, [menu._replace(is_solid=False), message]) == (0, 0, 639, 463)


@pytest.mark.parametrize("configuration", [GMR_9300, PRINCETON_9300])
def test_the_base_fills_all_that_the_display_shows(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    shown = configuration.shown_lines, configuration.shown_elements
    sheet = Sheet(display)
    sheet.show(page(base=4))
    assert (display.words == 4).all()
    picture = (np.arange(shown[0] * shown[1]) % 1000).astype(np.uint16).reshape(shown)
    sheet.show(Page(picture, [], TABLES[0]))
    assert np.array_equal(display.words, picture)
