from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Palette, write_palette
from autocolor.checks import Color
from autocolor.files.state import recent_colors
from autocolor.scene.kinds import in_digits
from autocolor.scene.swatches import COLUMNS, ROWS, swatches
from autocolor.screens.keys import paste_text
from autocolor.screens.surface.paint_choices import SwatchField
from autocolor.screens.surface.painting import change_paint
from autocolor.widgets.items import Area
from autocolor.widgets.widget import Choice, Place
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.mixing import ZERO, bar_is_right, mixing, shades_are_right
from tests.autocolor.screens.painting_hand import PaintingHand, boxes_scene
from tests.autocolor.widgets.drawing import draw_items
from tests.tables import first


@pytest.fixture
def hand(tmp_path: Path) -> PaintingHand:
    return mixing(boxes_scene(), tmp_path)


def paint_place(hand: PaintingHand, number: int) -> Place:
    """The middle of the cell of a paint in the menu, counted row by row."""
    field = hand.widget("paints")
    assert isinstance(field, SwatchField)
    down, across = divmod(number, field.across)
    left = field.area.left + (field.area.width - field.across * field.width) // 2
    middle = left + field.width * across + field.width // 2 - 1
    return Place(middle, field.area.top + field.height * down + field.height // 2 - 1)


def color_of_paint(hand: PaintingHand, number: int) -> Color:
    """The color that the display shows for a paint."""
    red, green, blue = hand.display.field()[paint_place(hand, number)[::-1]].tolist()
    return red, green, blue


def swatch_place(hand: PaintingHand, shade: int, hue: int) -> Place:
    """The middle of the cell of a swatch: a row has the shades of a hue."""
    return paint_place(hand, ROWS * hue + shade)


def test_a_swatch_is_a_paint_for_the_chosen_color(hand: PaintingHand) -> None:
    hand.click(*swatch_place(hand, 4, 3))
    assert hand.paint.object_color == tuple(swatches()[4 * COLUMNS + 3])
    hand.pick("section.light source")
    hand.click(*swatch_place(hand, 0, 19))
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])
    # A click on the shades chooses, too.
    hand.click(30, 160)
    hand.drag(swatch_place(hand, 0, 0), swatch_place(hand, 1, 2))
    assert hand.paint.object_color == tuple(swatches()[COLUMNS + 2])
    assert hand.paint.light_color == tuple(swatches()[COLUMNS - 1])


def test_every_swatch_is_shown_in_its_color(hand: PaintingHand) -> None:
    field = hand.display.field()
    for number, color in enumerate(swatches()):
        assert (field[swatch_place(hand, *divmod(number, COLUMNS))[::-1]] == color).all()
    assert shades_are_right(hand)
    assert bar_is_right(hand)


def test_mixed_colors_are_recent_colors_when_the_mixing_ends(hand: PaintingHand) -> None:
    hand.click(ZERO + 99, hand.middle("object, green")[1])
    hand.click(ZERO + 100, hand.middle("object, green")[1])
    hand.click(ZERO + 99, hand.middle("object, blue")[1])
    hand.pick(" ", 0.1)
    assert recent_colors() == ()
    hand.leave()
    # An undone color is none of them.
    assert recent_colors() == ((176, 100, 32),)
    hand.turn_to("color mixing")
    # Another surface takes it over.
    hand.pick("surface")
    recent = hand.widget("recent colors").area
    place = swatch_place(hand, 0, 0).element, recent.top + 4
    assert (hand.colors(Area(*place, *place)) == [176, 100, 32]).all()
    hand.click(*place)
    assert hand.paint.object_color == (176, 100, 32)
    # Choosing another surface ends the mixing.
    hand.click(ZERO + 99, hand.middle("light source, green")[1])
    hand.pick("surface")
    assert (255, 99, 255) in recent_colors()


def test_a_mixed_color_of_a_ramp_is_a_recent_color_and_the_others_are_not(hand: PaintingHand) -> None:
    change_paint(hand.viewer.session, ramp=["#100", "#200", "#300", "#400"])
    hand.pick("ramp bar", 0.3)
    hand.pick("add color")
    hand.click(ZERO + 102, hand.middle("color 3, red")[1])
    hand.click(ZERO + 99, hand.middle("color 3, green")[1])
    hand.pick("surface")
    assert recent_colors() == ((102, 99, 0),)


