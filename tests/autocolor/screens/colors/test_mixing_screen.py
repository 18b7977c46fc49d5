from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Paint, scene_of
from autocolor.mapping.color_blending import blend_level
from autocolor.screens.colors.mixing_screen import SCALE, SMALL, MixingScreen
from autocolor.screens.colors.paint_choices import SWATCHES
from autocolor.widgets.colors import NIGHT
from tests.autocolor.screens.mixing import STRIP, ZERO, bar_is_right, line_of, mixing, ramps_are_right
from tests.autocolor.screens.painting_hand import PaintingHand, boxes_scene

BARS = {
    "light source, red": ("light_color", 0),
    "light source, green": ("light_color", 1),
    "light source, blue": ("light_color", 2),
    "object, red": ("object_color", 0),
    "object, green": ("object_color", 1),
    "object, blue": ("object_color", 2),
}


@pytest.fixture
def hand(tmp_path: Path) -> PaintingHand:
    return mixing(boxes_scene(), tmp_path)


def test_the_ramps_show_all_intensities_of_both_colors(hand: PaintingHand) -> None:
    assert ramps_are_right(hand)
    hand.click(ZERO + 200, line_of(hand, "object, green"))
    hand.drag((ZERO + 255, line_of(hand, "light source, blue")), (ZERO + 31, 100))
    assert hand.paint == Paint((176, 200, 32), (255, 250, 31), 0.4)
    assert ramps_are_right(hand)


def test_the_bar_between_shows_the_entries_of_the_surface(hand: PaintingHand) -> None:
    assert bar_is_right(hand)
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    assert hand.words(STRIP).min() == first
    assert hand.words(STRIP).max() == first + levels - 1
    hand.click(ZERO + 99, line_of(hand, "light source, red"))
    assert bar_is_right(hand)


def test_the_small_picture_shows_the_chosen_surface_alone_in_its_words(hand: PaintingHand) -> None:
    hand.pick("surface")
    assert hand.viewer.session.surface_name == "box 1"
    first, levels = hand.viewer.studio.level_ranges["box 1"]
    words = hand.viewer.studio.words[::SCALE, ::SCALE]
    is_own = (first <= words) & (words < first + levels)
    assert is_own.any()
    assert np.array_equal(hand.words(SMALL), np.where(is_own, words, NIGHT))


@pytest.mark.parametrize("bar", BARS)
def test_each_bar_sets_its_component_by_one_an_element(hand: PaintingHand, bar: str) -> None:
    field, number = BARS[bar]
    for value in (0, 1, 143, 254, 255):
        hand.click(ZERO + value, line_of(hand, bar))
        color = getattr(hand.paint, field)
        assert color[number] == value
    before = getattr(boxes_scene().surface("box 0").paint, field)
    assert [color[other] for other in range(3) if other != number] == [
        before[other] for other in range(3) if other != number
    ]


def test_a_drag_is_seen_at_once_and_writes_no_word_of_the_small_picture(hand: PaintingHand) -> None:
    line = line_of(hand, "object, red")
    hand.spoil(SMALL)
    hand.move(ZERO + 176, line)
    hand.joystick.track = True
    hand.viewer.poll()
    for value in (170, 90, 20):
        before = hand.display.frame_buffer.written
        hand.move(ZERO + value, line)
        assert hand.paint.object_color == (value, 16, 32)
        assert ramps_are_right(hand)
        assert bar_is_right(hand)
        # The bar, the white one, their numbers, and the color's number twice.
        assert hand.display.frame_buffer.written - before < 25_000
    assert (hand.words(SMALL) == 5).all()


def test_a_drag_is_one_step_to_undo(hand: PaintingHand) -> None:
    scene = hand.viewer.studio.scene
    drags = {
        "object, red": ((ZERO + 176, 0), (ZERO + 90, 0), (ZERO + 20, 0)),
        "object, white": ((ZERO + 70, 0), (ZERO + 90, 0), (ZERO + 200, 0)),
        "blend bar": ((200, 0), (300, 0), (400, 0)),
    }
    for bar, places in drags.items():
        line = line_of(hand, bar)
        hand.drag(*((element, line) for element, _ in places))
        assert hand.viewer.studio.scene is not scene
        # The left half of the row undoes.
        area = hand.widget(" ").area
        hand.click(area.left + 16, area.top + 4)
        assert hand.viewer.studio.scene is scene
        assert hand.viewer.message == "undone"
        hand.click(area.left + 16, area.top + 4)
        assert hand.viewer.message == "nothing to undo"
        assert ramps_are_right(hand)
        assert bar_is_right(hand)


def test_the_white_bar_makes_tints_and_shades_and_comes_back(hand: PaintingHand) -> None:
    line = line_of(hand, "object, white")
    hand.click(ZERO + 135, line)
    red, green, blue = hand.paint.object_color
    assert red - 176 == green - 16 == blue - 32
    # All the way to white and to black, and back to what it was.
    hand.drag((ZERO + 135, line), (ZERO + 255, line))
    assert hand.paint.object_color == (255, 255, 255)
    hand.drag((ZERO + 255, line), (ZERO, line), (ZERO + 135, line))
    assert hand.paint.object_color == (red, green, blue)
    # What else is changed meanwhile is where it begins anew.
    hand.click(ZERO + 255, line)
    hand.click(ZERO + 100, line_of(hand, "object, blue"))
    hand.click(ZERO + 200, line)
    red, green, blue = hand.paint.object_color
    assert red == green == blue + 155


