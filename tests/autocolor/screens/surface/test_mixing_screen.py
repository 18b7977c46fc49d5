from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Paint, scene_of
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.mapping.colors import Hsv, blend_level, color_of_hsv, hsv_of
from autocolor.scene.kinds import in_digits
from autocolor.scene.swatches import swatches
from autocolor.screens.session import Clipboard
from autocolor.screens.surface.mixing_palette import Crop, crop_of
from autocolor.screens.surface.mixing_screen import (
    BLEND,
    LIGHT_SOURCE,
    OBJECT,
    PICTURE,
    ColorSection,
    MixingScreen,
    whole,
)
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import ComponentBar
from autocolor.widgets.items import BLUE, CHARACTER, GREEN, LIGHT_GRAY, NIGHT, RED, WHITE, Area, text
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import TEXT_DOWN, Place, Widget
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.mixing import (
    SHADES,
    STRIP,
    ZERO,
    bar_is_right,
    line_of,
    mixing,
    shades_are_right,
)
from tests.autocolor.screens.painting_hand import PAINTS, PaintingHand, boxes_scene

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


def test_the_shades_show_all_intensities_of_both_colors(hand: PaintingHand) -> None:
    assert shades_are_right(hand)
    hand.click(ZERO + 200, line_of(hand, "object, green"))
    hand.drag((ZERO + 255, line_of(hand, "light source, blue")), (ZERO + 31, 100))
    assert hand.paint == Paint((176, 200, 32), (255, 250, 31), 0.4)
    assert shades_are_right(hand)


def test_the_bar_between_shows_the_entries_of_the_surface(hand: PaintingHand) -> None:
    assert bar_is_right(hand)
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    assert hand.words(STRIP).min() == first
    assert hand.words(STRIP).max() == first + levels - 1
    hand.click(ZERO + 99, line_of(hand, "light source, red"))
    assert bar_is_right(hand)


def crop(hand: PaintingHand) -> Crop:
    """The part of the picture that shows the chosen surface."""
    first, levels = hand.viewer.studio.level_ranges[hand.viewer.session.surface_name]
    words = hand.viewer.studio.words
    return crop_of((first <= words) & (words < first + levels), PICTURE)


