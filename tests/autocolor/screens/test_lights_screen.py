from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor import HalfSpace, Light, Scene, View, read_rig
from autocolor.scene.columns import keys_of
from autocolor.scene.following import detached
from autocolor.scene.lights import Links
from autocolor.screens.light_parameters import AIM, DIRECTION, POINT
from autocolor.screens.lights_screen import (
    LIGHTS_A_PAGE,
    LightList,
    LightRow,
    LightsScreen,
    is_lit_side,
    places_of,
    turned,
)
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import SCREEN, Area
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Button, Place, Widget
from tests.autocolor.screens.boxes import hand_at, hint_of, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand
from tests.small import KEY, boxes

NUMBERS: dict[str, Callable[[Light], object]] = {
    **{f"position {axis}": lambda light, n=n: light.position[n] for n, axis in enumerate("xyz")},  # type: ignore[misc]
    **{f"aim {axis}": lambda light, n=n: light.aim and light.aim[n] for n, axis in enumerate("xyz")},  # type: ignore[misc]
    "intensity": lambda light: light.intensity,
    "concentration": lambda light: light.concentration,
    "cone angle": lambda light: light.cone_angle,
    "x minimum": lambda light: light.flaps.x and light.flaps.x.minimum,
    "x maximum": lambda light: light.flaps.x and light.flaps.x.maximum,
    "z maximum": lambda light: light.flaps.z and light.flaps.z.maximum,
}