FILE = "paints.gpl"
FEW = Palette(["#a52019", "#f8f32b", "#a52019", "#0e294b"], ["Signal red", "Teal", "Old red", ""])
MANY = Palette([(number // 256, number % 256, 9) for number in range(430)], map(str, range(430)))


def bring(hand: PaintingHand, paints: Palette) -> None:
    """Open a palette file as it is opened when it is dropped on the window."""
    folder = hand.viewer.session.folder
    write_palette(folder / FILE, paints, overwrite=True)
    hand.viewer.on_drop(folder / FILE)


@pytest.mark.parametrize("paints", first(1, [FEW, MANY]))
def test_the_paints_of_a_file_come_before_the_swatches(hand: PaintingHand, paints: Palette) -> None:
    scene = hand.scene
    hand.leave()
    bring(hand, paints)
    assert hand.viewer.page == "mixing"
    assert hand.message == f"{len(paints)} paints of paints.gpl: take them in color mixing"
    seen = []
    while (page := hand.widget("page")) and isinstance(page, Choice):
        if page.present == f"{len(page.names)} of {len(page.names)}":
            break
        field = hand.widget("paints")
        assert isinstance(field, SwatchField)
        seen += [color_of_paint(hand, number) for number in range(len(field.words))]
        hand.pick("page")
    assert seen == [*paints.colors]
    # The last page has the swatches, and new paints begin with their first page.
    assert color_of_paint(hand, 0) == tuple(swatches()[0])
    assert hand.scene is scene
    bring(hand, FEW)
    assert color_of_paint(hand, 0) == (165, 32, 25)
    hand.viewer.on_pointer(*paint_place(hand, 0), "wheel up")
    assert hand.message == "object: Signal red, #a52019"


def test_the_name_of_a_paint_is_shown_under_the_pointer_and_when_it_is_taken(hand: PaintingHand) -> None:
    bring(hand, FEW)
    hand.viewer.tell("")
    for number, paint in ((3, "#0e294b"), (2, "Old red, #a52019")):
        hand.move(*paint_place(hand, number))
        assert hand.hint == f"{paint}: click it for the object color"
    hand.click(*paint_place(hand, 2))
    assert hand.message == "object: Old red, #a52019"
    assert hand.paint.object_color == (165, 32, 25)
    hand.pick("section.light source")
    hand.click(*paint_place(hand, 3))
    assert hand.message == "light source: #0e294b"
    assert hand.paint.light_color == (14, 41, 75)


def test_keys_take_paint_after_paint_although_some_have_one_color(hand: PaintingHand) -> None:
    bring(hand, FEW)
    hand.press("tab")
    while (lit := hand.viewer.board.lit) is None or lit.key != "paints":
        hand.press("down")
    taken = []
    for key in ("right", "right", "right", "right", "right", "left", "left"):
        hand.press(key)
        taken.append(hand.message.removeprefix("object: "))
    red, teal, old, blue = "Signal red, #a52019", "Teal, #f8f32b", "Old red, #a52019", "#0e294b"
    assert taken == [red, teal, old, blue, red, blue, old]
    # The last paint is before a color that no paint has.
    while hand.viewer.studio.history.to_undo:
        hand.press("Ctrl+Z")
    hand.press("left")
    assert hand.message == "object: #0e294b"


def test_a_name_that_is_typed_or_pasted_is_a_paint_before_it_is_a_color_of_css(hand: PaintingHand) -> None:
    board, yellow = hand.viewer.board, (248, 243, 43)
    for name, color in (("teal", (0, 128, 128)), ("TEAL", yellow), ("navy", (0, 0, 128))):
        hand.pick("number.light source")
        board.typing.insert(name)
        hand.press("return")
        assert hand.paint.light_color == color
        bring(hand, FEW)
    hand.click(30, 160)
    paste_text(board, "old red")
    assert hand.paint.object_color == (165, 32, 25)
    hand.leave()
    paste_text(board, "teal")
    assert hand.paint.object_color == yellow


def test_the_key_of_the_next_color_goes_through_the_paints(hand: PaintingHand) -> None:
    bring(hand, FEW)
    red, teal, blue, own = "Old red, #a52019", "Teal, #f8f32b", "#0e294b", in_digits(hand.paint.object_color)
    messages = []
    for key in ("c", "c", "c", "c", "Shift+C", "Shift+C", "Shift+C", "Shift+C"):
        hand.press(key)
        messages.append(hand.message.removeprefix("object color "))
    assert messages == [red, teal, blue, own, blue, teal, red, own]
    # A color that came from elsewhere is followed by the first.
    change_paint(hand.viewer.session, object_color="#654321")
    hand.press("c")
    assert hand.message == f"object color {own}"


def test_paints_that_cannot_be_read_leave_those_before(hand: PaintingHand) -> None:
    bring(hand, FEW)
    path = hand.viewer.session.folder / "bad.gpl"
    path.write_text("GIMP Palette\n1 2 3\n1 2\n")
    hand.viewer.on_drop(path)
    assert hand.message.startswith("bad.gpl, line 3")
    assert hand.viewer.session.paints == FEW


@pytest.mark.parametrize("count", [1, 5, 7, 20])
def test_a_pick_or_a_drag_takes_the_cell_that_is_shown_there_and_nothing_beside(count: int) -> None:
    area, found, display = Area(176, 312, 255, 367), list[int](), Ramtek9300()
    words = np.arange(100, 100 + count, dtype=np.uint16)
    field = SwatchField("paints", words=words, across=5, width=16, height=14, take=found.append, area=area)
    draw_items(display, field.items(lit=False))
    for down, line in enumerate(range(area.top - 14, area.bottom + 15, 14), start=-1):
        for across, element in enumerate(range(area.left - 16, area.right + 17, 16), start=-1):
            number = 5 * down + across
            is_there = 0 <= across < 5 and 0 <= number < count
            assert (display.words[line, element] == 100 + number) == is_there
            for act in (field.pick, lambda place: field.drag(Place(180, 315), Place(180, 315), place)):
                for place in (Place(element, line), Place(element + 15, line + 13)):
                    found.clear()
                    act(place)
                    assert found == ([number] if is_there else [])