def place_in_picture(hand: PaintingHand, surface: str, shown: Crop | None = None) -> tuple[int, int]:
    """An element and a line of the screen where the picture shows a surface."""
    shown = shown or crop(hand)
    first, levels = hand.viewer.studio.level_ranges[surface]
    words = shown.of(hand.viewer.studio.words)
    places = np.argwhere((first <= words) & (words < first + levels))
    line, element = places[len(places) // 2].tolist()
    return shown.area.left + element, shown.area.top + line


def test_the_picture_shows_the_chosen_surface_in_its_words_and_the_others_in_grays(
    hand: PaintingHand,
) -> None:
    hand.pick("surface")
    assert hand.viewer.session.surface_name == "box 1"
    first, levels = hand.viewer.studio.level_ranges["box 1"]
    words = crop(hand).of(hand.viewer.studio.words)
    is_own = (first <= words) & (words < first + levels)
    assert is_own.any()
    assert (words[~is_own] > 0).any()
    seen, colors = hand.words(crop(hand).area), hand.colors(crop(hand).area).astype(int)
    assert np.array_equal(seen[is_own], words[is_own])
    assert (seen[words == 0] == NIGHT).all()
    assert np.ptp(colors[~is_own], axis=1).max() < 16
    assert colors[~is_own].max() < 128


def test_the_picture_fills_its_room_in_one_direction(hand: PaintingHand) -> None:
    for _ in range(2):
        area = crop(hand).area
        assert area.width == PICTURE.width or area.height == PICTURE.height
        hand.pick("surface")


@pytest.mark.parametrize("bar", BARS)
def test_an_element_of_a_bar_is_one_value_of_its_component(hand: PaintingHand, bar: str) -> None:
    field, number = BARS[bar]
    for value in (0, 1, 143, 254, 255):
        hand.click(ZERO + value, line_of(hand, bar))
        color = getattr(hand.paint, field)
        assert color[number] == value
    before = getattr(boxes_scene().surface("box 0").paint, field)
    assert [color[other] for other in range(3) if other != number] == [
        before[other] for other in range(3) if other != number
    ]


@pytest.mark.parametrize("bar", ["object, red", "object, white", "object, hue", "object, value"])
def test_a_drag_is_seen_at_once_and_writes_no_word_of_the_picture(hand: PaintingHand, bar: str) -> None:
    line = line_of(hand, bar)
    hand.spoil(PICTURE)
    hand.move(ZERO + 176, line)
    hand.joystick.track = True
    hand.viewer.poll()
    for value in (170, 90, 20):
        before = hand.display.frame_buffer.written
        color = hand.paint.object_color
        hand.move(ZERO + value, line)
        assert hand.paint.object_color != color
        assert shades_are_right(hand)
        assert bar_is_right(hand)
        # The bars, their numbers, and the color's number twice.
        assert hand.display.frame_buffer.written - before < 20_000
    assert (hand.words(PICTURE) == 5).all()


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
        assert hand.viewer.message.startswith("undone: ")
        hand.click(area.left + 16, area.top + 4)
        assert hand.viewer.message == "nothing to undo"
        assert shades_are_right(hand)
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


def ramp_of(hand: PaintingHand) -> tuple[Color, ...]:
    ramp = hand.paint.ramp
    assert ramp is not None
    return ramp


def give(hand: PaintingHand, ramp: list[str]) -> None:
    hand.viewer.session.paint(ramp=ramp)
    hand.move(300, 440)


def test_a_ramp_that_is_switched_on_looks_nearly_as_before_and_off_is_as_before(hand: PaintingHand) -> None:
    before, entries = hand.paint, hand.viewer.studio.entries.astype(int)
    hand.pick("ramp", 0.95)
    assert hand.viewer.message == "box 0: the ramp replaces its two colors and their blend"
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    colors = [first + int(step * (levels - 1) / 5 + 0.5) for step in range(6)]
    assert np.array_equal(ramp_of(hand), entries[colors])
    # The blend of 0.4 begins at the third of six colors.
    assert np.abs(hand.viewer.studio.entries - entries).max() <= 4
    assert bar_is_right(hand)
    hand.pick("ramp", 0.95)
    assert hand.paint == before
    assert hand.viewer.message == "box 0: two colors and their blend replace its ramp"


def test_a_color_of_the_ramp_is_picked_on_the_bar_and_mixed_alone(hand: PaintingHand) -> None:
    give(hand, ["#200", "#f60", "#00f", "#fff"])
    # A third of the bar is at the second color, and nearest to it up to the middle.
    hand.click(STRIP.left + STRIP.width / 2 - 3, STRIP.top + 5)
    assert hand.viewer.message == "swatches are for color 2 of 4"
    hand.click(ZERO + 7, line_of(hand, "color 2, blue"))
    hand.click(ZERO + 9, line_of(hand, "color 3, red"))
    assert ramp_of(hand) == ((34, 0, 0), (255, 102, 7), (9, 0, 255), (255, 255, 255))
    assert bar_is_right(hand)
    assert np.array_equal(hand.colors(SHADES["object"])[0, -1], (255, 102, 7))
    # The last color is mixed above, where the light source was; swatches are for it, too.
    hand.drag((300, STRIP.top), (STRIP.right + 50, STRIP.top))
    hand.pick("paints", 0.7)
    *others, last = ramp_of(hand)
    assert others == [(34, 0, 0), (255, 102, 7), (9, 0, 255)]
    assert list(last) in swatches().tolist()
    hand.pick("surface")
    assert hand.widget("blend bar")


def test_the_wheel_goes_from_color_to_color_on_the_bar(hand: PaintingHand) -> None:
    give(hand, ["#200", "#f60", "#fff"])
    numbers = []
    for turn in ("down", "down", "up", "up", "up", "down"):
        hand.viewer.on_pointer(STRIP.left + 40, STRIP.top + 5, f"wheel {turn}")
        numbers.append(hand.viewer.message[len("swatches are for ") :])
    assert numbers == [f"color {number} of 3" for number in (1, 1, 2, 3, 3, 2)]


def test_colors_are_added_between_two_and_removed_down_to_two(hand: PaintingHand) -> None:
    give(hand, ["#000", "#f60", "#fff"])
    hand.pick("ramp bar", 0.1)
    hand.pick("add color")
    assert ramp_of(hand) == ((0, 0, 0), (128, 51, 0), (255, 102, 0), (255, 255, 255))
    assert hand.viewer.message == "swatches are for color 2 of 4"
    for rest in (((0, 0, 0), (255, 102, 0), (255, 255, 255)), ((0, 0, 0), (255, 255, 255))):
        hand.pick("remove color")
        assert ramp_of(hand) == rest
    hand.pick("remove color")
    assert hand.viewer.message == (
        "remove color: a ramp has at least 2 colors; to have none, switch the ramp off"
    )
    for _ in range(3):
        hand.pick(" ", 0.1)
    assert len(ramp_of(hand)) == 3
    # Undo may shorten the ramp below the chosen color.
    hand.pick(" ", 0.1)
    assert hand.paint == PAINTS[0]


def test_a_ramp_of_the_most_colors_takes_no_further_color(hand: PaintingHand) -> None:
    ramp = tuple((number % 256, number // 4, 0) for number in range(1024))
    hand.viewer.session.paint(ramp=ramp)
    hand.move(300, 440)
    hand.pick("add color")
    assert hand.viewer.message == "add color: a ramp has at most 1,024 colors; remove a color first"
    assert ramp_of(hand) == ramp


def test_rows_stay_in_their_places_when_a_ramp_is_switched(hand: PaintingHand) -> None:
    labels = ("ramp", "take paint", "take color", "paints")
    places = [hand.widget(label).area for label in labels]
    hand.pick("ramp", 0.95)
    assert [hand.widget(label).area for label in labels] == places
    # The color that is mixed first is bright enough to be seen.
    assert max(ramp_of(hand)[3]) > 100
    assert hand.widget("color 4, red")


@pytest.mark.parametrize("ramp", [None, ["#000", "#f60"]])
def test_the_bar_between_says_that_a_scalar_hides_the_paint(tmp_path: Path, ramp: list[str] | None) -> None:
    scene = boxes_scene().with_surface("box 0", ramp=ramp)
    hidden = "not shown: a scalar colors the surface"
    heading = text(hidden, BLEND.right + 1 - CHARACTER * len(hidden), BLEND.top - 12 + TEXT_DOWN)
    for is_hidden, shown in ((False, scene), (True, scene.with_scalar(name="z", surfaces=["box 0"]))):
        hand = mixing(shown, tmp_path)
        assert (heading in hand.viewer.board.screen.items()) == is_hidden


def test_a_finish_replaces_a_ramp_and_another_surface_takes_it(hand: PaintingHand) -> None:
    give(hand, ["#000", "#f60", "#fff"])
    hand.viewer.session.choose_surface("box 1")
    hand.viewer.session.take_paint("box 0")
    assert hand.viewer.message == (
        "box 1: the paint of box 0; undo goes back; the ramp replaces its two colors and their blend"
    )
    assert hand.paint == Paint(ramp=((0, 0, 0), (255, 102, 0), (255, 255, 255)))
    hand.pick("metal")
    assert hand.viewer.message == "box 1: metal; two colors and their blend replace its ramp"
    assert hand.paint.object_color == (255, 102, 0)


def test_a_key_for_the_blend_brings_back_the_colors_before_the_ramp(hand: PaintingHand) -> None:
    give(hand, ["#000", "#f60"])
    hand.viewer.board.screen.session.paint(blend=0.5)
    assert hand.paint == PAINTS[0].replace(blend=0.5)


def test_without_a_paint_before_the_colors_of_the_ramp_remain(tmp_path: Path) -> None:
    hand = mixing(boxes_scene().with_surface("box 0", ramp=["#000", "#f60", "#0f0"]), tmp_path)
    hand.pick("ramp", 0.95)
    assert hand.paint == Paint((255, 102, 0), (0, 255, 0))


@pytest.mark.parametrize(("count", "levels"), [(1, None), (2, None), (60, None), (2, 1005)])
def test_leaving_restores_words_and_entries_byte_for_byte(
    tmp_path: Path, count: int, levels: int | None
) -> None:
    hand = mixing(boxes_scene(count, levels), tmp_path)
    before = hand.viewer.studio.scene
    hand.leave()
    assert hand.is_as_sent(before)
    hand.turn_to("color mixing")
    hand.pick("paints")
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
    words = crop(hand).of(hand.viewer.studio.words).astype(int)
    is_own = (first <= words) & (words < first + owned)
    seen = hand.words(crop(hand).area).astype(int)
    assert np.abs(seen - words)[is_own].max() <= 1
    # So its colors are those of the picture, or of the neighboring level.
    entries = hand.viewer.studio.entries
    assert np.array_equal(hand.colors(crop(hand).area)[is_own], entries[seen[is_own]])
    assert shades_are_right(hand)
    assert bar_is_right(hand, most_off=1)


def test_sixty_surfaces_are_chosen_in_turn(tmp_path: Path) -> None:
    hand = mixing(boxes_scene(60), tmp_path)
    for number in range(1, 61):
        hand.choose("surface", f"box {number % 60}")
        assert hand.viewer.session.surface_name == f"box {number % 60}"
    assert shades_are_right(hand)
    assert bar_is_right(hand)
    hand.click(ZERO + 77, line_of(hand, "object, red"))
    assert hand.paint.object_color == (77, 16, 32)


def test_a_color_is_picked_letter_by_letter_with_the_unit_alone(hand: PaintingHand) -> None:
    for name, color in (("teal", (0, 128, 128)), ("#102030", (16, 32, 48))):
        hand.pick("object")
        for letter in name:
            hand.pick(letter)
        hand.pick("OK")
        assert hand.paint.object_color == color


def test_a_color_is_typed_by_name_or_number_where_there_is_a_keyboard(hand: PaintingHand) -> None:
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


def test_pointing_at_the_picture_tells_the_level_or_the_other_surface(hand: PaintingHand) -> None:
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    screen = hand.viewer.board.screen
    assert isinstance(screen, MixingScreen)
    element, line = place_in_picture(hand, "box 0")
    word = int(hand.display.words[line, element])
    assert screen.hint(element, line) == f"box 0, level {word - first} of {levels - 1}"
    there = place_in_picture(hand, "box 1")
    assert screen.hint(*there) == "box 1: click to mix its colors; P: take its paint"
    assert screen.hint(PICTURE.left, PICTURE.top) == screen.help
    hand.click(*there)
    assert hand.viewer.session.surface_name == "box 1"
    assert hand.viewer.message == "surface box 1"


def test_a_scene_without_surfaces_in_use_says_so(tmp_path: Path) -> None:
    empty = scene_of(Mesh(np.zeros((0, 3)), np.zeros((0, 4), int)), name="empty")
    hand = mixing(empty, tmp_path)
    assert [row.label for row in hand.viewer.board.screen.rows()] == []
    assert hand.viewer.board.screen.hint(300, 300) == hand.viewer.board.screen.help
    hand.viewer.on_key("p", typed="p")
    assert hand.viewer.message == "no surface is under the pointer; point at it in the picture"
    hand.click(30, 60)
    hand.turn_to("light blending")
    hand.move(20, 20)
    hand.leave()
    assert hand.is_as_sent(empty)


PAINT = Paint((10, 20, 31), (255, 0, 0))


@pytest.fixture
def viewer(tmp_path: Path) -> Viewer:
    return Viewer(boxes_scene(), Ramtek9300(), tmp_path)


def section_of(viewer: Viewer, title: str, given: list[object]) -> ColorSection:
    return ColorSection(
        viewer.session, title, 100, give=lambda section, color: given.append((section.title, color)),
        choose=lambda section: given.append(section.title),
    )  # fmt: skip


HUE_WORDS = np.arange(200, 237, dtype=np.uint16)


def widgets_of(section: ColorSection, is_chosen: bool = False) -> list[Widget]:
    return section.widgets(PAINT, is_chosen, HUE_WORDS)


@pytest.mark.parametrize(
    ("title", "values"),
    [
        (OBJECT, [10, 20, 31, 20, *hsv_of((10, 20, 31))]),
        (LIGHT_SOURCE, [255, 0, 0, 85, 0, 100, 100]),
    ],
)
def test_it_has_a_heading_a_number_and_seven_bars(viewer: Viewer, title: str, values: list[float]) -> None:
    heading, number, *bars = widgets_of(section_of(viewer, title, []))
    assert heading.label == title
    assert number.typed is not None
    assert number.typed.text == ("#0a141f" if title == OBJECT else "#ff0000")
    assert all(isinstance(bar, ComponentBar) for bar in bars)
    found = [(bar.letter, bar.word, bar.value) for bar in bars if isinstance(bar, ComponentBar)]
    words = (RED, GREEN, BLUE, WHITE, *(LIGHT_GRAY,) * 3)
    assert found == list(zip("RGBWHSV", words, values, strict=True))


def test_bars_and_shades_stand_beside_each_other_without_overlapping(viewer: Viewer) -> None:
    section = section_of(viewer, OBJECT, [])
    widgets = widgets_of(section, is_chosen=True)
    areas = [section.shades, *(each.area for each in widgets)]
    for number, area in enumerate(areas):
        assert section.area.covers(area)
        assert not any(area.overlaps(other) for other in areas[number + 1 :])
    assert section.shades.bottom == widgets[-1].area.bottom
    assert section.shades.right < min(each.area.left for each in widgets[2:])


def test_bars_of_hue_saturation_and_value_set_the_color(hand: PaintingHand) -> None:
    hand.click(ZERO, line_of(hand, "object, hue"))
    red, green, blue = hand.paint.object_color
    assert (red, green) == (176, blue)
    hand.click(ZERO + 85, line_of(hand, "object, hue"))
    assert hand.paint.object_color == (green, red, green)
    hand.click(ZERO + 255, line_of(hand, "object, saturation"))
    assert hand.paint.object_color == (0, 176, 0)
    hand.drag((ZERO + 10, line_of(hand, "light source, value")), (ZERO, 0), (ZERO - 40, 0))
    assert hand.paint.light_color == (0, 0, 0)
    assert shades_are_right(hand)


@pytest.mark.parametrize("color", [(176, 16, 32), (3, 1, 2), (255, 255, 254)])
@pytest.mark.parametrize("bar", ["saturation", "value"])
def test_a_color_that_passes_through_gray_or_black_keeps_its_hue(
    hand: PaintingHand, color: Color, bar: str
) -> None:
    hand.viewer.session.paint(object_color=color)
    line = line_of(hand, f"object, {bar}")
    hand.drag((ZERO + 200, line), (ZERO + 4, line), (ZERO, line))
    assert len(set(hand.paint.object_color)) == 1
    hue = hand.widget("object, hue")
    assert isinstance(hue, ComponentBar)
    assert hue.value == hsv_of(color).hue
    # The bar brings back the same hue.
    hand.drag((ZERO + 1, line), (ZERO + 100, line), (ZERO + 255, line))
    hsv = list(hsv_of(color))
    hsv[1 if bar == "saturation" else 2] = 100
    assert hand.paint.object_color == color_of_hsv(Hsv(*hsv))


@pytest.mark.parametrize("bar", ["hue", "saturation", "value"])
def test_another_color_sets_the_bars_anew(hand: PaintingHand, bar: str) -> None:
    hand.click(ZERO + 100, line_of(hand, f"object, {bar}"))
    hand.click(ZERO + 60, line_of(hand, "object, green"))
    values = [hand.widget(f"object, {name}") for name in ("hue", "saturation", "value")]
    assert [each.value for each in values if isinstance(each, ComponentBar)] == list(
        hsv_of(hand.paint.object_color)
    )


@pytest.mark.parametrize(("bar", "most"), [("hue", 360), ("saturation", 100), ("value", 100)])
def test_a_number_beyond_the_bar_is_refused(hand: PaintingHand, bar: str, most: int) -> None:
    scene = hand.viewer.studio.scene
    hand.move(ZERO + 100, line_of(hand, f"object, {bar}"))
    for letter in "361":
        hand.viewer.on_key(letter, typed=letter)
    hand.viewer.on_key("return")
    assert hand.viewer.message == f"{bar} must be a number from 0 to {most}, not 361; type another"
    assert hand.viewer.studio.scene is scene


def test_a_component_is_put_into_the_color_that_the_surface_has_now(viewer: Viewer) -> None:
    given: list[object] = []
    bars = widgets_of(section_of(viewer, OBJECT, given))[2:]
    assert isinstance(bars[1], ComponentBar)
    bars[1].put(99.0)
    assert given == [(OBJECT, (176, 99, 32))]


def test_a_pick_on_the_heading_chooses_the_color(viewer: Viewer) -> None:
    given: list[object] = []
    section = section_of(viewer, OBJECT, given)
    heading, *_ = widgets_of(section)
    heading.pick(Place(10, 104))
    assert given == [OBJECT]


def test_the_heading_and_the_row_have_different_keys(viewer: Viewer) -> None:
    for title in (OBJECT, LIGHT_SOURCE):
        section = section_of(viewer, title, [])
        keys = [each.key for each in (*widgets_of(section), section.row(PAINT))]
        assert len(set(keys)) == len(keys)


def test_the_row_takes_the_typed_text_unchanged(viewer: Viewer) -> None:
    given: list[object] = []
    row = section_of(viewer, LIGHT_SOURCE, given).row(PAINT)
    assert (row.label, row.value) == ("light", "#ff0000")
    row.take("teal")
    assert given == [(LIGHT_SOURCE, "teal")]


def test_the_shades_rise_to_the_right_from_the_first_step_to_the_last(viewer: Viewer) -> None:
    display = Ramtek9300()
    section = section_of(viewer, OBJECT, [])
    shades = np.arange(300, 364, dtype=np.uint16)
    for item in section.items(shades):
        display.send(np.frombuffer(item.stream, np.uint16))
    line = display.words[section.shades.top, section.shades.left : section.shades.right + 1]
    assert set(np.bincount(line)[301:363].tolist()) <= {2, 3}
    assert line.tolist() == sorted(line.tolist())
    assert (line[0], line[-1]) == (300, 363)


@pytest.mark.parametrize("value", [-1, 256, 0.5, float("inf"), float("nan")])
def test_a_value_that_is_no_component_is_refused(value: float) -> None:
    with pytest.raises(UsageError) as told:
        whole("green", value)
    assert str(told.value) == f"green must be a whole number from 0 to 255, not {value:g}; type another"


def whole_picture(hand: PaintingHand) -> Crop:
    """The whole picture, from which paints and colors are taken."""
    return crop_of(np.ones(hand.viewer.studio.words.shape, np.bool_), WORK)


def test_the_unit_takes_the_paint_of_a_surface_that_it_picks_in_the_whole_picture(hand: PaintingHand) -> None:
    before, entries = hand.viewer.studio.scene, hand.viewer.studio.entries
    hand.pick("take paint")
    assert (
        hand.viewer.message == "pick a surface: box 0 takes both its colors, blend and percentage; Esc ends"
    )
    # The picture is seen in its own colors.
    shown = whole_picture(hand)
    assert np.array_equal(hand.words(shown.area), shown.of(hand.viewer.studio.words))
    assert np.array_equal(hand.display.entries, entries)
    there = place_in_picture(hand, "box 1", shown)
    told = "pick the paint of box 1: #1e5ac8 and #ffffff, blend 0.70; Esc ends"
    assert hand.viewer.board.screen.hint(*there) == told
    hand.click(*there)
    assert hand.paint == PAINTS[1]
    assert hand.viewer.message == "box 0: the paint of box 1; undo goes back"
    assert shades_are_right(hand)
    assert bar_is_right(hand)
    hand.pick(" ", 0.1)
    assert hand.viewer.studio.scene is before


@pytest.mark.parametrize("title", [OBJECT, LIGHT_SOURCE])
def test_the_unit_takes_a_color_as_it_is_seen(hand: PaintingHand, title: str) -> None:
    hand.pick(f"{title} heading")
    hand.pick("take color")
    assert hand.viewer.message == f"pick a pixel: its color as you see it becomes the {title} color; Esc ends"
    element, line = place_in_picture(hand, "box 1", whole_picture(hand))
    red, green, blue = hand.colors(Area(element, line, element, line))[0, 0].tolist()
    color = red, green, blue
    hint = hand.viewer.board.screen.hint(element, line)
    assert hint == f"pick {in_digits(color)} of box 1 as the {title} color; Esc ends"
    hand.click(element, line)
    assert (hand.paint.object_color if title == OBJECT else hand.paint.light_color) == color
    assert hand.viewer.message == f"{title}: {in_digits(color)}"
    assert shades_are_right(hand)


@pytest.mark.parametrize("end", ["the row", "escape", "leaving"])
def test_taking_ends_without_a_pick(hand: PaintingHand, end: str) -> None:
    scene = hand.viewer.studio.scene
    hand.pick("take paint")
    if end == "the row":
        hand.pick("take paint")
    elif end == "escape":
        hand.viewer.on_key("escape")
    else:
        hand.leave()
        hand.turn_to("color mixing")
    assert hand.viewer.page == "mixing"
    assert hand.viewer.studio.scene is scene
    assert shades_are_right(hand)


def test_a_paint_is_not_taken_from_the_background_or_the_chosen_surface(hand: PaintingHand) -> None:
    scene = hand.viewer.studio.scene
    hand.pick("take paint")
    hand.click(20, 60)
    assert hand.viewer.message.startswith("no surface is there; pick a surface")
    hand.click(*place_in_picture(hand, "box 0", whole_picture(hand)))
    assert hand.viewer.message == "box 0 is the chosen surface; point at another, whose paint it takes"
    assert hand.viewer.studio.scene is scene
    # The user still picks.
    hand.click(*place_in_picture(hand, "box 1", whole_picture(hand)))
    assert hand.paint == PAINTS[1]


def test_keys_take_the_paint_and_the_color_under_the_pointer(hand: PaintingHand) -> None:
    hand.move(*place_in_picture(hand, "box 1"))
    pixel = crop(hand).pixel_at(*place_in_picture(hand, "box 1"))
    color = tuple(hand.viewer.studio.entries[hand.viewer.studio.words[pixel]].tolist())
    hand.viewer.on_key("p", typed="P", shift=True)
    assert hand.paint == PAINTS[0].replace(object_color=color)
    hand.viewer.on_key("p", typed="p")
    assert hand.paint == PAINTS[1]
    hand.move(30, 160)
    hand.viewer.on_key("p", typed="p")
    assert hand.viewer.message == "no surface is under the pointer; point at it in the picture"


class FakeClipboard:
    """A clipboard that holds a text."""

    def __init__(self, text: str = "") -> None:
        self.text = text

    def copy(self, text: str) -> bool:
        self.text = text
        return True


@pytest.fixture
def clipboard(hand: PaintingHand) -> FakeClipboard:
    held = FakeClipboard()
    hand.viewer.session.clipboard = Clipboard(held.copy, lambda: held.text)
    return held


@pytest.mark.parametrize(
    ("place", "color"),
    [((400, 10), "#fffaf0"), ((30, 40), "#fffaf0"), ((400, 150), "#b01020"), ((300, 300), "#b01020")],
)
def test_a_color_is_copied_over_its_section_and_elsewhere_the_chosen_color(
    hand: PaintingHand, clipboard: FakeClipboard, place: tuple[int, int], color: str
) -> None:
    hand.move(*place)
    hand.viewer.on_key("c", control=True)
    assert clipboard.text == color
    assert hand.viewer.message == f"copied {color}"


@pytest.mark.parametrize("text", ["#102030", " teal\0\nmore", "rgb(1, 2, 3)\r\n"])
@pytest.mark.parametrize(("place", "title"), [((400, 10), LIGHT_SOURCE), ((300, 300), OBJECT)])
def test_a_color_is_pasted_into_the_section_or_the_chosen_color(
    hand: PaintingHand, clipboard: FakeClipboard, text: str, place: tuple[int, int], title: str
) -> None:
    clipboard.text = text
    hand.move(*place)
    hand.viewer.on_key("v", control=True)
    color = {"#": (16, 32, 48), " ": (0, 128, 128), "r": (1, 2, 3)}[text[0]]
    assert (hand.paint.object_color if title == OBJECT else hand.paint.light_color) == color
    assert shades_are_right(hand)


def test_a_text_that_is_no_color_is_refused(hand: PaintingHand, clipboard: FakeClipboard) -> None:
    scene = hand.viewer.studio.scene
    clipboard.text = "tael"
    hand.viewer.on_key("v", control=True)
    assert "did you mean 'teal'" in hand.viewer.message
    clipboard.text = " \n#102030"
    hand.viewer.on_key("v", control=True)
    assert hand.viewer.message == "the clipboard has no text; copy a color first"
    assert hand.viewer.studio.scene is scene


def test_the_number_in_the_heading_is_typed_pasted_and_copied(
    hand: PaintingHand, clipboard: FakeClipboard
) -> None:
    hand.viewer.on_key("left")
    for letters, pasted, color in (("#10", "2030", (16, 32, 48)), ("", "navy", (0, 0, 128))):
        hand.pick("heading.object")
        for letter in letters:
            hand.viewer.on_key(letter, typed=letter)
        clipboard.text = pasted
        hand.viewer.on_key("v", control=True)
        hand.viewer.on_key("c", control=True)
        assert clipboard.text == letters + pasted
        hand.viewer.on_key("return")
        assert hand.paint.object_color == color
    hand.move(*hand.widget("heading.light").area[:2])
    hand.viewer.on_key("c", control=True)
    assert clipboard.text == "#fffaf0"


def test_without_a_clipboard_the_message_has_the_color(hand: PaintingHand) -> None:
    scene = hand.viewer.studio.scene
    hand.viewer.on_key("c", control=True)
    assert (
        hand.viewer.message == "#b01020 is not copied, because this display has no clipboard; write it down"
    )
    hand.viewer.on_key("v", control=True)
    assert hand.viewer.message == "this display has no clipboard; type the color"
    assert hand.viewer.studio.scene is scene
