from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import HalfSpace, Light, View
from autocolor.screens.lights.plane_picking import is_lit_side, places_of, turned
from autocolor.widgets.areas import SCREEN
from tests.autocolor.screens.boxes import boxes, hand_at, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand

PLACES = [(300, 300), (340, 330), (320, 200)]
"""Elements and lines at which the cube is seen, not in one line."""


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "lights")


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


def test_a_second_one_gets_another_name(hand: Hand) -> None:
    pick_points(hand)
    pick_points(hand)
    assert [plane.name for plane in planes_of(hand)] == ["plane", "plane 2"]


def test_the_background_is_no_point_and_the_next_one_is_asked_for_again(hand: Hand) -> None:
    hand.pick("half spaces")
    hand.click(5, 5)
    message = "no point is seen there; pick the first point of the plane on the object; Esc ends"
    assert told(hand) == (message, True)
    hand.click(*PLACES[0])
    assert told(hand) == ("pick the second point of the plane on the object; Esc ends", False)


def test_a_third_point_in_one_line_is_refused_and_picked_again(hand: Hand) -> None:
    pick_points(hand, [PLACES[0], PLACES[1], PLACES[0]])
    message, is_warning = told(hand)
    assert message.startswith("half-space 'plane': its three points must not be in one line")
    assert is_warning
    assert planes_of(hand) == ()
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
    assert hand.viewer.board.screen.handles() == ()


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


def test_the_lit_side_is_that_of_the_light_else_that_of_the_eye() -> None:
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
