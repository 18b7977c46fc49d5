from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Paint, scene_of
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.files.state import recent_colors
from autocolor.mapping.colors import blend_level
from autocolor.mapping.ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.scene.swatches import COLUMNS, FINISHES, finished, swatches
from autocolor.screens.mixing_screen import (
    LIGHT_SOURCE,
    OBJECT,
    RAMP_STEPS,
    RECENT,
    SCALE,
    SMALL,
    SWATCH_LINES,
    SWATCHES,
    ColorSection,
    MixingScreen,
    Palette,
    Ranges,
    SwatchField,
    palette_of,
    ramp_of,
    whole,
)
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import ComponentBar
from autocolor.widgets.items import BLUE, GREEN, NIGHT, RED, WHITE, Area
from autocolor.widgets.widget import Place
from ramtek_emu import Ramtek9300
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
        assert hand.viewer.message.startswith("undone: ")
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


def test_sixty_surfaces_are_chosen_in_turn(tmp_path: Path) -> None:
    hand = mixing(boxes_scene(60), tmp_path)
    for number in range(1, 61):
        hand.choose("surface", f"box {number % 60}")
        assert hand.viewer.session.surface_name == f"box {number % 60}"
    assert ramps_are_right(hand)
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


PAINT = Paint((10, 20, 31), (255, 0, 0))


@pytest.fixture
def viewer(tmp_path: Path) -> Viewer:
    return Viewer(boxes_scene(), Ramtek9300(), tmp_path)


def section_of(viewer: Viewer, title: str, given: list[object]) -> ColorSection:
    return ColorSection(
        viewer.session, title, 100, give=lambda section, color: given.append((section.title, color)),
        choose=lambda section: given.append(section.title),
    )  # fmt: skip


@pytest.mark.parametrize(("title", "values"), [(OBJECT, [10, 20, 31, 20]), (LIGHT_SOURCE, [255, 0, 0, 85])])
def test_it_has_a_heading_and_a_bar_for_each_component_and_for_white(
    viewer: Viewer, title: str, values: list[int]
) -> None:
    heading, *bars = section_of(viewer, title, []).widgets(PAINT, is_chosen=False)
    assert heading.label == title
    assert all(isinstance(bar, ComponentBar) for bar in bars)
    found = [(bar.letter, bar.word, bar.value) for bar in bars if isinstance(bar, ComponentBar)]
    assert found == list(zip("RGBW", (RED, GREEN, BLUE, WHITE), values, strict=True))


def test_bars_and_ramp_stand_beside_each_other_without_overlapping(viewer: Viewer) -> None:
    section = section_of(viewer, OBJECT, [])
    widgets = section.widgets(PAINT, is_chosen=True)
    areas = [section.ramp, *(each.area for each in widgets)]
    for number, area in enumerate(areas):
        assert not any(area.overlaps(other) for other in areas[number + 1 :])
    assert (section.ramp.top, section.ramp.bottom) == (widgets[1].area.top, widgets[-1].area.bottom)


def test_a_component_is_put_into_the_color_that_the_surface_has_now(viewer: Viewer) -> None:
    given: list[object] = []
    bars = section_of(viewer, OBJECT, given).widgets(PAINT, is_chosen=True)[1:]
    assert isinstance(bars[1], ComponentBar)
    bars[1].put(99.0)
    assert given == [(OBJECT, (176, 99, 32))]


def test_a_pick_on_the_heading_chooses_the_color(viewer: Viewer) -> None:
    given: list[object] = []
    section = section_of(viewer, OBJECT, given)
    heading, *_ = section.widgets(PAINT, is_chosen=False)
    heading.pick(Place(10, 104))
    assert given == [OBJECT]


def test_the_heading_and_the_row_have_different_keys(viewer: Viewer) -> None:
    for title in (OBJECT, LIGHT_SOURCE):
        section = section_of(viewer, title, [])
        keys = [each.key for each in (*section.widgets(PAINT, is_chosen=False), section.row(PAINT))]
        assert len(set(keys)) == len(keys)


def test_the_row_takes_the_typed_text_unchanged(viewer: Viewer) -> None:
    given: list[object] = []
    row = section_of(viewer, LIGHT_SOURCE, given).row(PAINT)
    assert (row.label, row.value) == ("light", "#ff0000")
    row.take("teal")
    assert given == [(LIGHT_SOURCE, "teal")]


