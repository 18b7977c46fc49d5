from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Scene
from autocolor.mapping.colors import blend_level
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import LevelBar
from autocolor.widgets.items import Area
from autocolor.widgets.menu import MENU
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.painting_hand import PaintingHand, boxes_scene


def blending(scene: Scene, folder: Path) -> PaintingHand:
    """A hand at the light blending screen of a scene, away from the menu."""
    hand = PaintingHand(Viewer(scene, Ramtek9300(), folder))
    hand.turn_to("light blending")
    assert hand.viewer.page == "blending"
    hand.move(20, 20)
    hand.viewer.tell("")
    return hand


@pytest.fixture
def hand(tmp_path: Path) -> PaintingHand:
    return blending(boxes_scene(), tmp_path)


def bar_of(hand: PaintingHand) -> LevelBar:
    bar = hand.widget("blend level")
    assert isinstance(bar, LevelBar)
    return bar


def bar_is_right(hand: PaintingHand) -> bool:
    """Whether the bar has the words of the chosen surface's levels, the highest on top."""
    levels = hand.viewer.studio.level_ranges[hand.viewer.session.surface_name]
    along = hand.words(bar_of(hand).strip)[::-1, 0].astype(int)
    return (along[0], along[-1]) == (levels.first, levels.last) and bool((np.diff(along) >= 0).all())


def test_a_pick_on_the_bar_blends_from_its_level_on_at_once(hand: PaintingHand) -> None:
    levels = hand.viewer.studio.level_ranges["box 0"].levels
    strip = bar_of(hand).strip
    for line in (strip.bottom, 400, 123, strip.top):
        hand.click(strip.left + 12, line)
        wanted = int((strip.bottom - line) * (levels - 1) / (strip.height - 1) + 0.5)
        assert blend_level(hand.paint.blend, levels) == wanted
        assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)
        assert bar_is_right(hand)
    assert hand.paint.blend == 1


def test_only_entries_and_the_words_of_a_handle_are_sent(hand: PaintingHand) -> None:
    bar = bar_of(hand)
    picture = Area(0, 0, bar.area.left - 40, 479)
    hand.spoil(picture)
    hand.spoil(bar.strip)
    line = bar.strip.top + 100
    hand.grab(bar.strip.left + 5, line)
    for down in range(5, 100, 5):
        before = hand.display.frame_buffer.written
        entries = hand.display.lookup_table.written
        hand.move(bar.strip.left + 5, line + down)
        assert hand.display.frame_buffer.written - before < 1000
        assert hand.display.lookup_table.written > entries
    assert (hand.words(picture) == 5).all()
    assert (hand.words(bar.strip) == 5).all()


def test_the_other_handle_is_the_percentage_of_the_light_color(hand: PaintingHand) -> None:
    area = hand.widget("light color at the maximum").area
    hand.click(area.left + 10, area.bottom)
    assert hand.paint.light_percentage == 0
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    assert tuple(hand.display.entries[first + levels - 1]) == hand.paint.object_color
    before = hand.scene
    hand.drag((area.left + 10, area.bottom), (area.left + 10, 200), (area.left + 10, area.top))
    assert hand.viewer.studio.history.to_undo[-1] is before
    assert hand.paint.light_percentage == 100
    assert tuple(hand.display.entries[first + levels - 1]) == hand.paint.light_color
    assert hand.paint.blend == boxes_scene().surfaces["box 0"].paint.blend


def test_the_bar_makes_room_for_the_menu(hand: PaintingHand) -> None:
    assert bar_of(hand).area.right > MENU.left
    hand.move(639, 200)
    bar, percent = bar_of(hand), hand.widget("light color at the maximum")
    assert bar.area.right < percent.area.left
    assert percent.area.right < MENU.left
    assert bar_is_right(hand)
    hand.click(bar.strip.left + 3, 300)
    assert hand.paint.blend != 0.4
    hand.move(20, 20)
    hand.viewer.tell("")
    assert bar_of(hand).area.right > MENU.left
    assert bar_is_right(hand)


def test_it_leads_back_to_color_mixing(hand: PaintingHand) -> None:
    hand.press("escape")
    assert hand.viewer.page == "mixing"
    hand.turn_to("light blending")
    hand.open_menu()
    hand.pick("< color mixing")
    assert hand.viewer.page == "mixing"


def test_hidden_panels_take_the_bar_away_and_bring_the_legend(tmp_path: Path) -> None:
    hand = blending(boxes_scene().with_scalar(name="z", legend=True), tmp_path)
    board = hand.viewer.board
    assert not board.content.items
    hand.open_menu()
    hand.pick("hide panels")
    hand.move(20, 20)
    assert "blend level" not in hand.labels
    assert board.content.items
    hand.open_menu()
    hand.pick("show panels")
    assert bar_of(hand)
    assert not board.content.items


def test_a_ramp_has_no_blend_level(tmp_path: Path) -> None:
    hand = PaintingHand(Viewer(boxes_scene().with_surface("box 0", ramp=["#000", "#f60"]), Ramtek9300()))
    hand.turn_to("light blending")
    assert hand.viewer.page == "mixing"
    assert hand.message == "light blending: a ramp has no blend"
    # Another surface leads there; the text stands where the bar would be.
    hand.pick("surface")
    hand.pick("light blending")
    assert bar_of(hand)
    hand.open_menu()
    hand.pick("surface")
    assert "blend level" not in hand.labels
    assert hand.viewer.board.content.items
    hand.pick("ramp", 0.95)
    assert bar_of(hand)
