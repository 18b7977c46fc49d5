from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor import Flap, Flaps, HalfSpace, Light, View
from autocolor.scene.changes import LightChanges
from autocolor.scene.columns import keys_of
from autocolor.scene.following import detached
from autocolor.screens.lights_screen import LIGHTS_A_PAGE, LightRow, places_of
from autocolor.widgets.items import SCREEN, YELLOW
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Choice
from tests.autocolor.screens.boxes import hand_at, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand
from tests.small import KEY, boxes

BOX = 0.95
"""Where the box of a row is, as a share of its width."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights")


def light_of(hand: Hand, name: str = "key") -> Light:
    return hand.scene.lights[name]


LEFT = HalfSpace("left", (0.3, 0.0, 0.0), (1.0, 0.0, 0.2))
TOP = HalfSpace("top", (0.0, 0.0, 0.8), (0.0, 0.0, -1.0), edge_width=0.2)


@pytest.fixture
def cut_hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights", boxes().with_light("key", half_spaces=(LEFT, TOP)))


ENDLESS = Flap(-math.inf, math.inf)

CLICKS: dict[str, tuple[list[tuple[str, float]], LightChanges]] = {
    "off": ([("on", BOX)], {"on": False}),
    "no cone": ([("cone angle", BOX)], {"cone_angle": None}),
    "a new cone": ([("cone angle", BOX), ("cone angle", BOX)], {"cone_angle": 30.0}),
    "a flap off": ([("flaps x", BOX)], {"flaps": {"x": {"on": False}}}),
    "a new flap": ([("flaps y", BOX)], {"flaps": {"y": ENDLESS}}),
    "a surface": (
        [("only surfaces", BOX), ("  high", BOX)],
        {"links": {"only_surfaces": ["high"]}},
    ),
    "one list after the other": (
        [("only surfaces", BOX), ("except surfac.", BOX)],
        {"links": {"except_surfaces": []}},
    ),
    "a half-space off": ([("left", BOX)], {"half_spaces": {"left": {"on": False}}}),
    "a half-space turned": ([("turn", 0.25)], {"half_spaces": {"left": {"direction": (-1.0, 0.0, -0.2)}}}),
    "a half-space removed": ([("turn", 0.75)], {"half_spaces": (TOP,)}),
}


@pytest.mark.parametrize("case", CLICKS)
def test_clicks_set_a_parameter_alone(cut_hand: Hand, case: str) -> None:
    clicks, changes = CLICKS[case]
    hand, before = cut_hand, cut_hand.scene
    for label, share in clicks:
        hand.pick(label, share)
    assert light_of(hand) == before.with_light("key", **changes).lights["key"]
    assert words_are_those_of_the_scene(hand)
    for _ in clicks:
        undo(hand)
    assert hand.scene is before


def test_every_parameter_of_a_light_has_a_row(hand: Hand) -> None:
    session = hand.viewer.session
    session.edit(
        session.scene.with_light("key", half_spaces={"left": {"point": (0, 0, 0), "direction": (0, 0, 1)}})
    )
    labels = [row.label for row in hand.viewer.board.content.rows()]
    # Long words are shortened.
    names = {key.replace("_", " ").replace("surfaces", "surfac") for key in keys_of(Light)} - {"direction"}
    for name in names:
        assert any(label.replace("surfaces", "surfac").startswith(name) for label in labels), name
    assert {"left", "left width"} <= set(labels)
    hand.pick("kind")
    labels = [row.label for row in hand.viewer.board.content.rows()]
    assert {"direction x", "direction y", "direction z"} <= set(labels)


def test_a_point_source_has_neither_cone_nor_concentration_and_says_why(hand: Hand) -> None:
    hand.pick("kind")
    assert light_of(hand).direction == pytest.approx(KEY.axis)
    hand.pick("kind")
    light = light_of(hand)
    assert (light.aim, light.direction, light.cone_angle, light.concentration) == (None, None, None, 0)
    before = hand.scene
    hand.pick("cone angle", BOX)
    assert told(hand) == ("cone angle: a point source has no axis; choose the kind aim first", True)
    hand.pull("concentration", 0.2, 0.8)
    assert hand.scene is before
    hand.pick("kind")
    assert light_of(hand).aim == (0.5, 0.5, 0.5)


def chosen(hand: Hand) -> str:
    """The name of the chosen light, as its row tells it."""
    row = hand.widget("light")
    assert isinstance(row, Choice)
    return row.present


@pytest.mark.parametrize(
    ("label", "share", "name", "message"),
    [
        ("add", 0.25, "light", "light added: light"),
        ("add", 0.75, "key 2", "light key copied: key 2"),
        ("mirror", 0.25, "key mirrored", "light key mirrored along x: key mirrored"),
    ],
)
def test_a_light_is_added_and_chosen(hand: Hand, label: str, share: float, name: str, message: str) -> None:
    before = hand.scene
    hand.pick(label, share)
    assert [light.name for light in hand.scene.lights] == ["key", "fill", name]
    assert told(hand) == (message, False)
    assert chosen(hand) == name
    if label == "mirror":
        # On the other side of the object.
        assert light_of(hand, name).position == (-1, -3, 4)
    hand.pull("intensity", 0.2, 0.4)
    assert light_of(hand) == KEY
    undo(hand)
    undo(hand)
    assert hand.scene is before


def test_a_light_is_renamed_to_a_name_that_is_free(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    for name in ("fill", "light"):
        hand.pick("name")
        hand.type(name)
        hand.press("return")
        assert told(hand)[1] == (name == "fill")
        hand.press("escape")
        hand.viewer.session.turn_to("lights")
    assert [light.name for light in hand.scene.lights] == ["light", "fill"]
    assert chosen(hand) == "light"
    hand.pick("mirror", 0.75)
    assert told(hand) == ("light removed; undo brings it back", False)


def test_lights_are_removed_to_the_last_and_added_again(hand: Hand) -> None:
    hand.pick("mirror", 0.75)
    assert told(hand) == ("light key removed; undo brings it back", False)
    hand.pick("mirror", 0.75)
    assert not hand.scene.lights
    assert [row.label for row in hand.viewer.board.content.rows()] == ["add a light"]
    hand.pick("add a light")
    assert [light.name for light in hand.scene.lights] == ["light"]


def plane(cut_hand: Hand) -> HalfSpace:
    return next(each for each in light_of(cut_hand).half_spaces if each.name == "left")


def test_a_half_space_that_is_carried_from_now_on_stays_where_it_is(cut_hand: Hand) -> None:
    words = cut_hand.viewer.studio.words.copy()
    cut_hand.pick("left carried", BOX)
    assert plane(cut_hand).carried
    placed = detached(plane(cut_hand), light_of(cut_hand))
    assert placed.point == pytest.approx(LEFT.point)
    assert placed.direction == pytest.approx(LEFT.direction)
    assert (cut_hand.viewer.studio.words != words).mean() < 1e-3
    cut_hand.pick("left carried", BOX)
    assert not plane(cut_hand).carried
    assert plane(cut_hand).point == pytest.approx(LEFT.point)


def test_the_edge_of_a_half_space_is_dragged_in_the_picture(cut_hand: Hand) -> None:
    element, line = cut_hand.handle("end of the half-space left of key")
    seen = cut_hand.viewer.studio.seen_at(line, element + 30)
    assert seen is not None
    cut_hand.drag((element, line), (element + 15, line), (element + 30, line))
    moved = plane(cut_hand)
    assert moved.direction == LEFT.direction
    away = [a - b for a, b in zip(seen.point, moved.point, strict=True)]
    assert sum(a * b for a, b in zip(away, moved.direction, strict=True)) == pytest.approx(0, abs=1e-6)
    assert told(cut_hand)[0].startswith("left: x ")


PLACES = [(300, 300), (340, 330), (320, 200)]
"""Elements and lines at which the cube is seen, not in one line."""


def planes_of(hand: Hand) -> tuple[HalfSpace, ...]:
    return hand.scene.lights["key"].half_spaces


def pick_points(hand: Hand, places: list[tuple[int, int]] = PLACES) -> None:
    hand.pick("half spaces")
    for place in places:
        hand.click(*place)


def test_three_points_of_the_object_make_a_half_space_in_one_step(hand: Hand) -> None:
    before = hand.scene
    seen = [hand.viewer.studio.seen_at(line, element) for element, line in PLACES]
    hand.pick("half spaces")
    assert told(hand) == ("pick the first point of the plane on the object; Esc ends", False)
    hand.click(5, WORK.top + 5)
    message = "no point is seen there; pick the first point of the plane on the object; Esc ends"
    assert told(hand) == (message, True)
    hand.click(*PLACES[0])
    assert told(hand) == ("pick the second point of the plane on the object; Esc ends", False)
    hand.click(*PLACES[1])
    assert told(hand) == ("pick the third point of the plane on the object; Esc ends", False)
    assert hand.scene is before
    hand.click(*PLACES[2])
    assert told(hand) == ("half-space added to key: plane", False)
    (plane,) = planes_of(hand)
    for each in seen:
        assert each is not None
        away = np.array(each.point) - plane.point
        assert away @ plane.direction == pytest.approx(0, abs=1e-6)
    assert (plane.on, plane.carried, plane.edge_width) == (True, False, 0)
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.scene is before


def test_the_side_of_the_light_is_lit_in_whatever_order_the_points_are_picked(hand: Hand) -> None:
    pick_points(hand, PLACES)
    pick_points(hand, PLACES[::-1])
    assert [plane.name for plane in planes_of(hand)] == ["plane", "plane 2"]
    for plane in planes_of(hand):
        assert (np.array(light_of(hand).position) - plane.point) @ plane.direction > 0


def test_without_a_light_on_either_side_the_side_of_the_eye_is_lit(hand: Hand) -> None:
    point = hand.viewer.studio.seen_at(PLACES[0][1], PLACES[0][0])
    assert point is not None
    # A light on the plane, and a light from far away that shines away from the eye.
    for changes, sign in (
        ({"position": point.point, "aim": None, "direction": (1, 1, 1)}, 1),
        ({"position": (-2, -3, 2), "aim": None, "direction": (-2, -3, 1), "at_infinity": True}, -1),
    ):
        changed = boxes().with_light("key", cone_angle=None, flaps=Flaps(), half_spaces=(), **changes)
        hand.viewer.session.edit(changed)
        hand.viewer.tell("")
        pick_points(hand)
        (plane,) = planes_of(hand)
        assert sign * ((np.array(hand.scene.view.eye) - plane.point) @ plane.direction) > 0


def leave_and_come_back(hand: Hand) -> None:
    for name in ("mapping", "lights"):
        hand.go_to(name)


ENDINGS: dict[str, Callable[[Hand], object]] = {
    "escape": lambda hand: hand.press("escape"),
    "the row": lambda hand: hand.pick("half spaces"),
    "another screen": leave_and_come_back,
}


@pytest.mark.parametrize("by", ENDINGS)
def test_picking_is_ended_by_escape_its_row_and_another_screen(hand: Hand, by: str) -> None:
    handles = len(hand.viewer.board.content.handles)
    pick_points(hand, PLACES[:2])
    # Nothing else is grabbed meanwhile.
    assert handles > 0 == len(hand.viewer.board.content.handles)
    row = hand.widget("half spaces")
    assert (row.value, row.is_chosen) == ("2/3", True)  # type: ignore[attr-defined]
    ENDINGS[by](hand)
    assert hand.viewer.page == "lights"
    row = hand.widget("half spaces")
    assert (row.value, row.is_chosen) == ("add", False)  # type: ignore[attr-defined]
    hand.click(*PLACES[2])
    assert planes_of(hand) == ()
    assert len(hand.viewer.board.content.handles) == handles


def test_the_picked_points_are_marked_where_they_were_picked(hand: Hand) -> None:
    pick_points(hand, PLACES[:2])
    hand.move(20, 400)
    hand.viewer.tell("")
    for element, line in PLACES[:2]:
        square = hand.display.words[line - 5 : line + 6, element - 5 : element + 6]
        assert (square == YELLOW).any()
    middle = np.mean(PLACES[:2], axis=0).astype(int)
    assert (hand.display.words[middle[1] - 1 : middle[1] + 2, middle[0]] == YELLOW).any()


def test_a_third_point_in_one_line_is_refused_and_picked_again(hand: Hand) -> None:
    pick_points(hand, [PLACES[0], PLACES[1], PLACES[0]])
    message, is_warning = told(hand)
    assert message.startswith("half-space 'plane': its three points must not be in a line")
    assert is_warning
    assert planes_of(hand) == ()
    hand.click(*PLACES[2])
    assert [plane.name for plane in planes_of(hand)] == ["plane"]


def test_points_for_a_light_that_is_gone_are_refused_until_there_is_a_light(hand: Hand) -> None:
    pick_points(hand, PLACES[:2])
    session = hand.viewer.session
    session.edit(session.scene.replace(lights=()))
    for _ in range(2):
        hand.click(*PLACES[2])
        assert told(hand) == ("to have a half-space, there must be a light; add one", True)
    hand.click(5, WORK.top + 5)
    assert told(hand)[0].startswith("no point is seen there; pick the third point")
    session.edit(boxes())
    hand.click(*PLACES[2])
    assert [plane.name for plane in planes_of(hand)] == ["plane"]


# The light list.


def row_of(hand: Hand, name: str) -> LightRow:
    return next(
        each for each in hand.viewer.board.widgets() if isinstance(each, LightRow) and each.label == name
    )


PARTS = {"name": 0.1, "box": 0.452, "bar": 0.66, "solo": 0.95}
"""Where the parts of a row are, as shares of its width."""


def click_at(hand: Hand, name: str, part: str) -> None:
    left, top, right, _ = row_of(hand, name).area
    hand.click(left + PARTS[part] * (right - left), top + 8)


def test_the_list_shows_and_sets_every_light(hand: Hand) -> None:
    before = hand.scene
    fill = row_of(hand, "fill")
    assert (fill.numeral, fill.is_on, fill.value) == (2, True, 0.5)
    assert not fill.is_chosen
    assert not fill.is_solo
    click_at(hand, "fill", "name")
    assert chosen(hand) == "fill"
    assert row_of(hand, "fill").is_chosen
    assert hand.scene is before
    click_at(hand, "fill", "box")
    assert light_of(hand, "fill") == before.lights["fill"].replace(on=False)
    click_at(hand, "key", "bar")
    assert light_of(hand).intensity not in (0, 1, 2)
    assert light_of(hand, "fill").intensity == 0.5
    area = row_of(hand, "fill").area
    hand.move(area.left + 20, area.top + 5)
    hand.type("1.25")
    hand.press("return")
    assert light_of(hand, "fill").intensity == 1.25


def test_a_drag_along_a_bar_of_the_list_is_one_step_and_other_drags_do_nothing(hand: Hand) -> None:
    before, area = hand.scene, row_of(hand, "fill").area
    line = area.top + 8
    starts = {part: area.left + share * (area.right - area.left) for part, share in PARTS.items()}
    hand.drag((starts["bar"], line), (starts["bar"] + 9, line), (area.right + 200, line + 90))
    assert light_of(hand, "fill") == before.lights["fill"].replace(intensity=2.0)
    undo(hand)
    assert hand.scene is before
    for part in ("name", "box", "solo"):
        hand.drag((starts[part], line), (starts[part] + 9, line), (starts[part] + 30, line))
        assert hand.scene is before


def test_a_light_that_is_alone_gives_the_switches_of_all_lights_back(tmp_path: Path) -> None:
    scene = boxes().with_light("key", on=False).with_new_light("rim", position=(0, 0, 9))
    hand = hand_at(tmp_path, "lights", scene)

    def switches() -> list[bool]:
        assert [row_of(hand, light.name).is_on for light in hand.scene.lights] == [
            light.on for light in hand.scene.lights
        ]
        return [light.on for light in hand.scene.lights]

    click_at(hand, "key", "solo")
    assert (switches(), row_of(hand, "key").is_solo) == ([True, False, False], True)
    assert hand.message == "light key alone; again: the lights as before"
    # Alone with another light, and back to the switches before both.
    click_at(hand, "rim", "solo")
    assert (switches(), row_of(hand, "key").is_solo) == ([False, False, True], False)
    click_at(hand, "rim", "solo")
    assert (switches(), row_of(hand, "rim").is_solo) == ([False, True, True], False)
    assert hand.message == "the lights are switched as before"
    undo(hand)
    assert row_of(hand, "rim").is_solo
    # It is no longer alone when another is switched on.
    click_at(hand, "key", "box")
    assert not row_of(hand, "rim").is_solo
    hand.pick("all lights on")
    assert switches() == [True] * 3
    assert hand.message == "all lights on"


def test_the_list_has_pages_shows_the_chosen_light_and_folds(tmp_path: Path) -> None:
    lights = [KEY.replace(name=f"lamp {each}") for each in range(30)]
    hand = hand_at(tmp_path, "lights", boxes().replace(lights=lights))
    names = [each.label for each in hand.viewer.board.widgets() if isinstance(each, LightRow)]
    assert names == [f"lamp {number}" for number in range(LIGHTS_A_PAGE)]
    assert WORK.covers(hand.widget("all lights on").area)
    hand.choose("light", "lamp 25")
    assert row_of(hand, "lamp 25").is_chosen
    assert row_of(hand, "lamp 29").numeral == 30
    hand.pick("page", 0.05)
    click_at(hand, "lamp 13", "name")
    assert row_of(hand, "lamp 13").is_chosen
    hand.pick("light list")
    assert "lamp 13" not in hand.labels
    hand.pick("light list")
    assert row_of(hand, "lamp 13").is_chosen


def test_the_list_covers_handles_which_are_free_when_panels_are_hidden(hand: Hand) -> None:
    place, end = (100, 50), hand.widget("all lights on").area
    # The view is moved until the highlight of the key light is below the list.
    element, line = hand.handle("highlight of key")
    hand.viewer.on_pointer(element + 30, line + 60, "press", 2)
    hand.viewer.on_pointer(place[0] + 30, place[1] + 60, "move")
    hand.viewer.on_pointer(place[0] + 30, place[1] + 60, "release", 2)
    assert not [each for each in hand.viewer.board.content.handles if each.label == "highlight of key"]
    hand.pick("hide panels")
    element, line = hand.handle("highlight of key")
    assert element < end.right
    assert line < end.bottom


def test_points_behind_the_eye_have_no_place() -> None:
    view = View((0.0, -4.0, 0.0), direction=(0.0, 1.0, 0.0))
    points = np.array([(0.0, -9.0, 0.0), (0.0, 0.0, 0.0)])
    assert places_of(points, view).tolist() == [[SCREEN.width / 2 - 0.5, SCREEN.height / 2 - 0.5]]


def test_a_second_click_at_the_heading_of_a_section_picks_no_row_below_it(hand: Hand) -> None:
    files = sorted(hand.viewer.session.folder.iterdir())
    heading = next(row for row in hand.viewer.board.layout.rows if row.label == "add & remove")
    place = heading.area.left + 20, heading.area.top + 5
    for is_open in (True, False):
        hand.click(*place)
        assert ("add" in hand.labels or "more" in hand.labels) == is_open
    assert sorted(hand.viewer.session.folder.iterdir()) == files
