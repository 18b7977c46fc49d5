"""What a layout has is tried through the board, in test_board.py."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.board.layout import REACH, Layout
from autocolor.screens.screen import Handle, Screen
from autocolor.widgets.bars import Bar
from autocolor.widgets.menu import MENU, WIDE_BAR, laid_out
from autocolor.widgets.widget import Button
from tests.autocolor.screens.boards import desk_viewer

places = st.tuples(st.integers(90, 110), st.integers(90, 110))


class Handles(Screen):
    """A screen with handles alone."""

    def __init__(self, places: list[tuple[int, int]]) -> None:
        self.places = places

    def handles(self) -> list[Handle]:
        return [Handle(number, *place, "") for number, place in enumerate(self.places)]


@given(st.lists(places, max_size=5), places)
def test_the_nearest_handle_within_reach_is_found_the_last_of_those_as_near(
    handles: list[tuple[int, int]], place: tuple[int, int]
) -> None:
    distances = [max(abs(x - place[0]), abs(y - place[1])) for x, y in handles]
    found = Layout(Handles(handles), [], "", []).handle_at(*place)
    if not distances or min(distances) > REACH:
        assert found is None
    else:
        assert found is not None
        last = max(number for number, each in enumerate(distances) if each == min(distances))
        assert found.key == last


def test_the_wide_bar_covers_what_is_below_it(tmp_path: Path) -> None:
    screen = desk_viewer(tmp_path).board.screen
    rows = laid_out([Bar("ambient"), Button("go")])
    closed, opened = (Layout(screen, rows, key, [MENU]) for key in ("", "ambient"))
    place = (100, WIDE_BAR.top + 3)
    assert not closed.is_covered(*place)
    assert opened.is_covered(*place)
    assert opened.widget_at(*place) is opened.wide
    assert Layout(screen, rows, "gone", [MENU]).wide is None


def test_a_widget_is_found_again_by_its_key_and_stays_where_it_was_grabbed() -> None:
    before = laid_out([Bar("x", value=1.0), Button("x")])
    after = laid_out([Button("new"), Bar("x", value=2.0)])
    now = Layout(Handles([]), after, "", []).now(before[0])
    assert isinstance(now, Bar)
    assert (now.value, now.area) == (2.0, before[0].area)
    assert Layout(Handles([]), after, "", []).now(before[1]) is None