def test_the_ramp_rises_to_the_right_from_the_first_step_to_the_last(viewer: Viewer) -> None:
    display = Ramtek9300()
    section = section_of(viewer, OBJECT, [])
    ramp = np.arange(300, 364, dtype=np.uint16)
    for item in section.items(ramp):
        display.send(np.frombuffer(item.stream, np.uint16))
    line = display.words[section.ramp.top, section.ramp.left : section.ramp.right + 1]
    assert set(np.bincount(line)[301:363].tolist()) <= {2, 3}
    assert line.tolist() == sorted(line.tolist())
    assert (line[0], line[-1]) == (300, 363)


@pytest.mark.parametrize("value", [-1, 256, 0.5, float("inf"), float("nan")])
def test_a_value_that_is_no_component_is_refused(value: float) -> None:
    with pytest.raises(UsageError) as told:
        whole("green", value)
    assert str(told.value) == f"green must be a whole number from 0 to 255, not {value:g}; type another"


COMPONENTS = st.integers(0, 255)
COLORS = st.tuples(COMPONENTS, COMPONENTS, COMPONENTS)

ALONE: Ranges = (("body", LevelRange(1, 1007)),)
LARGE: Ranges = (("body", LevelRange(1, 1000)), ("glass", LevelRange(1001, 7)))
TWO_RANGES: Ranges = (("glass", LevelRange(1, 600)), ("body", LevelRange(601, 407)))


@given(COLORS)
def test_step_k_of_a_ramp_is_k_of_63_parts_of_the_color_rounded_half_up(color: Color) -> None:
    expected = [[(2 * part * step + 63) // 126 for part in color] for step in range(64)]
    assert ramp_of(color).tolist() == expected


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
@pytest.mark.parametrize("swatches", [0, 12, 200])
def test_all_words_differ_and_none_is_of_the_background_of_the_screens_or_shown(
    ranges: Ranges, swatches: int
) -> None:
    palette = palette_of(ranges, "body", swatches)
    words = np.concatenate([palette.light_ramp, palette.object_ramp, palette.swatches])
    assert len(palette.light_ramp) == len(palette.object_ramp) == RAMP_STEPS
    assert len(palette.swatches) == swatches
    assert len(set(words.tolist())) == len(words)
    assert words.min() > BACKGROUND
    assert words.max() < SCREENS.first
    own = dict(ranges)["body"]
    assert not np.isin(words, palette.shown[own.first : own.last + 1]).any()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
def test_the_surface_is_shown_by_its_own_words_or_their_neighbors_and_the_others_by_the_ground(
    ranges: Ranges,
) -> None:
    palette = palette_of(ranges, "body", 200)
    levels = dict(ranges)["body"]
    own = np.arange(levels.first, levels.last + 1)
    off = np.abs(palette.shown[levels.first : levels.last + 1].astype(int) - own)
    assert off.max() == (0 if ranges is TWO_RANGES else 1)
    assert (np.delete(palette.shown, own) == NIGHT).all()


@pytest.mark.parametrize("ranges", [ALONE, LARGE, TWO_RANGES])
def test_loads_put_each_color_into_its_word(ranges: Ranges) -> None:
    palette = palette_of(ranges, "body", 12)
    swatches = np.random.default_rng(1).integers(0, 256, (12, 3)).astype(np.uint8)
    table = np.full((1024, 3), 7, np.uint8)
    for first, colors in palette.loads((200, 100, 50), (1, 2, 3), swatches):
        table[first : first + len(colors)] = colors
    assert np.array_equal(table[palette.light_ramp], ramp_of((200, 100, 50)))
    assert np.array_equal(table[palette.object_ramp], ramp_of((1, 2, 3)))
    assert np.array_equal(table[palette.swatches], swatches)
    assert (np.delete(table, palette.borrowed, axis=0) == 7).all()


def test_words_that_follow_each_other_are_one_load() -> None:
    palette = palette_of(TWO_RANGES, "body", 12)
    assert len(palette.loads((0, 0, 0), (0, 0, 0), np.zeros((12, 3), np.uint8))) == 1


def test_equal_surfaces_have_the_same_palette() -> None:
    palette = palette_of(TWO_RANGES, "body", 12)
    assert isinstance(palette, Palette)
    assert palette_of(tuple(TWO_RANGES), "body", 12) is palette


def test_a_swatch_is_a_paint_for_the_chosen_color(hand: PaintingHand) -> None:
    hand.pick("swatches")
    hand.click(SWATCHES.left + 16 * 3 + 4, SWATCHES.top + SWATCH_LINES * 4 + 4)
    assert hand.paint.object_color == tuple(swatches()[4 * COLUMNS + 3])
    hand.pick("light source heading")
    hand.click(SWATCHES.left + 16 * 19 + 4, SWATCHES.top + 4)
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])
    # A click on the ramp chooses, too.
    hand.click(30, 220)
    hand.drag((SWATCHES.left + 4, SWATCHES.top + 4), (SWATCHES.left + 40, SWATCHES.top + 20))
    assert hand.paint.object_color == tuple(swatches()[COLUMNS + 2])
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])