BOX = 0.95
"""Where the box of a row is, as a share of its width."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights")


def light_of(hand: Hand, name: str = "key") -> Light:
    return hand.viewer.studio.scene.light(name)


@pytest.mark.parametrize("label", NUMBERS)
def test_a_drag_along_a_number_sets_it_alone_and_is_one_step(hand: Hand, label: str) -> None:
    before = hand.viewer.studio.scene
    hand.pull(label, 0.3, 0.6)
    row = hand.widget(label)
    assert isinstance(row, Bar)
    value = NUMBERS[label](light_of(hand))
    assert value == row.value
    assert 0 < row.share < 1
    assert value != NUMBERS[label](KEY)
    changed = [name for name, get in NUMBERS.items() if get(light_of(hand)) != get(KEY)]
    assert changed == [label]
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_every_parameter_of_a_light_has_a_row(hand: Hand) -> None:
    session = hand.viewer.session
    session.change_light("key", half_spaces={"left": {"point": (0, 0, 0), "direction": (0, 0, 1)}})
    labels = [row.label for row in hand.viewer.board.screen.rows()]
    # Long words are shortened.
    names = {key.replace("_", " ").replace("surfaces", "surfac") for key in keys_of(Light)} - {"direction"}
    for name in names:
        assert any(label.replace("surfaces", "surfac").startswith(name) for label in labels), name
    assert {"left", "left width"} <= set(labels)
    hand.pick("kind")
    labels = [row.label for row in hand.viewer.board.screen.rows()]
    assert {"direction x", "direction y", "direction z"} <= set(labels)


def test_a_wide_bar_sets_a_number_too(hand: Hand) -> None:
    hand.pick("intensity")
    hand.click(300, 450)
    assert 0 < light_of(hand).intensity < 2
    assert light_of(hand).intensity != 1


def test_a_switch_turns_the_light_off_and_on(hand: Hand) -> None:
    hand.pick("on")
    assert not light_of(hand).on
    hand.pick("on")
    assert light_of(hand).on


def test_the_cone_is_switched_off_and_on_again(hand: Hand) -> None:
    hand.pick("cone angle", BOX)
    assert light_of(hand).cone_angle is None
    hand.pick("cone angle", BOX)
    assert light_of(hand).cone_angle == 30


def test_the_inner_angle_goes_with_a_cone_that_becomes_narrower_and_when_it_is_switched_off(
    hand: Hand,
) -> None:
    hand.pick("inner angle", BOX)
    hand.pull("inner angle", 0.2, 0.5)
    assert light_of(hand).inner_angle == pytest.approx(45, abs=3)
    hand.pull("cone angle", 0.6, 0.2)
    narrow = light_of(hand)
    assert narrow.cone_angle is not None
    assert narrow.inner_angle == narrow.cone_angle < 30
    hand.pick("cone angle", BOX)
    assert (light_of(hand).cone_angle, light_of(hand).inner_angle) == (None, None)


def test_flaps_are_made_and_switched_and_keep_their_values(hand: Hand) -> None:
    hand.pick("flaps x", BOX)
    flap = light_of(hand).flaps.x
    assert flap is not None
    assert (flap.minimum, flap.maximum, flap.on) == (-0.5, 1.5, False)
    hand.pick("flaps y", BOX)
    flap = light_of(hand).flaps.y
    assert flap is not None
    assert (flap.minimum, flap.maximum, flap.on) == (-math.inf, math.inf, True)


def test_the_ends_of_a_flap_are_endless_or_begin_where_they_cut_nothing(hand: Hand) -> None:
    words = hand.viewer.studio.words
    hand.pick("x minimum", BOX)
    assert light_of(hand).flaps.x.minimum == -math.inf  # type: ignore[union-attr]
    assert hand.widget("x minimum").number == ""  # type: ignore[attr-defined]
    hand.pick("x minimum", BOX)
    low, high = (corner.tolist()[0] for corner in hand.viewer.studio.scene.mesh.bounds)
    assert low - 0.1 < light_of(hand).flaps.x.minimum < low  # type: ignore[union-attr]
    hand.pick("x maximum", BOX)
    hand.pick("x maximum", BOX)
    assert high < light_of(hand).flaps.x.maximum < high + 0.1  # type: ignore[union-attr]
    assert np.array_equal(hand.viewer.studio.words, words)


def test_a_light_named_light_is_not_called_so_twice(hand: Hand) -> None:
    hand.viewer.session.edit(hand.viewer.studio.scene.with_light("key", name="light"))
    hand.pick("mirror", 0.9)
    assert told(hand) == ("light removed; undo brings it back", False)


def test_a_point_source_has_neither_cone_nor_concentration_and_says_why(hand: Hand) -> None:
    hand.pick("kind")
    assert light_of(hand).direction == pytest.approx(KEY.axis)
    hand.pick("kind")
    light = light_of(hand)
    assert (light.aim, light.direction, light.cone_angle, light.concentration) == (None, None, None, 0)
    before = hand.viewer.studio.scene
    for label in ("cone angle", "concentration"):
        assert hint_of(hand, label) == "a point source has no axis; choose the kind aim first"
        hand.pick(label, BOX)
        assert told(hand) == (f"{label}: a point source has no axis; choose the kind aim first", True)
        hand.pull(label, 0.2, 0.8)
    assert hand.viewer.studio.scene is before
    hand.pick("kind")
    assert light_of(hand).aim == (0.5, 0.5, 0.5)
    assert hand.widget("kind").present == AIM  # type: ignore[attr-defined]


def test_the_kind_goes_back_at_the_left_end_of_its_row(hand: Hand) -> None:
    hand.pick("kind", 0.05)
    assert hand.widget("kind").present == POINT  # type: ignore[attr-defined]
    hand.pick("kind", 0.05)
    assert hand.widget("kind").present == DIRECTION  # type: ignore[attr-defined]


def test_one_light_alone_from_the_menu_of_the_picture(hand: Hand) -> None:
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("alone")
    assert [light.on for light in hand.viewer.studio.scene.lights] == [True, False]


def test_another_light_is_chosen(hand: Hand) -> None:
    hand.pick("light")
    hand.pull("intensity", 0.2, 0.4)
    assert light_of(hand, "fill").intensity != 0.5
    assert light_of(hand) == KEY


@pytest.mark.parametrize(
    ("label", "share", "name", "message"),
    [
        ("add", 0.25, "light", "light added: light"),
        ("add", 0.75, "key 2", "light key copied: key 2"),
        ("mirror", 0.25, "key mirrored", "light key mirrored along x: key mirrored"),
    ],
)
def test_a_light_is_added_and_chosen(hand: Hand, label: str, share: float, name: str, message: str) -> None:
    before = hand.viewer.studio.scene
    hand.pick(label, share)
    assert [light.name for light in hand.viewer.studio.scene.lights] == ["key", "fill", name]
    assert hand.viewer.session.light_name == name
    assert told(hand) == (message, False)
    undo(hand)
    assert hand.viewer.studio.scene is before


def test_a_light_is_mirrored_to_the_other_side_of_the_object(hand: Hand) -> None:
    hand.pick("mirror")
    assert light_of(hand, "key mirrored").position == (-1, -3, 4)


def test_lights_are_removed_to_the_last_and_added_again(hand: Hand) -> None:
    hand.pick("mirror", 0.75)
    assert told(hand) == ("light key removed; undo brings it back", False)
    hand.pick("mirror", 0.75)
    assert not hand.viewer.studio.scene.lights
    assert [row.label for row in hand.viewer.board.screen.rows()] == ["add a light"]
    hand.pick("add a light")
    assert [light.name for light in hand.viewer.studio.scene.lights] == ["light"]


def test_a_light_is_renamed_where_there_is_a_keyboard(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    hand.pick("name")
    for letter in "sun":
        hand.viewer.on_key(letter, typed=letter)
    hand.viewer.on_key("return")
    assert [light.name for light in hand.viewer.studio.scene.lights] == ["sun", "fill"]
    assert hand.viewer.session.light_name == "sun"


def test_a_name_that_is_taken_is_refused(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    hand.pick("name")
    for letter in "fill":
        hand.viewer.on_key(letter, typed=letter)
    hand.viewer.on_key("return")
    message, is_warning = told(hand)
    assert is_warning
    assert "must be unique" in message
    assert light_of(hand) == KEY


def test_a_rig_is_saved_beside_the_rig_before(hand: Hand, tmp_path: Path) -> None:
    hand.pick("save the rig")
    assert told(hand) == ("saved boxes-rig.toml", False)
    hand.pick("save the rig")
    assert told(hand) == ("saved boxes-rig-2.toml", False)
    assert read_rig(tmp_path / "boxes-rig.toml").lights == boxes().lights


def test_sixteen_lights_with_long_names_are_all_reached(tmp_path: Path) -> None:
    lights = [KEY.replace(name=f"studio light above the roof, number {each}") for each in range(16)]
    hand = hand_at(tmp_path, "lights", boxes().replace(lights=lights))
    seen = []
    for light in lights:
        hand.choose("light", light.name)
        seen.append(hand.viewer.session.light_name)
    assert seen == [light.name for light in lights]
    hand.pull("light", 0.0, 1.0)
    assert hand.viewer.session.light_name == lights[-1].name
    hand.pull("light", 1.0, 0.45)
    assert hand.viewer.session.light_name == lights[7].name


def test_a_light_is_linked_to_surfaces_by_pointing(hand: Hand) -> None:
    before = hand.viewer.studio.scene
    hand.pick("only surfaces", BOX)
    assert light_of(hand).links == Links(only_surfaces=())
    hand.pick("  high", BOX)
    assert light_of(hand).links == Links(only_surfaces=("high",))
    assert words_are_those_of_the_scene(hand)
    # One list takes the place of the other.
    hand.pick("except surfac.", BOX)
    assert light_of(hand).links == Links(except_surfaces=())
    undo(hand)
    assert light_of(hand).links == Links(only_surfaces=("high",))
    hand.pick("only surfaces", BOX)
    assert light_of(hand) == before.light("key")
    assert words_are_those_of_the_scene(hand)


def test_pointing_excludes_a_part_from_a_light(hand: Hand) -> None:
    hand.pick("except parts", BOX)
    hand.pick("  low", BOX)
    assert light_of(hand).links == Links(except_parts=("low",))
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    undo(hand)
    assert light_of(hand) == KEY


LEFT = HalfSpace("left", (0.3, 0.0, 0.0), (1.0, 0.0, 0.2))

TOP = HalfSpace("top", (0.0, 0.0, 0.8), (0.0, 0.0, -1.0), edge_width=0.2)


@pytest.fixture
def cut_hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights", boxes().with_light("key", half_spaces=(LEFT, TOP)))


def plane(cut_hand: Hand, name: str = "left") -> HalfSpace:
    (found,) = (each for each in cut_hand.viewer.studio.scene.light("key").half_spaces if each.name == name)
    return found


def test_each_half_space_has_a_switch_of_its_own(cut_hand: Hand) -> None:
    cut_hand.pick("left", BOX)
    assert plane(cut_hand) == LEFT.replace(on=False)
    assert plane(cut_hand, "top") == TOP
    assert words_are_those_of_the_scene(cut_hand)
    cut_hand.pick("left", BOX)
    assert plane(cut_hand) == LEFT


def test_the_width_of_the_edge_is_set_along_a_bar(cut_hand: Hand) -> None:
    before = cut_hand.viewer.studio.scene
    cut_hand.pull("left width", 0.0, 0.3)
    assert 0 < plane(cut_hand).edge_width < 1
    assert plane(cut_hand) == LEFT.replace(edge_width=plane(cut_hand).edge_width)
    assert words_are_those_of_the_scene(cut_hand)
    undo(cut_hand)
    assert cut_hand.viewer.studio.scene is before


def test_a_half_space_that_is_carried_from_now_on_stays_where_it_is(cut_hand: Hand) -> None:
    words = cut_hand.viewer.studio.words.copy()
    cut_hand.pick("left carried", BOX)
    assert plane(cut_hand).carried
    placed = detached(plane(cut_hand), cut_hand.viewer.studio.scene.light("key"))
    assert placed.point == pytest.approx(LEFT.point)
    assert placed.direction == pytest.approx(LEFT.direction)
    assert (cut_hand.viewer.studio.words != words).mean() < 1e-3
    cut_hand.pick("left carried", BOX)
    assert not plane(cut_hand).carried
    assert plane(cut_hand).point == pytest.approx(LEFT.point)


def test_turn_lights_the_other_side(cut_hand: Hand) -> None:
    cut_hand.pick("turn")
    assert plane(cut_hand) == LEFT.replace(direction=(-1.0, 0.0, -0.2))
    assert words_are_those_of_the_scene(cut_hand)


def test_remove_takes_a_half_space_away_and_says_so(cut_hand: Hand) -> None:
    before = cut_hand.viewer.studio.scene
    cut_hand.pick("turn", 0.75)
    assert cut_hand.viewer.studio.scene.light("key").half_spaces == (TOP,)
    assert told(cut_hand) == ("half-space left removed; undo brings it back", False)
    undo(cut_hand)
    assert cut_hand.viewer.studio.scene is before


def test_the_buttons_of_two_half_spaces_have_different_keys(cut_hand: Hand) -> None:
    cut_hand.widget("turn")
    keys = [each.key for each in cut_hand.viewer.board.widgets()]
    assert {"turn left", "turn top"} <= set(keys)
    assert len(set(keys)) == len(keys)


def test_the_message_line_explains_a_row(cut_hand: Hand) -> None:
    assert hint_of(cut_hand, "left carried") == "Whether it moves and turns with the light, like a barn door."
    assert hint_of(cut_hand, "turn") == "Light the other side of left; or remove left."


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
    return hand.viewer.studio.scene.light("key").half_spaces


def pick_points(hand: Hand, places: list[tuple[int, int]] = PLACES) -> None:
    hand.pick("half spaces")
    for place in places:
        hand.click(*place)


def test_three_points_of_the_object_make_a_half_space_in_one_step(hand: Hand) -> None:
    before = hand.viewer.studio.scene
    seen = [hand.viewer.studio.seen_at(line, element) for element, line in PLACES]
    hand.pick("half spaces")
    assert told(hand) == ("pick the first point of the plane on the object; Esc ends", False)
    hand.click(*PLACES[0])
    assert told(hand) == ("pick the second point of the plane on the object; Esc ends", False)
    hand.click(*PLACES[1])
    assert told(hand) == ("pick the third point of the plane on the object; Esc ends", False)
    assert hand.viewer.studio.scene is before
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
    assert hand.viewer.studio.scene is before


@pytest.mark.parametrize("places", [PLACES, PLACES[::-1]])
def test_the_side_of_the_light_is_lit_in_whatever_order_the_points_are_picked(
    hand: Hand, places: list[tuple[int, int]]
) -> None:
    pick_points(hand, places)
    (plane,) = planes_of(hand)
    light = hand.viewer.studio.scene.light("key")
    assert (np.array(light.position) - plane.point) @ plane.direction > 0


def test_a_second_half_space_gets_another_name(hand: Hand) -> None:
    pick_points(hand)
    pick_points(hand)
    assert [plane.name for plane in planes_of(hand)] == ["plane", "plane 2"]


def test_the_background_is_no_point_and_the_prompt_is_repeated(hand: Hand) -> None:
    hand.pick("half spaces")
    hand.click(5, 5)
    message = "no point is seen there; pick the first point of the plane on the object; Esc ends"
    assert told(hand) == (message, True)
    hand.click(*PLACES[0])
    assert told(hand) == ("pick the second point of the plane on the object; Esc ends", False)


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
    hand.click(5, 5)
    assert told(hand)[0].startswith("no point is seen there; pick the third point")
    session.edit(boxes())
    hand.click(*PLACES[2])
    assert [plane.name for plane in planes_of(hand)] == ["plane"]


def test_escape_ends_the_picking_and_then_the_screen(hand: Hand) -> None:
    pick_points(hand, PLACES[:2])
    assert hand.viewer.escape()
    assert hand.viewer.session.screen == "lights"
    hand.click(*PLACES[2])
    assert planes_of(hand) == ()
    assert hand.viewer.escape()
    assert hand.viewer.session.screen == "picture"


def test_the_row_itself_ends_the_picking_without_a_keyboard(hand: Hand) -> None:
    pick_points(hand, PLACES[:2])
    row = hand.widget("half spaces")
    assert (row.value, row.is_chosen) == ("2/3", True)  # type: ignore[attr-defined]
    hand.pick("half spaces")
    row = hand.widget("half spaces")
    assert (row.value, row.is_chosen) == ("add", False)  # type: ignore[attr-defined]


def test_another_screen_ends_the_picking(hand: Hand) -> None:
    pick_points(hand, PLACES[:2])
    for number, screen in enumerate(("picture", "lights")):
        hand.viewer.session.turn_to(screen)
        hand.move(20 + number, 20)
    assert hand.widget("half spaces").value == "add"  # type: ignore[attr-defined]


def test_nothing_else_is_grabbed_while_points_are_picked(hand: Hand) -> None:
    assert hand.viewer.board.screen.handles()
    hand.pick("half spaces")
    assert not hand.viewer.board.screen.handles()


def test_a_point_of_the_picture_is_marked_where_it_is_seen(hand: Hand) -> None:
    studio = hand.viewer.studio
    for element, line in PLACES:
        seen = studio.seen_at(line, element)
        assert seen is not None
        assert places_of(np.array([seen.point]), boxes().view)[0] == pytest.approx((element, line), abs=0.01)


def test_points_behind_the_eye_have_no_place() -> None:
    view = View((0.0, -4.0, 0.0), direction=(0.0, 1.0, 0.0))
    points = np.array([(0.0, -9.0, 0.0), (0.0, 0.0, 0.0)])
    assert places_of(points, view).tolist() == [[SCREEN.width / 2 - 0.5, SCREEN.height / 2 - 0.5]]


def test_the_lit_side_faces_the_light_or_else_the_eye() -> None:
    view = View((0.0, -4.0, 0.0), direction=(0.0, 1.0, 0.0))
    plane = HalfSpace("plane", (0.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    for light, lit in (
        (Light("light", (0.0, -1.0, 0.0)), True),
        (Light("light", (0.0, 1.0, 0.0)), False),
        (Light("light", (3.0, 0.0, 0.0)), True),
        (Light("light", (0.0, 1.0, 0.0), direction=(0.0, 1.0, 0.0), at_infinity=True), True),
    ):
        assert is_lit_side(plane, light, view) == lit
        # A light on the plane leaves it to the eye.
        assert is_lit_side(turned(plane), light, view) != lit
    on_both = view.replace(eye=(3.0, 0.0, 0.0))
    assert is_lit_side(plane, Light("light", (3.0, 0.0, 0.0)), on_both)


# The light list.


def row_of(hand: Hand, name: str) -> LightRow:
    rows = [each for each in hand.viewer.board.widgets() if isinstance(each, LightRow) and each.label == name]
    return rows[0]


def click_at(hand: Hand, name: str, element: int) -> None:
    hand.click(element, row_of(hand, name).area.top + 8)


def many_lights(count: int) -> Scene:
    return boxes().replace(lights=[KEY.replace(name=f"lamp {each}") for each in range(count)])


def test_the_list_shows_and_sets_every_light(hand: Hand) -> None:
    before = hand.viewer.studio.scene
    fill = row_of(hand, "fill")
    assert (fill.numeral, fill.is_on, fill.value) == (2, True, 0.5)
    assert not fill.is_chosen
    assert not fill.is_solo
    click_at(hand, "fill", fill.area.left + 30)
    assert hand.viewer.session.light_name == "fill"
    assert row_of(hand, "fill").is_chosen
    assert hand.viewer.studio.scene is before
    click_at(hand, "fill", fill._box.left + 3)
    assert not light_of(hand, "fill").on
    assert light_of(hand) == KEY
    undo(hand)
    click_at(hand, "key", fill._track.left + fill._track.width // 4)
    assert light_of(hand).intensity == pytest.approx(0.5, abs=0.05)
    assert light_of(hand, "fill").intensity == 0.5


def test_a_drag_along_a_bar_of_the_list_is_one_step_and_other_drags_do_nothing(hand: Hand) -> None:
    before, row = hand.viewer.studio.scene, row_of(hand, "fill")
    track, line = row._track, row.area.top + 8
    hand.drag((track.left, line), (track.left + 9, line), (track.right + 200, line + 90))
    assert light_of(hand, "fill") == before.light("fill").replace(intensity=2.0)
    undo(hand)
    assert hand.viewer.studio.scene is before
    for start in (row.area.left + 20, row._box.left + 3, row.area.right - 12):
        hand.drag((start, line), (start + 9, line), (start + 30, line))
        assert hand.viewer.studio.scene is before


def test_solo_shows_a_light_alone_and_again_the_lights_as_before(hand: Hand) -> None:
    hand.viewer.session.change_light("key", on=False)
    hand.viewer.tell("")
    end = row_of(hand, "key").area.right - 12
    click_at(hand, "key", end)
    assert [light.on for light in hand.viewer.studio.scene.lights] == [True, False]
    assert row_of(hand, "key").is_solo
    click_at(hand, "key", end)
    assert [light.on for light in hand.viewer.studio.scene.lights] == [False, True]
    assert not row_of(hand, "key").is_solo
    hand.pick("all lights on")
    assert all(light.on for light in hand.viewer.studio.scene.lights)


def test_every_place_of_a_row_of_the_list_does_one_thing(hand: Hand) -> None:
    did: list[object] = []
    row = LightRow(
        "key",
        area=row_of(hand, "key").area,
        high=2.0,
        put=lambda value: did.append("put"),
        choose=lambda: did.append("choose"),
        switch=lambda: did.append("switch"),
        solo=lambda: did.append("solo"),
    )
    for element in range(row.area.left, row.area.right + 1):
        count = len(did)
        row.pick(Place(element, row.area.top))
        # Between the bar and solo is the number, which does nothing.
        assert len(did) <= count + 1
    assert list(dict.fromkeys(did)) == ["choose", "switch", "put", "solo"]
    assert did.count("switch") >= 12
    assert did.count("solo") >= 28


def test_the_list_has_pages_and_shows_the_chosen_light(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "lights", many_lights(30))
    assert [each.label for each in hand.viewer.board.layout.beside if isinstance(each, LightRow)] == [
        f"lamp {number}" for number in range(LIGHTS_A_PAGE)
    ]
    assert WORK.covers(hand.viewer.board.layout.beside[-1].area)
    hand.choose("light", "lamp 25")
    assert row_of(hand, "lamp 25").is_chosen
    assert row_of(hand, "lamp 29").numeral == 30
    hand.pick("page", 0.05)
    click_at(hand, "lamp 13", row_of(hand, "lamp 13").area.left + 30)
    assert row_of(hand, "lamp 13").is_chosen


def test_the_list_folds_to_its_heading(hand: Hand) -> None:
    hand.pick("light list")
    assert [each.label for each in hand.viewer.board.layout.beside] == ["light list"]
    hand.pick("light list")
    assert row_of(hand, "key")


def test_a_number_is_typed_over_a_row_of_the_list(hand: Hand) -> None:
    area = row_of(hand, "fill").area
    hand.move(area.left + 20, area.top + 5)
    for letter in "1.25":
        hand.viewer.on_key(letter, typed=letter)
    hand.viewer.on_key("return")
    assert light_of(hand, "fill").intensity == 1.25


def test_the_list_covers_handles_which_are_free_when_panels_are_hidden(hand: Hand) -> None:
    screen = hand.viewer.board.screen
    assert isinstance(screen, LightsScreen)
    handle = screen.handles()[-1]
    covered = Area(handle.element - 20, handle.line - 20, handle.element + 20, handle.line + 20)
    screen._list = ListAt(hand.viewer.session, covered)
    hand.viewer.tell("")
    assert handle.key not in {each.key for each in screen.handles()}
    hand.pick("hide panels")
    assert handle.key in {each.key for each in screen.handles()}
    assert hand.viewer.board.handle_at(handle.element, handle.line) is not None
    assert hand.viewer.board.screen._handles.area == SCREEN  # type: ignore[attr-defined]


class ListAt(LightList):
    """A list of an area."""

    def __init__(self, session: Session, area: Area) -> None:
        super().__init__(session)
        self._area = area

    def widgets(self) -> list[Widget]:
        return [Button("list", area=self._area)]


def test_a_new_column_of_lights_appears_in_the_menu_by_itself(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.screens.lights_screen.FIRST", ("on",))
    labels = [row.label for row in hand.viewer.board.screen.rows()]
    start, end = labels.index("other settings"), labels.index("half-spaces")
    assert {"intensity", "cone angle", "flaps x", "falloff"} <= set(labels[start:end])
    assert len(labels) == len(set(labels))