def test_the_bar_between_sets_the_blend(hand: PaintingHand) -> None:
    levels = hand.viewer.studio.level_ranges["box 0"].levels
    for element in (STRIP.left, 100, 321, STRIP.right):
        hand.click(element, STRIP.top + 5)
        wanted = int((element - STRIP.left) * (levels - 1) / (STRIP.width - 1) + 0.5)
        assert blend_level(hand.paint.blend, levels) == wanted
        assert bar_is_right(hand)
    assert hand.paint.blend == 1
    # A drag that leaves the bar stays at its end.
    hand.drag((300, STRIP.top), (300, 20), (0, 20))
    assert hand.paint.blend == 0


@pytest.mark.parametrize(("count", "levels"), [(1, None), (2, None), (60, None), (2, 1005)])
def test_leaving_restores_words_and_entries_byte_for_byte(
    tmp_path: Path, count: int, levels: int | None
) -> None:
    hand = mixing(boxes_scene(count, levels), tmp_path)
    before = hand.viewer.studio.scene
    hand.leave()
    assert hand.is_as_sent(before)
    hand.turn_to("color mixing")
    hand.pick("swatches")
    hand.click(SWATCHES.left + 60, SWATCHES.top + 60)
    hand.drag((100, STRIP.top), (200, STRIP.top), (250, STRIP.top))
    assert hand.viewer.studio.scene is not before
    hand.leave()
    assert hand.is_as_sent(hand.viewer.studio.scene)


@pytest.mark.parametrize(("count", "levels"), [(1, None), (2, 1005)])
def test_a_surface_that_owns_nearly_all_words_is_at_most_a_level_off(
    tmp_path: Path, count: int, levels: int | None
) -> None:
    hand = mixing(boxes_scene(count, levels), tmp_path)
    first, owned = hand.viewer.studio.level_ranges["box 0"]
    assert owned >= 1005
    words = hand.viewer.studio.words[::SCALE, ::SCALE].astype(int)
    is_own = (first <= words) & (words < first + owned)
    for label in ("finishes", "swatches"):
        hand.pick(label)
        seen = hand.words(SMALL).astype(int)
        assert np.abs(seen - words)[is_own].max() <= 1
        assert (seen[~is_own] == NIGHT).all()
        # So its colors are those of the picture, or of the neighboring level.
        entries = hand.viewer.studio.entries
        assert np.array_equal(hand.colors(SMALL)[is_own], entries[seen[is_own]])
        assert ramps_are_right(hand)
        assert bar_is_right(hand, most_off=1)


def test_sixty_surfaces_are_chosen_one_after_the_other(tmp_path: Path) -> None:
    hand = mixing(boxes_scene(60), tmp_path)
    for number in range(1, 61):
        hand.pick("surface")
        assert hand.viewer.session.surface_name == f"box {number % 60}"
    assert ramps_are_right(hand)
    assert bar_is_right(hand)
    hand.click(ZERO + 77, line_of(hand, "object, red"))
    assert hand.paint.object_color == (77, 16, 32)


def test_a_color_is_typed_by_name_or_number_where_there_is_a_keyboard(hand: PaintingHand) -> None:
    hand.pick("object")
    assert hand.viewer.message == "object: typing needs a keyboard"
    for typed, color in (("teal", (0, 128, 128)), ("#102030", (16, 32, 48))):
        hand.viewer.on_key("left")
        hand.viewer.on_key("right")
        hand.pick("object")
        for letter in typed:
            hand.viewer.on_key(letter, typed=letter)
        hand.viewer.on_key("return")
        assert hand.paint.object_color == color
    hand.pick("light")
    for letter in "tael":
        hand.viewer.on_key(letter, typed=letter)
    scene = hand.viewer.studio.scene
    hand.viewer.on_key("return")
    assert "teal" in hand.viewer.message
    assert hand.viewer.studio.scene is scene


@pytest.mark.parametrize(("bar", "name"), [("object, red", "red"), ("light source, white", "white")])
@pytest.mark.parametrize("typed", ["256", "-1", "12.5"])
def test_a_component_that_is_typed_must_be_a_whole_number(
    hand: PaintingHand, bar: str, name: str, typed: str
) -> None:
    scene = hand.viewer.studio.scene
    hand.move(ZERO + 100, line_of(hand, bar))
    for letter in typed:
        hand.viewer.on_key(letter, typed=letter)
    hand.viewer.on_key("return")
    assert hand.viewer.message == f"{name} must be a whole number from 0 to 255, not {typed}; type another"
    assert hand.viewer.studio.scene is scene


def test_pointing_at_the_small_picture_tells_the_level(hand: PaintingHand) -> None:
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    screen = hand.viewer.board.screen
    assert isinstance(screen, MixingScreen)
    line, element = np.argwhere(hand.words(SMALL) != NIGHT)[0].tolist()
    word = int(hand.words(SMALL)[line, element])
    told = screen.hint(SMALL.left + element, SMALL.top + line)
    assert told == f"box 0, level {word - first} of {levels - 1}"
    assert screen.hint(SMALL.left, SMALL.top) == "Only box 0 is shown here"
    assert screen.hint(300, 290) == screen.help


def test_a_scene_without_surfaces_in_use_says_so(tmp_path: Path) -> None:
    empty = scene_of(Mesh(np.zeros((0, 3)), np.zeros((0, 4), int)), name="empty")
    hand = mixing(empty, tmp_path)
    assert [row.label for row in hand.viewer.board.screen.rows()] == []
    assert hand.viewer.board.screen.hint(SMALL.left, SMALL.top) == hand.viewer.board.screen.help
    hand.click(30, 60)
    hand.turn_to("light blending")
    hand.move(20, 20)
    hand.leave()
    assert hand.is_as_sent(empty)