def test_every_swatch_is_shown_in_its_color(hand: PaintingHand) -> None:
    hand.pick("swatches")
    for number, color in enumerate(swatches()):
        row, column = divmod(number, COLUMNS)
        left, top = SWATCHES.left + 16 * column, SWATCHES.top + SWATCH_LINES * row
        cell = Area(left, top, left + 14, top + SWATCH_LINES - 2)
        assert (hand.colors(cell) == color).all()
    assert ramps_are_right(hand)
    assert bar_is_right(hand)


@pytest.mark.parametrize("name", FINISHES)
def test_a_finish_keeps_the_object_color(hand: PaintingHand, name: str) -> None:
    before = hand.viewer.studio.scene.surface("box 0")
    hand.pick(name)
    after = hand.viewer.studio.scene.surface("box 0")
    assert after == before.replace(**finished(before, name))
    assert ramps_are_right(hand)
    assert bar_is_right(hand)


def test_mixed_colors_are_recent_colors_when_the_mixing_ends(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "object, green"))
    hand.click(ZERO + 100, line_of(hand, "object, green"))
    assert recent_colors() == ()
    hand.leave()
    assert recent_colors() == ((176, 100, 32),)
    hand.turn_to("color mixing")
    # Another surface takes it over.
    hand.pick("surface")
    assert (
        hand.colors(Area(RECENT.left, RECENT.top, RECENT.left + 20, RECENT.top + 20)) == [176, 100, 32]
    ).all()
    hand.click(RECENT.left + 5, RECENT.top + 5)
    assert hand.paint.object_color == (176, 100, 32)


def test_an_undone_color_is_no_recent_color(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "object, green"))
    hand.pick(" ", 0.1)
    hand.leave()
    assert recent_colors() == ()


def test_choosing_another_surface_ends_the_mixing(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, line_of(hand, "light source, green"))
    hand.pick("surface")
    assert recent_colors() == ((255, 99, 240),)
    hand.leave()
    assert recent_colors() == ((255, 99, 240),)


AREA = Area(176, 312, 255, 367)


def field_of(count: int, found: list[int] | None = None) -> SwatchField:
    found = [] if found is None else found
    words = np.arange(100, 100 + count, dtype=np.uint16)
    return SwatchField("paints", words=words, across=5, width=16, height=14, take=found.append, area=AREA)


def drawn(field: SwatchField) -> Ramtek9300:
    display = Ramtek9300()
    for item in field.items(lit=False):
        display.send(np.frombuffer(item.stream, np.uint16))
    return display


@pytest.mark.parametrize("count", [1, 5, 7, 20])
def test_a_pick_takes_the_cell_that_is_shown_there(count: int) -> None:
    found: list[int] = []
    field = field_of(count, found)
    words = drawn(field).words
    for line in range(AREA.top, AREA.bottom + 1, 14):
        for element in range(AREA.left, AREA.right + 1, 16):
            before = len(found)
            field.pick(Place(element + 3, line + 3))
            word = int(words[line + 3, element + 3])
            assert found[before:] == ([word - 100] if 100 <= word < 100 + count else [])
    assert found == list(range(count))


def test_nothing_is_drawn_or_taken_beyond_the_cells() -> None:
    found: list[int] = []
    field = field_of(20, found)
    lines, elements = np.nonzero(drawn(field).words)
    assert AREA.covers(Area(elements.min(), lines.min(), elements.max(), lines.max()))
    for place in ((175, 320), (256, 320), (200, 311), (200, 368)):
        field.drag(Place(200, 320), Place(200, 320), Place(*place))
    assert found == []


def test_a_drag_takes_every_cell_that_it_reaches() -> None:
    found: list[int] = []
    field = field_of(20, found)
    for element in (180, 200, 220):
        field.drag(Place(180, 315), Place(180, 315), Place(element, 330))
    assert found == [5, 6, 7]


def test_without_cells_there_is_nothing() -> None:
    found: list[int] = []
    field = field_of(0, found)
    assert field.items(lit=True) == []
    field.pick(Place(180, 315))
    assert found == []
