from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, Paint, Palette, scene_of
from autocolor.arrays import Booleans, Words
from autocolor.checks import Color
from autocolor.files.state import recent_colors
from autocolor.mapping.colors import Hsv, color_of_hsv, hsv_of
from autocolor.scene.kinds import in_digits
from autocolor.scene.swatches import FINISHES, finished, swatches
from autocolor.screens.session import Clipboard
from autocolor.screens.steps import undo
from autocolor.screens.surface.mixing_palette import Crop, crop_of
from autocolor.screens.surface.mixing_screen import PICTURE
from autocolor.screens.surface.painting import TWO_COLORS, change_paint, take_paint
from autocolor.widgets.bars import ComponentBar
from autocolor.widgets.items import NIGHT, Area
from autocolor.widgets.menu import WORK
from tests.autocolor.screens.mixing import SHADES, STRIP, ZERO, bar_is_right, mixing, shades_are_right
from tests.autocolor.screens.painting_hand import PAINTS, PaintingHand, boxes_scene
from tests.autocolor.widgets.drawing import drawing_on
from tests.tables import first


@pytest.fixture
def hand(tmp_path: Path) -> PaintingHand:
    return mixing(boxes_scene(), tmp_path)


@pytest.mark.parametrize("section", TWO_COLORS)
def test_the_bars_of_a_color_have_its_numbers_and_set_them_to_the_element(
    hand: PaintingHand, section: str
) -> None:
    def values() -> list[float | None]:
        names = ("red", "green", "blue", "white", "hue", "saturation", "value")
        bars = [hand.widget(f"{section}, {name}") for name in names]
        return [bar.value for bar in bars if isinstance(bar, ComponentBar)]

    def color() -> Color:
        return hand.paint.object_color if section == "object" else hand.paint.light_color

    for name, value in (("red", 255), ("green", 31), ("blue", 255)):
        hand.click(ZERO + value, hand.middle(f"{section}, {name}")[1])
    assert color() == (255, 31, 255)
    assert values() == [255, 31, 255, pytest.approx(541 / 3, abs=0.5), *hsv_of((255, 31, 255))]
    assert shades_are_right(hand)
    assert bar_is_right(hand)
    for bar in ("hue", "saturation", "value"):
        hand.click(ZERO + 100, hand.middle(f"{section}, {bar}")[1])
        hand.click(ZERO + 60, hand.middle(f"{section}, green")[1])
        assert values()[4:] == list(hsv_of(color()))


def has_surface(hand: PaintingHand, words: Words) -> Booleans:
    """Whether each word is of the chosen surface."""
    levels = hand.viewer.studio.level_ranges[hand.viewer.session.surface_name]
    return (levels.first <= words) & (words <= levels.last)


def crop(hand: PaintingHand) -> Crop:
    """The part of the picture that shows the chosen surface."""
    return crop_of(has_surface(hand, hand.viewer.studio.words), PICTURE)


