from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import read_scene
from autocolor.screens.all_screens import SCREENS
from autocolor.screens.tutorial.lessons import LESSONS
from autocolor.screens.tutorial.tutorial import END, Tutorial
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import CHARACTER
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand

ROOT = Path(__file__).parents[4]


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return Hand(Viewer(read_scene(ROOT / "scenes/coupe"), Ramtek9300(), tmp_path))


@pytest.fixture
def tutorial(hand: Hand) -> Tutorial:
    found = Tutorial(hand.viewer.session)
    hand.viewer.board.over = found.widgets
    hand.viewer.tell("")
    return found


def name_of(tutorial: Tutorial) -> str:
    return "" if tutorial.lesson is None else tutorial.lesson.name


def test_the_whole_tutorial_is_done_by_the_unit_alone(hand: Hand, tutorial: Tutorial, tmp_path: Path) -> None:
    assert name_of(tutorial) == "move a light"
    hand.open_menu()
    hand.pick("light & view")
    element, line = hand.handle("key: x")
    hand.drag((element, line), (element + 20, line - 10))
    assert name_of(tutorial) == "flaps"
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("lights")
    hand.pick("flaps z", 0.95)
    assert name_of(tutorial) == "flaps"
    hand.pick("z minimum", 0.95)
    assert name_of(tutorial) == "a cone"
    hand.pick("cone angle", 0.95)
    assert name_of(tutorial) == "mix a color"
    # How colors are mixed and blended is the affair of those screens; what counts is the scene.
    hand.viewer.session.paint(object_color="#204080")
    hand.viewer.tell("")
    assert name_of(tutorial) == "blend"
    hand.viewer.session.paint(blend=0.2)
    hand.viewer.tell("")
    assert name_of(tutorial) == "save"
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("file")
    hand.pick("save")
    assert name_of(tutorial) == ""
    assert (tmp_path / "coupe.npz").exists()
    hand.pick("end")
    assert tutorial.has_ended
    assert tutorial.widgets() == ()


def test_a_lesson_is_skipped_and_undo_does_not_go_back_to_one(hand: Hand, tutorial: Tutorial) -> None:
    hand.pick("skip")
    hand.pick("skip")
    assert name_of(tutorial) == "a cone"
    hand.open_menu()
    hand.pick("lights")
    hand.pick("cone angle", 0.95)
    hand.pick(" ", 0.1)
    assert name_of(tutorial) == "mix a color"
    for _ in range(3):
        hand.pick("skip")
    assert tutorial.lesson is None
    assert "skip" not in [each.label for each in hand.viewer.board.widgets()]


def test_the_panel_stands_on_every_screen_and_makes_room(hand: Hand, tutorial: Tutorial) -> None:
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    for screen in SCREENS:
        hand.viewer.session.turn_to(screen.name)
        hand.viewer.tell("")
        places = []
        for _ in range(2):
            panel = next(each.area for each in hand.viewer.board.widgets() if each.label == "tutorial")
            places.append(panel)
            assert hand.viewer.board.layout().is_covered(panel.left + 8, panel.top + 20)
            hand.pick("up" if panel.top else "down")
        assert not places[0].overlaps(places[1])
        assert all(WORK.covers(place) for place in places)


def test_the_panel_is_folded_to_its_first_line_until_the_next_lesson(hand: Hand, tutorial: Tutorial) -> None:
    def height() -> int:
        return next(each.area.height for each in hand.viewer.board.widgets() if each.label == "tutorial")

    whole = height()
    hand.pick("tutorial")
    assert height() < whole / 2
    hand.pick("skip")
    assert height() == whole


def test_what_is_picked_on_the_panel_does_not_reach_the_picture(hand: Hand, tutorial: Tutorial) -> None:
    before = hand.viewer.studio.scene
    panel = next(each.area for each in hand.viewer.board.widgets() if each.label == "tutorial")
    line = panel.bottom - 5
    hand.drag((100, line), (200, line - 8), (300, line - 100))
    hand.click(100, line)
    assert hand.viewer.studio.scene is before


def test_when_the_panel_goes_the_picture_is_there(hand: Hand, tutorial: Tutorial) -> None:
    hand.pick("end")
    hand.move(300, 240)
    hand.viewer.clear()
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    assert (display.words == hand.viewer.studio.words).all()


def test_the_end_fits_into_the_panel() -> None:
    assert max(map(len, END)) <= (WORK.width - 2 * MARGIN) // CHARACTER
    assert len({lesson.name for lesson in LESSONS}) == len(LESSONS)