def place_in_picture(hand: PaintingHand, surface: str) -> tuple[int, int]:
    """An element and a line of the screen where the picture shows a surface."""
    content = hand.viewer.board.content
    grid = product(range(0, WORK.right, 4), range(WORK.top, WORK.bottom, 4))
    samples = ((place, content.sample(*place)) for place in grid)
    places = [place for place, seen in samples if seen is not None and seen.surface == surface]
    return places[len(places) // 2]


def test_the_picture_shows_the_chosen_surface_in_its_words_and_the_others_in_grays(
    hand: PaintingHand,
) -> None:
    hand.pick("surface")
    assert hand.viewer.session.surface_name == "box 1"
    area = crop(hand).area
    assert area.width == PICTURE.width or area.height == PICTURE.height
    words = crop(hand).of(hand.viewer.studio.words)
    is_own = has_surface(hand, words)
    assert is_own.any()
    assert (words[~is_own] > 0).any()
    seen, colors = hand.words(crop(hand).area), hand.colors(crop(hand).area).astype(int)
    assert np.array_equal(seen[is_own], words[is_own])
    assert (seen[words == 0] == NIGHT).all()
    assert np.ptp(colors[~is_own], axis=1).max() < 16
    assert colors[~is_own].max() < 128


def test_a_finish_is_seen_under_the_pointer_and_given_by_a_click(hand: PaintingHand) -> None:
    scene, studio = hand.scene, hand.viewer.studio
    before = hand.colors(PICTURE)
    for name in FINISHES:
        hand.move(*hand.widget(name).area.middle)
        finish = scene.with_surface("box 0", **finished(scene.surfaces["box 0"], name))
        wanted = studio.image_of(finish)
        shown = crop(hand)
        is_own = has_surface(hand, shown.of(wanted.words))
        assert np.array_equal(hand.colors(shown.area)[is_own], wanted.entries[shown.of(wanted.words)[is_own]])
        assert not np.array_equal(hand.colors(PICTURE), before)
    assert (hand.scene, studio.history.to_undo) == (scene, ())
    seen = hand.colors(PICTURE)
    hand.move(300, 440)
    assert np.array_equal(hand.colors(PICTURE), before)
    hand.pick("glass")
    assert hand.scene.equals(finish)
    assert np.array_equal(hand.colors(PICTURE), seen)
    hand.pick(" ", 0.1)
    assert hand.scene is scene


@pytest.mark.parametrize("bar", first(2, ["object, white", "object, hue", "object, red", "object, value"]))
def test_a_drag_is_seen_at_once_and_is_one_step_and_writes_no_word_of_the_picture(
    hand: PaintingHand, bar: str
) -> None:
    line, scene = hand.middle(bar)[1], hand.scene
    hand.spoil(PICTURE)
    hand.grab(ZERO + 176, line)
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
    hand.drop()
    hand.pick(" ", 0.1)
    assert hand.scene is scene


def test_the_white_bar_makes_tints_and_shades_and_comes_back(hand: PaintingHand) -> None:
    line = hand.middle("object, white")[1]
    hand.click(ZERO + 135, line)
    red, green, blue = hand.paint.object_color
    assert red - 176 == green - 16 == blue - 32
    # All the way to white and to black, and back to what it was.
    hand.click(ZERO + 255, line)
    assert hand.paint.object_color == (255, 255, 255)
    hand.drag((ZERO + 255, line), (ZERO, line), (ZERO + 135, line))
    assert hand.paint.object_color == (red, green, blue)
    # What else is changed meanwhile is where it begins anew.
    hand.click(ZERO + 255, line)
    hand.click(ZERO + 100, hand.middle("object, blue")[1])
    hand.click(ZERO + 200, line)
    red, green, blue = hand.paint.object_color
    assert red == green == blue + 155


def ramp_of(hand: PaintingHand) -> tuple[Color, ...]:
    ramp = hand.paint.ramp
    assert ramp is not None
    return ramp


def give(hand: PaintingHand, ramp: list[str]) -> None:
    change_paint(hand.viewer.session, ramp=ramp)
    hand.move(300, 440)


def test_a_ramp_that_is_switched_on_looks_nearly_as_before_and_off_is_as_before(hand: PaintingHand) -> None:
    before, entries = hand.paint, hand.viewer.studio.entries.astype(int)
    # Rows stay in their places.
    labels = ("ramp", "light blending", "take paint", "paints")
    places = [hand.widget(label).area for label in labels]
    hand.pick("ramp", 0.95)
    assert hand.message == "box 0: the ramp replaces its two colors and their blend"
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    colors = [first + int(step * (levels - 1) / 5 + 0.5) for step in range(6)]
    assert np.array_equal(ramp_of(hand), entries[colors])
    # The color that is mixed first is bright enough to be seen.
    assert max(ramp_of(hand)[3]) > 100
    assert [hand.widget(label).area for label in labels] == places
    # The blend of 0.4 begins at the third of six colors.
    assert np.abs(hand.viewer.studio.entries - entries).max() <= 4
    hand.pick("ramp", 0.95)
    assert hand.paint == before
    assert hand.message == "box 0: two colors and their blend replace its ramp"
    # An edit of the blend brings back the colors before the ramp; without them, colors of the ramp remain.
    give(hand, ["#000", "#f60"])
    change_paint(hand.viewer.session, blend=0.5)
    assert hand.paint == before.replace(blend=0.5)
    bare = mixing(
        boxes_scene().with_surface("box 0", ramp=["#000", "#f60", "#0f0"]), hand.viewer.session.folder
    )
    bare.pick("ramp", 0.95)
    assert bare.paint == Paint((255, 102, 0), (0, 255, 0))


def test_a_color_of_the_ramp_is_picked_on_the_bar_and_mixed_alone(hand: PaintingHand) -> None:
    give(hand, ["#200", "#f60", "#00f", "#fff"])
    # A third of the bar is at the second color, and nearest to it up to the middle.
    hand.click(STRIP.left + STRIP.width / 2 - 3, STRIP.top + 5)
    assert hand.message == "swatches are for color 2 of 4"
    hand.click(ZERO + 7, hand.middle("color 2, blue")[1])
    hand.click(ZERO + 9, hand.middle("color 3, red")[1])
    assert ramp_of(hand) == ((34, 0, 0), (255, 102, 7), (9, 0, 255), (255, 255, 255))
    assert bar_is_right(hand)
    assert np.array_equal(hand.colors(SHADES["object"])[0, -1], (255, 102, 7))
    # The last color is mixed above, where the light source was; swatches are for it, too.
    hand.click(STRIP.right, STRIP.top)
    hand.pick("paints", 0.7)
    *others, last = ramp_of(hand)
    assert others == [(34, 0, 0), (255, 102, 7), (9, 0, 255)]
    assert list(last) in swatches().tolist()
    hand.pick("surface")
    assert hand.widget("blend bar")


def test_a_color_of_the_ramp_is_dragged_along_the_bar_in_one_step(hand: PaintingHand) -> None:
    ramp = ["#000", "#f00", "#000", "#00f", "#fff"]
    give(hand, ramp)
    before = hand.scene

    def place(share: float) -> tuple[float, float]:
        return STRIP.left + share * (STRIP.width - 1), STRIP.top + 5

    hand.drag(place(0.27), place(0.5), place(0.7))
    # The second color is where it was dropped; below and above it, the ramp is stretched and shortened.
    assert ramp_of(hand) == ((0, 0, 0), (85, 0, 0), (170, 0, 0), (255, 0, 0), (255, 255, 255))
    assert hand.message == "swatches are for color 4 of 5"
    assert bar_is_right(hand)
    hand.pick(" ", 0.1)
    assert hand.scene is before
    # The way there does not matter, and an end can be dragged, too.
    hand.drag(place(0.27), place(1), place(0), place(0.27))
    assert hand.scene.equals(before)
    hand.drag(place(1), place(0.5))
    assert ramp_of(hand)[2:] == ((255, 255, 255),) * 3
    hand.leave()
    assert recent_colors() == ()


def test_colors_are_added_between_two_and_removed_down_to_two(hand: PaintingHand) -> None:
    give(hand, ["#000", "#f60", "#fff"])
    hand.pick("ramp bar", 0.1)
    hand.pick("add color")
    assert ramp_of(hand) == ((0, 0, 0), (128, 51, 0), (255, 102, 0), (255, 255, 255))
    assert hand.message == "swatches are for color 2 of 4"
    for rest in (((0, 0, 0), (255, 102, 0), (255, 255, 255)), ((0, 0, 0), (255, 255, 255))):
        hand.pick("remove color")
        assert ramp_of(hand) == rest
    hand.pick("remove color")
    assert hand.message == "remove color: a ramp has at least 2 colors; to have none, switch the ramp off"
    for _ in range(3):
        hand.pick(" ", 0.1)
    assert len(ramp_of(hand)) == 3
    # Undo may shorten the ramp below the chosen color.
    hand.pick(" ", 0.1)
    assert hand.paint == PAINTS[0]
    change_paint(hand.viewer.session, ramp=[(number % 256, number // 4, 0) for number in range(1024)])
    hand.move(300, 440)
    hand.pick("add color")
    assert hand.message == "add color: a ramp has at most 1,024 colors; remove a color first"


def test_a_finish_replaces_a_ramp_and_another_surface_takes_it(hand: PaintingHand) -> None:
    give(hand, ["#000", "#f60", "#fff"])
    hand.viewer.session.choose_surface("box 1")
    take_paint(hand.viewer.session, "box 0")
    assert hand.message == (
        "box 1: the paint of box 0; undo goes back; the ramp replaces its two colors and their blend"
    )
    assert hand.paint == Paint(ramp=((0, 0, 0), (255, 102, 0), (255, 255, 255)))
    hand.pick("metal")
    assert hand.message == "box 1: metal; two colors and their blend replace its ramp"
    assert hand.paint.object_color == (255, 102, 0)


@pytest.mark.parametrize(("count", "levels"), [(1, None), (2, 1005)])
def test_a_surface_that_owns_nearly_all_words_is_at_most_a_level_off(
    tmp_path: Path, count: int, levels: int | None
) -> None:
    hand = mixing(boxes_scene(count, levels), tmp_path)
    assert hand.viewer.studio.level_ranges["box 0"].levels >= 1005
    words = crop(hand).of(hand.viewer.studio.words).astype(int)
    is_own = has_surface(hand, words)
    seen = hand.words(crop(hand).area).astype(int)
    assert np.abs(seen - words)[is_own].max() <= 1
    # So its colors are those of the picture, or of the neighboring level.
    entries = hand.viewer.studio.entries
    assert np.array_equal(hand.colors(crop(hand).area)[is_own], entries[seen[is_own]])
    assert shades_are_right(hand)
    assert bar_is_right(hand, most_off=1)
    hand.leave()
    assert hand.shows(hand.scene)


@pytest.mark.parametrize(
    ("bar", "typed", "refusal"),
    [
        ("light source, white", "-1", "white must be a whole number from 0 to 255, not -1; type another"),
        ("object, hue", "361", "hue must be a number from 0 to 360, not 361; type another"),
    ],
)
def test_a_number_that_is_typed_must_be_in_its_range(
    hand: PaintingHand, bar: str, typed: str, refusal: str
) -> None:
    scene = hand.scene
    hand.move(ZERO + 100, hand.middle(bar)[1])
    hand.type(typed)
    hand.press("return")
    assert hand.message == refusal
    assert hand.scene is scene


def test_pointing_at_the_picture_tells_the_level_or_the_other_surface(hand: PaintingHand) -> None:
    first, levels = hand.viewer.studio.level_ranges["box 0"]
    element, line = place_in_picture(hand, "box 0")
    word, hint = int(hand.display.words[line, element]), hand.viewer.board.content.hint
    assert hint(element, line) == f"box 0, level {word - first} of {levels - 1}"
    there = place_in_picture(hand, "box 1")
    assert hint(*there) == "box 1: click to mix its colors; P: take its paint"
    assert hint(PICTURE.left, PICTURE.top) == hand.viewer.board.screen.help
    hand.click(*there)
    assert hand.viewer.session.surface_name == "box 1"
    assert hand.message == "surface box 1"


def test_a_scene_without_surfaces_in_use_says_so(tmp_path: Path) -> None:
    empty = scene_of(Mesh(np.zeros((0, 3)), np.zeros((0, 4), int)), name="empty")
    hand = mixing(empty, tmp_path)
    assert [row.label for row in hand.viewer.board.content.rows()] == []
    hand.press("p")
    hand.click(30, 60)
    hand.leave()
    assert hand.shows(empty)


@pytest.mark.parametrize("color", first(1, [(176, 16, 32), (3, 1, 2), (255, 255, 254)]))
@pytest.mark.parametrize("bar", ["saturation", "value"])
def test_a_color_that_passes_through_gray_or_black_keeps_its_hue(
    hand: PaintingHand, color: Color, bar: str
) -> None:
    change_paint(hand.viewer.session, object_color=color)
    line = hand.middle(f"object, {bar}")[1]
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


def test_the_unit_takes_the_paint_of_a_surface_that_it_picks_in_the_whole_picture(hand: PaintingHand) -> None:
    before, entries = hand.scene, hand.viewer.studio.entries
    hand.pick("take paint")
    assert hand.message == "pick a surface: box 0 takes both its colors, blend and percentage; Esc ends"
    # The picture is seen in its own colors.
    shown = crop_of(np.ones(hand.viewer.studio.words.shape, np.bool_), WORK)
    assert np.array_equal(hand.words(shown.area), shown.of(hand.viewer.studio.words))
    assert np.array_equal(hand.display.entries, entries)
    there = place_in_picture(hand, "box 1")
    told = "pick the paint of box 1: #1e5ac8 and #ffffff, blend 0.70; Esc ends"
    assert hand.viewer.board.content.hint(*there) == told
    hand.click(*there)
    assert hand.paint == PAINTS[1]
    assert hand.message == "box 0: the paint of box 1; undo goes back"
    assert shades_are_right(hand)
    assert bar_is_right(hand)
    hand.pick(" ", 0.1)
    assert hand.scene is before


def test_the_unit_takes_a_color_as_it_is_seen(hand: PaintingHand) -> None:
    hand.pick("section.light source")
    hand.pick("take color")
    wanted = "its color as you see it becomes the light source color; Esc ends"
    assert hand.message == f"pick a pixel: {wanted}"
    element, line = place_in_picture(hand, "box 1")
    red, green, blue = hand.colors(Area(element, line, element, line))[0, 0].tolist()
    digits = in_digits((red, green, blue))
    hint = hand.viewer.board.content.hint(element, line)
    assert hint == f"pick {digits} of box 1 as the light source color; Esc ends"
    hand.click(element, line)
    assert hand.paint.light_color == (red, green, blue)
    assert hand.message == f"light source: {digits}"
    assert shades_are_right(hand)


def test_taking_ends_without_a_pick_and_goes_on_after_a_refused_pick(hand: PaintingHand) -> None:
    scene = hand.scene
    for end in (lambda: hand.pick("take paint"), lambda: hand.press("escape"), hand.leave):
        hand.pick("take paint")
        end()
        hand.turn_to("color mixing")
        assert shades_are_right(hand)
    hand.pick("take paint")
    hand.click(20, 60)
    assert hand.message.startswith("no surface is there; pick a surface")
    hand.click(*place_in_picture(hand, "box 0"))
    assert hand.message.startswith("box 0 is the chosen surface")
    assert hand.scene is scene
    hand.click(*place_in_picture(hand, "box 1"))
    assert hand.paint == PAINTS[1]


def test_a_color_is_copied_and_pasted_over_its_section_and_elsewhere_as_the_chosen_color(
    hand: PaintingHand,
) -> None:
    held = [""]

    def copy(text: str) -> bool:
        held.append(text)
        return True

    hand.viewer.session.clipboard = Clipboard(copy, lambda: held[-1])
    number = hand.widget("number.light source").area[:2]
    places = [(400, 26), (30, 40), number, (400, 166), (300, 300)]
    for place, color in zip(places, ["#fffaf0"] * 3 + ["#b01020"] * 2, strict=True):
        hand.move(*place)
        hand.press("Ctrl+C")
        assert held[-1] == color
        assert hand.message == f"copied {color}"
    held.append(" teal\0\nmore")
    hand.move(400, 26)
    hand.press("Ctrl+V")
    assert hand.paint == PAINTS[0].replace(light_color="teal")
    # The color that was pasted last is the chosen color elsewhere.
    hand.move(300, 300)
    held.append("rgb(1, 2, 3)\r\n")
    hand.press("Ctrl+V")
    assert hand.paint == PAINTS[0].replace(light_color=(1, 2, 3))
    assert shades_are_right(hand)


# If the screen changes on purpose, look at it, and copy the new numbers from the failure.
DRAWN = {"mixing": 2910458585, "ramp": 3549769999, "paints": 2777558589}


def test_the_screens_of_paints_are_drawn_as_they_were(hand: PaintingHand) -> None:
    found = {}

    def note(name: str) -> None:
        hand.viewer.tell("")
        found[name] = drawing_on(hand.display)

    note("mixing")
    hand.pick("ramp", 0.95)
    hand.pick("ramp bar", 0.1)
    note("ramp")
    undo(hand.viewer.session)
    names = Palette(["#a52019", "#f8f32b"], ["Signal red", "Teal"])
    hand.viewer.session.paints, hand.viewer.session.paints_name = names, "paints.gpl"
    note("paints")
    assert found == DRAWN
