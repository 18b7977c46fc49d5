from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, Mesh, Scene, View, read_scene, scene_of
from autocolor.screens.light_and_view.handles import AIM, DIRECTION, EYE, FLAP, LIGHT, TARGET, MovablePoint
from autocolor.screens.light_and_view.light_and_view_screen import (
    MESH,
    DisplayView,
    FlapSwitch,
    flap_switches,
    light_rows,
    smaller,
)
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.screens.light_and_view.orthographic_views import (
    FRONT,
    FRONT_AREA,
    PICTURE_AREA,
    SIDE,
    SIDE_AREA,
    SIDES,
    TOP,
    TOP_AREA,
    OrthographicViews,
    ViewSide,
)
from autocolor.screens.screen import Handle
from autocolor.studio import Studio
from autocolor.widgets.items import GRAY, NIGHT, ORANGE, SLATE, YELLOW, Area, filled
from autocolor.widgets.widget import Button, Place, Switch, Widget
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.autocolor.screens.light_and_view.pointing import (
    FILL,
    KEY,
    boxed,
    handle_of,
    is_undone_at_once,
    opened,
    place_of,
    scene_of_hand,
    screen_of,
)
from tests.autocolor.screens.light_and_view.test_marks import drawn

unit = st.floats(-3.0, 3.0)


def places(area: Area) -> st.SearchStrategy[tuple[int, int]]:
    return st.tuples(st.integers(area.left, area.right), st.integers(area.top, area.bottom))


def where(hand: Hand, side: ViewSide, light: str = "key") -> tuple[float, float]:
    """Where a light is in one of the views, now."""
    return screen_of(hand).views.position(side, scene_of_hand(hand).light(light).position)


@given(
    st.tuples(unit, unit, unit),
    st.booleans(),
    st.integers(-4, 0),
    places(TOP_AREA),
    st.integers(FRONT_AREA.top, FRONT_AREA.bottom),
)
def test_two_drags_in_two_views_put_a_light_at_the_picked_coordinates_to_a_pixel(
    position: tuple[float, float, float], has_aim: bool, zoom: int, place: tuple[int, int], line: int
) -> None:
    light = KEY.replace(position=position) if has_aim else Light("key", position)
    hand = opened(boxed(light))
    screen_of(hand).zoom(zoom)
    z = position[2]
    element = place[0]

    hand.drag(place_of(hand, MovablePoint(LIGHT, "top", "key")), (120, 110), place)
    now = scene_of_hand(hand).light("key").position
    assert now[2] == z
    assert where(hand, TOP) == pytest.approx(place, abs=0.6)

    points = [each.key for each in screen_of(hand).handles()]
    if MovablePoint(LIGHT, "front", "key") in points:
        hand.drag(place_of(hand, MovablePoint(LIGHT, "front", "key")), (element, line))
        after = scene_of_hand(hand).light("key").position
        # The element is that of the top view: y does not move, and x is where it was.
        assert after[:2] == now[:2]
        assert where(hand, FRONT) == pytest.approx((element, line), abs=0.6)


@pytest.mark.parametrize(("side", "unseen"), [(TOP, 2), (FRONT, 1), (SIDE, 0)])
@pytest.mark.parametrize("what", [EYE, TARGET, LIGHT, AIM])
def test_a_drag_never_moves_the_coordinate_that_its_view_does_not_show(
    what: str, side: ViewSide, unseen: int
) -> None:
    hand = opened(boxed(KEY))
    before = scene_of_hand(hand)
    movable = MovablePoint(what, side.name, "key" if what in (LIGHT, AIM) else "")
    if what == TARGET:
        # The aim of the light is at the same place.
        hand.pick("eye")
    start = movable.point_in(before, screen_of(hand).views)
    element, line = place_of(hand, movable)
    hand.drag((element, line), (element + 9, line - 4), (element + 21, line - 17))
    end = movable.point_in(scene_of_hand(hand), screen_of(hand).views)
    assert start is not None
    assert end is not None
    assert [number for number in range(3) if start[number] != end[number]] == sorted({side.right, side.up})
    assert unseen not in (side.right, side.up)
    assert screen_of(hand).views.position(side, end) == pytest.approx((element + 21, line - 17), abs=0.6)
    assert is_undone_at_once(hand, before)


def test_a_light_is_moved_by_two_picks_as_in_the_paper() -> None:
    hand = opened(boxed(KEY, FILL))
    before = scene_of_hand(hand)
    hand.click(*place_of(hand, MovablePoint(LIGHT, "top", "fill")))
    assert hand.viewer.session.light_name == "fill"
    assert hand.viewer.message == "fill: x -3  y -3  z 1: pick its new place"
    assert scene_of_hand(hand) is before
    hand.click(200, 60)
    after = scene_of_hand(hand).light("fill").position
    assert after[2] == 1.0
    assert where(hand, TOP, "fill") == pytest.approx((200, 60), abs=0.6)
    assert hand.viewer.message.startswith("fill: x ")
    hand.click(*place_of(hand, MovablePoint(LIGHT, "side", "fill")))
    hand.click(300, 250)
    assert scene_of_hand(hand).light("fill").position[0] == after[0]
    assert where(hand, SIDE, "fill") == pytest.approx((300, 250), abs=0.6)
    assert hand.viewer.studio.undo()
    assert is_undone_at_once(hand, before)


@pytest.mark.parametrize("place", [(300, 300), (300, 100), (250, 100)])
def test_a_pick_outside_of_its_view_is_refused_in_one_sentence(place: tuple[int, int]) -> None:
    hand = opened(boxed(KEY))
    before = scene_of_hand(hand)
    hand.click(*place_of(hand, MovablePoint(LIGHT, "top", "key")))
    hand.click(*place)
    assert scene_of_hand(hand) is before
    assert hand.viewer.session.news.is_warning
    assert hand.viewer.message == "key: its new place must be in the top view; pick it there"
    assert (words_of(hand)[464:] == ORANGE).any()
    # The light is still held.
    hand.click(100, 90)
    assert where(hand, TOP) == pytest.approx((100, 90), abs=0.6)
    assert is_undone_at_once(hand, before)


def test_the_lines_of_a_light_that_is_held_go_when_it_is_let_go_of() -> None:
    hand = opened(boxed(KEY))
    for let_go in (
        lambda: hand.viewer.on_key("escape"),
        lambda: hand.pick("display"),
        lambda: hand.drag((20, 440), (21, 440)),
        lambda: hand.click(150, 150),
    ):
        element, line = place_of(hand, MovablePoint(LIGHT, "top", "key"))
        hand.click(element, line)
        assert (words_of(hand)[240:440, element] == SLATE).sum() > 150
        let_go()
        hand.move(20, 440)
        assert (words_of(hand)[240:440, element] == SLATE).sum() < 100


def words_of(hand: Hand) -> np.ndarray[tuple[int, int], np.dtype[np.uint16]]:
    assert isinstance(hand.viewer.display, Ramtek9300)
    return hand.viewer.display.words.reshape(480, 640)


def test_a_light_that_is_dragged_beyond_its_view_stays_at_the_edge() -> None:
    hand = opened(boxed(KEY))
    hand.drag(place_of(hand, MovablePoint(LIGHT, "top", "key")), (300, 120), (400, 300))
    assert where(hand, TOP) == pytest.approx((TOP_AREA.right, TOP_AREA.bottom), abs=0.6)
    hand.drag(place_of(hand, MovablePoint(LIGHT, "side", "key")), (10, 10))
    assert where(hand, SIDE) == pytest.approx((SIDE_AREA.left, SIDE_AREA.top), abs=0.6)


def test_a_point_that_is_dragged_has_lines_across_the_views_and_tells_its_coordinates() -> None:
    hand = opened(boxed(KEY))
    clear = words_of(hand).copy()
    hand.move(*place_of(hand, MovablePoint(LIGHT, "top", "key")))
    hand.joystick.track = True
    hand.viewer.poll()
    hand.move(40, 60)
    x, y, z = scene_of_hand(hand).light("key").position
    assert hand.viewer.message == f"key: x {x:.6g}  y {y:.6g}  z {z:.6g}"
    for line in (20, 215, 240, 450):
        assert words_of(hand)[line, 40] == SLATE != clear[line, 40]
    assert words_of(hand)[60, 230] == SLATE
    hand.joystick.track = False
    hand.viewer.poll()
    assert words_of(hand)[450, 40] == clear[450, 40]


def test_escape_takes_a_drag_back() -> None:
    hand = opened(boxed(KEY))
    before = scene_of_hand(hand)
    hand.move(*place_of(hand, MovablePoint(LIGHT, "front", "key")))
    hand.joystick.track = True
    hand.viewer.poll()
    hand.move(40, 300)
    hand.move(60, 400)
    assert scene_of_hand(hand) != before
    hand.viewer.on_key("escape")
    assert scene_of_hand(hand) == before
    assert not hand.viewer.studio.undo()
    hand.move(100, 350)
    hand.joystick.track = False
    hand.viewer.poll()
    assert scene_of_hand(hand) == before
    assert words_of(hand)[450, 60] != SLATE


def test_a_place_that_the_scene_refuses_is_told_and_the_drag_goes_on() -> None:
    hand = opened(boxed(Light("key", (2.0, -3.0, 0.5), aim=(0.5, 0.5, 0.5))))
    before = scene_of_hand(hand)
    # Put the light where the pixel of a place is, then the aim there, and the light back.
    views = screen_of(hand).views
    point = views.placed(TOP, (2.0, -3.0, 0.5), 60, 70)
    hand.viewer.session.change_light("key", aim=point)
    hand.viewer.tell("")
    aimed = scene_of_hand(hand)
    hand.move(*place_of(hand, MovablePoint(LIGHT, "top", "key")))
    hand.joystick.track = True
    hand.viewer.poll()
    hand.move(100, 100)
    near = scene_of_hand(hand)
    assert near != aimed
    hand.move(60, 70)
    assert scene_of_hand(hand) is near
    assert hand.viewer.session.news.is_warning
    assert "the aim must differ from the position" in hand.viewer.message
    hand.move(50, 90)
    assert where(hand, TOP) == pytest.approx((50, 90), abs=0.6)
    assert not hand.viewer.session.news.is_warning
    hand.joystick.track = False
    hand.viewer.poll()
    hand.viewer.studio.undo()
    assert scene_of_hand(hand) == aimed
    assert is_undone_at_once(hand, before)


def test_a_direction_depends_on_where_its_end_was_put_and_not_on_the_way_there() -> None:
    spot = Light("key", (0.0, 0.0, 3.0), direction=(0.3, 0.2, -1.0))
    found = []
    for way in ([], [(30, 30), (200, 200), (20, 200)]):
        hand = opened(boxed(spot))
        before = scene_of_hand(hand)
        hand.drag(place_of(hand, MovablePoint(DIRECTION, "top", "key")), *way, (180, 90))
        light = scene_of_hand(hand).light("key")
        found.append(light.axis)
        assert light.position == spot.position
        assert light.aim is None
        assert is_undone_at_once(hand, before)
    assert found[0] == found[1] != spot.axis


def test_a_view_without_a_target_looks_where_the_end_of_its_arrow_was_put() -> None:
    hand = opened(boxed(KEY).replace(view=View((-2.0, -3.0, 2.0), direction=(2.5, 3.5, -1.5))))
    before = scene_of_hand(hand).view
    hand.pick("eye")
    element, line = place_of(hand, MovablePoint(TARGET, "top"))
    hand.drag((element, line), (element + 60, line), (element, line - 30))
    view = scene_of_hand(hand).view
    assert view.target is None
    assert view.eye == before.eye
    assert view.axes[2][1] > before.axes[2][1]


@pytest.mark.parametrize(("end", "low", "high"), [("minimum", 0.9, 0.9), ("maximum", 0.1, 0.1)])
def test_an_end_of_a_flap_is_dragged_as_far_as_the_other(end: str, low: float, high: float) -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(z=Flap(0.1, 0.9)))))
    before = scene_of_hand(hand)
    movable = MovablePoint(FLAP, "front", "key", "z", end)
    element, line = place_of(hand, movable)
    hand.drag((element, line), (element, line + 3), (element, 240 if end == "minimum" else 450))
    assert scene_of_hand(hand).light("key").flaps.z == Flap(low, high)
    assert hand.viewer.message == f"key: flap z, {end} {low:g}"
    assert is_undone_at_once(hand, before)


def test_an_end_of_a_flap_is_put_where_the_second_pick_is() -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(x=Flap(-1.0, 2.0)))))
    movable = MovablePoint(FLAP, "top", "key", "x", "maximum")
    hand.click(*place_of(hand, movable))
    hand.click(200, 30)
    flap = scene_of_hand(hand).light("key").flaps.x
    assert flap is not None
    assert flap.minimum == -1.0
    element, _ = screen_of(hand).views.position(TOP, (flap.maximum, 0.0, 0.0))
    assert element == pytest.approx(200, abs=0.6)
    assert (words_of(hand)[30:200, 200] == YELLOW).all()


def test_the_switch_of_a_flap_keeps_its_ends() -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(z=Flap(0.1, 0.9)))))
    before = scene_of_hand(hand)
    hand.pick("key: flap z, maximum, side", 0.5)
    assert scene_of_hand(hand).light("key").flaps.z == Flap(0.1, 0.9, on=False)
    assert is_undone_at_once(hand, before)


def test_dragging_beside_everything_moves_the_views_together_and_no_edit_is_made() -> None:
    hand = opened(boxed(KEY))
    before, scene = screen_of(hand).views, scene_of_hand(hand)
    point = (0.5, 0.5, 0.5)
    hand.drag((20, 440), (30, 430), (40, 420))
    after = screen_of(hand).views
    element, line = before.position(FRONT, point)
    assert after.position(FRONT, point) == pytest.approx((element + 20, line - 20))
    assert after.position(TOP, point)[0] == pytest.approx(before.position(TOP, point)[0] + 20)
    assert after.position(SIDE, point)[1] == pytest.approx(before.position(SIDE, point)[1] - 20)
    assert scene_of_hand(hand) is scene


def test_rescale_moves_nearer_and_farther_and_fits_everything_with_space_on_all_sides() -> None:
    hand = opened(boxed(KEY, FILL))
    scale = screen_of(hand).views.scale
    hand.pick("rescale", 0.95)
    assert screen_of(hand).views.scale == pytest.approx(1.25 * scale)
    hand.pick("rescale", 0.05)
    assert screen_of(hand).views.scale == pytest.approx(scale)
    far = (40.0, -30.0, 20.0)
    hand.viewer.session.change_light("key", position=far)
    hand.pick("fit all", 0.25)
    assert screen_of(hand).views.scale < scale / 3
    for side in SIDES:
        element, line = screen_of(hand).views.position(side, far)
        assert side.area.inset(15).has(element, line)
    hand.pick("fit all", 0.75)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float64)
    for side in SIDES:
        spots = screen_of(hand).views.positions(side, corners)
        assert all(side.area.inset(15).has(*spot) for spot in spots.tolist())
    assert screen_of(hand).views.scale > 2 * scale
    hand.pick("fit surface")
    assert hand.viewer.message == "the views show low"


def test_the_views_stay_where_no_surface_is_in_use() -> None:
    hand = opened(scene_of(Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())))
    views = screen_of(hand).views
    screen_of(hand).fit_surface()
    assert screen_of(hand).views is views


def test_angle_and_frame_change_the_view_by_one_step_each() -> None:
    hand = opened(boxed(KEY))
    before = scene_of_hand(hand)
    hand.pick("angle", 0.95)
    assert scene_of_hand(hand).view.angle == 5.0
    assert hand.viewer.message == "angle 5 degrees"
    assert is_undone_at_once(hand, before)
    hand.pick("frame")
    assert scene_of_hand(hand).view.eye != before.view.eye
    assert is_undone_at_once(hand, before)


def test_dragging_the_picture_turns_around_the_object() -> None:
    hand = opened(boxed(KEY))
    before = scene_of_hand(hand)
    element, line = (round(each) for each in PICTURE_AREA.middle)
    hand.drag((element, line), (element + 5, line), (element + 20, line + 10))
    assert scene_of_hand(hand).view.eye != before.view.eye
    assert is_undone_at_once(hand, before)


def test_the_wheel_rescales_the_views_and_moves_the_eye_over_the_picture() -> None:
    hand = opened(boxed(KEY))
    scale, eye = screen_of(hand).views.scale, scene_of_hand(hand).view.eye
    hand.viewer.on_pointer(20, 440, "wheel up", steps=2)
    assert screen_of(hand).views.scale == pytest.approx(1.25 * scale)
    assert scene_of_hand(hand).view.eye == eye
    hand.viewer.on_pointer(380, 100, "wheel up")
    assert scene_of_hand(hand).view.eye != eye


def test_a_light_becomes_a_point_source_and_is_aimed_again_by_pointing() -> None:
    hand = opened(boxed(KEY))
    hand.pick("kind", 0.05)
    light = scene_of_hand(hand).light("key")
    assert (light.aim, light.direction, light.concentration) == (None, None, 0.0)
    assert not any(
        each.key.what == AIM for each in screen_of(hand).handles() if isinstance(each.key, MovablePoint)
    )
    hand.pick("kind", 0.9)
    assert scene_of_hand(hand).light("key").aim == (0.5, 0.5, 0.5)
    assert handle_of(hand, MovablePoint(AIM, "top", "key")).label == "key: aim: x 0.5  y 0.5  z 0.5"


def test_the_message_line_tells_what_is_where_the_pointer_is() -> None:
    hand = opened(boxed(KEY))
    hand.move(*place_of(hand, MovablePoint(EYE, "top")))
    assert hand.viewer.board.messages[-1].text.startswith("eye: x -2  y -3  z 2: drag it, or click")
    hand.move(20, 440)
    assert hand.viewer.board.messages[-1].text.startswith("from -y: x ")
    hand.move(380, 100)
    assert hand.viewer.board.messages[-1].text.startswith("The view: ")
    hand.move(250, 228)
    assert hand.viewer.board.messages[-1].text == screen_of(hand).help


def test_what_is_chosen_is_yellow() -> None:
    hand = opened(boxed(KEY, FILL))
    counts = []
    for movable in (
        MovablePoint(LIGHT, "top", "key"),
        MovablePoint(EYE, "top"),
        MovablePoint(LIGHT, "top", "fill"),
    ):
        element, line = place_of(hand, movable)
        for place in ((element, line), (element, line)):
            hand.click(*place)
        row = words_of(hand)[line, element - 4 : element + 5]
        counts.append((row == YELLOW).sum())
        assert screen_of(hand).chosen == movable.light
    assert counts[0] == counts[2] == 9
    assert counts[1] >= 3
    assert scene_of_hand(hand).lights == boxed(KEY, FILL).lights


def fresh(scene: Scene) -> tuple[bytes, bytes]:
    display = Ramtek9300()
    Studio(scene, display)
    return display.words.tobytes(), display.entries.tobytes()


def test_leaving_restores_the_picture_byte_for_byte() -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(z=Flap(0.1, 0.9))), FILL))
    hand.drag(place_of(hand, MovablePoint(LIGHT, "top", "key")), (60, 60), (90, 80))
    hand.pick("display", 0.9)
    for _ in range(6):
        hand.viewer.on_tick()
    hand.pick("< picture")
    hand.move(100, 100)
    hand.viewer.tell("")
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    assert (display.words.tobytes(), display.entries.tobytes()) == fresh(scene_of_hand(hand))


def test_a_page_that_changed_step_by_step_is_the_page_drawn_at_once() -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(z=Flap(0.1, 0.9))), FILL))
    for _ in range(6):
        hand.viewer.on_tick()
    hand.drag(place_of(hand, MovablePoint(LIGHT, "top", "fill")), (60, 60), (90, 80))
    hand.drag(place_of(hand, MovablePoint(EYE, "front")), (60, 300), (90, 350))
    hand.pick("display", 0.9)
    for _ in range(6):
        hand.viewer.on_tick()
    hand.move(100, 216)
    hand.viewer.tell("")
    before = words_of(hand).copy()
    hand.viewer._sheet.forget()
    hand.viewer.tell("")
    assert np.array_equal(before, words_of(hand))


def test_a_scene_without_lights_shows_the_eye_alone() -> None:
    hand = opened(boxed())
    assert screen_of(hand).widgets() == []
    assert {each.label.split(":")[0] for each in screen_of(hand).handles()} == {"eye", "target"}
    element, line = place_of(hand, MovablePoint(EYE, "top"))
    hand.drag((element, line), (element + 20, line + 9))
    assert scene_of_hand(hand).view.eye[2] == 2.0


def test_pointing_sends_nothing_but_the_message_and_the_mark() -> None:
    hand = opened(boxed(KEY, FILL))
    hand.move(20, 440)
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    before = display.words_received
    hand.move(*place_of(hand, MovablePoint(LIGHT, "top", "key")))
    assert display.words_received - before < 200


def test_a_dragged_light_sends_the_small_picture_and_some_lines() -> None:
    hand = opened(boxed(KEY, FILL))
    hand.move(*place_of(hand, MovablePoint(LIGHT, "top", "key")))
    hand.joystick.track = True
    hand.viewer.poll()
    hand.move(100, 90)
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    before = display.words_received
    hand.move(104, 95)
    picture = 232 * 174
    assert picture < display.words_received - before < picture + 3000


def display_of(hand: Hand) -> DisplayView:
    return DisplayView(hand.viewer.session, ObjectLines())


def grays(display: DisplayView) -> int:
    """The gray pixels within the frame."""
    left, top, right, bottom = display.area
    words = drawn(display.items()).words[top : bottom + 1, left : right + 1]
    return int((words == GRAY).sum())


def test_a_smaller_picture_has_the_words_of_pixels_from_all_over_it() -> None:
    words = np.arange(12, dtype=np.uint16).reshape(3, 4)
    assert smaller(words, Area(0, 0, 3, 2)).tolist() == words.tolist()
    assert smaller(words, Area(5, 5, 5, 5)).tolist() == [[6]]
    assert smaller(words, Area(0, 0, 1, 2)).tolist() == [[1, 3], [5, 7], [9, 11]]


def test_the_picture_stands_in_a_frame_and_is_the_same_until_it_changes() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    assert PICTURE_AREA.inset(7).covers(display.area)
    before, again = display.items(), display.items()
    assert before[-1] is again[-1]
    assert before[-1].area == display.area
    hand.viewer.session.change_light("key", intensity=0.2, position=(5.0, 0.0, 0.0))
    assert display.items()[-1] != before[-1]


def test_the_mesh_follows_the_view() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    display.show(MESH)
    before = display.items()
    assert grays(display) > 100
    hand.viewer.session.edit(scene_of_hand(hand).with_view(angle=20.0))
    assert display.items() != before


def test_hidden_lines_of_the_mesh_are_left_out_when_there_is_time_and_come_back_with_another_view() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    assert not display.leave_out_hidden()
    display.show(MESH)
    whole = grays(display)
    assert display.leave_out_hidden()
    assert grays(display) < 0.9 * whole
    assert not display.leave_out_hidden()
    # A light changes nothing of that.
    hand.viewer.session.change_light("key", position=(5.0, 0.0, 0.0))
    assert grays(display) < 0.9 * whole
    assert not display.leave_out_hidden()
    hand.viewer.session.edit(scene_of_hand(hand).with_view(angle=1.0))
    assert grays(display) > 0.95 * whole
    assert display.leave_out_hidden()


def test_a_click_in_the_quarter_turns_from_the_picture_to_the_mesh_and_back() -> None:
    hand = opened(boxed(KEY))
    element, line = (round(each) for each in PICTURE_AREA.middle)
    shown = []
    for _ in range(3):
        shown.append([each for each in screen_of(hand).items() if PICTURE_AREA.covers(each.area)])
        hand.click(element, line)
    assert shown[0] == shown[2] != shown[1]


VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def switches_of(flaps: Flaps, changes: list[Mapping[str, Any]] | None = None) -> list[FlapSwitch]:
    light = Light("key", (1.0, 2.0, 3.0), flaps=flaps)
    return list(flap_switches(VIEWS, light, (changes if changes is not None else []).append))


def test_each_line_of_a_flap_has_a_switch_at_its_end() -> None:
    switches = switches_of(Flaps(z=Flap(-1.0, 2.0)))
    assert [each.label for each in switches] == [
        "key: flap z, minimum, front",
        "key: flap z, maximum, front",
        "key: flap z, minimum, side",
        "key: flap z, maximum, side",
    ]
    line = round(VIEWS.position(FRONT, (0.0, 0.0, 2.0))[1])
    assert FRONT.area.right - 2 <= switches[1].area.right <= FRONT.area.right
    assert line - 3 <= switches[1].area.bottom < line


def test_the_switches_of_flaps_stand_beside_the_ends_of_their_lines() -> None:
    switches = switches_of(Flaps(x=Flap(-1.0, 2.5), z=Flap(-1.5, 9.6)))
    assert {each.label.removeprefix("key: flap "): tuple(each.area) for each in switches} == {
        "x, minimum, top": (116, 215, 122, 221),
        "x, maximum, top": (150, 215, 156, 221),
        "x, minimum, front": (116, 447, 122, 453),
        "x, maximum, front": (150, 447, 156, 453),
        "z, minimum, front": (239, 350, 245, 356),
        "z, maximum, front": (239, 240, 245, 246),
        "z, minimum, side": (495, 350, 501, 356),
        "z, maximum, side": (495, 240, 501, 246),
    }


def test_switches_are_within_their_view_wherever_the_lines_are() -> None:
    for tenth in range(-130, 131):
        flaps = Flaps(*(Flap(minimum=tenth / 10) for _ in "xyz"))
        for each in switches_of(flaps):
            assert any(side.area.covers(each.area) for side in SIDES)
            assert not each.area.is_empty


def test_a_switch_is_full_while_its_flap_is_on_and_flips_it() -> None:
    changes: list[Mapping[str, Any]] = []
    on, off = switches_of(Flaps(x=Flap(minimum=0.0), y=Flap(minimum=1.0, on=False)), changes)[:2]
    assert on.label == "key: flap x, minimum, top"
    assert filled(on.area.inset(2), YELLOW) in on.items(lit=False)
    assert filled(off.area.inset(1), NIGHT) in off.items(lit=False)
    assert filled(off.area.inset(2), YELLOW) not in off.items(lit=False)
    assert "off" in on.help
    for each in (on, off):
        each.pick(Place(each.area.left, each.area.top))
    assert changes == [{"flaps": {"x": {"on": False}}}, {"flaps": {"y": {"on": True}}}]


def test_a_flap_without_an_end_in_view_has_no_switch() -> None:
    assert switches_of(Flaps(x=Flap(), y=Flap(minimum=1e9))) == []
    assert TOP.area.width


def rows_of(hand: Hand) -> dict[str, Widget]:
    screen = screen_of(hand)
    rows = light_rows(hand.viewer.session, screen.edits, screen.chosen, screen.choose)
    return {row.label: row for row in rows}


def test_each_light_has_a_row_with_its_number() -> None:
    rows = rows_of(opened(boxed(KEY, FILL.replace(on=False))))
    key, fill = rows["1 key"], rows["2 fill"]
    assert isinstance(key, Switch)
    assert isinstance(fill, Switch)
    assert (key.is_on, key.is_chosen) == (True, True)
    assert (fill.is_on, fill.is_chosen) == (False, False)


def test_the_box_of_a_row_switches_the_light_and_the_rest_chooses_it() -> None:
    hand = opened(boxed(KEY, FILL))
    before = scene_of_hand(hand)
    hand.pick("2 fill", 0.3)
    assert hand.viewer.session.light_name == "fill"
    assert scene_of_hand(hand) is before
    hand.pick("1 key", 0.95)
    assert not scene_of_hand(hand).light("key").on
    assert hand.viewer.session.light_name == "fill"


def test_the_chosen_light_has_rows_for_its_kind_concentration_cone_and_flaps() -> None:
    rows = rows_of(opened(boxed(KEY, FILL)))
    assert list(rows)[4:11] == [
        "chosen light",
        "kind",
        "concentration",
        "cone angle",
        "flaps x",
        "flaps y",
        "flaps z",
    ]


def test_without_lights_there_is_the_row_of_the_eye_alone() -> None:
    assert list(rows_of(opened(boxed()))) == ["eye & lights", "eye"]


def test_the_eye_has_a_row_and_hides_those_of_the_chosen_light() -> None:
    hand = opened(boxed(KEY, FILL))
    hand.pick("eye")
    rows = rows_of(hand)
    assert list(rows) == ["eye & lights", "eye", "1 key", "2 fill"]
    eye, key = rows["eye"], rows["1 key"]
    assert isinstance(eye, Button)
    assert isinstance(key, Switch)
    assert (eye.is_chosen, key.is_chosen) == (True, False)
    hand.pick("1 key", 0.3)
    assert "kind" in rows_of(hand)


def test_all_rows_of_sixteen_lights_can_be_reached() -> None:
    hand = opened(boxed(*(Light(f"light {n}", (n, -3.0, 2.0)) for n in range(1, 17))))
    for label in (*(f"{n} light {n}" for n in range(1, 17)), "flaps z", "rescale", "angle", "1 light 1"):
        assert hand.widget(label) in hand.viewer.board.layout.rows
        assert "more" not in {row.label for row in hand.viewer.board.layout.rows}


# The aims of the coupe's lights are a few pixels from each other when the screen opens.


@pytest.fixture
def coupe() -> Hand:
    return opened(read_scene(Path(__file__).parents[4] / "scenes/coupe"))


def signs_of(hand: Hand) -> list[Handle]:
    return [each for each in screen_of(hand).handles() if not each.sign.is_empty]


def test_lights_and_aims_that_are_close_together_are_told_apart_by_numerals(coupe: Hand) -> None:
    aims = [each for each in signs_of(coupe) if each.key.what == AIM]  # type: ignore[attr-defined]
    assert len(aims) == 4 * len(SIDES)
    close = [
        (one, other)
        for one, other in combinations(aims, 2)
        if max(abs(one.element - other.element), abs(one.line - other.line)) <= 10
    ]
    assert len(close) > 5
    for one, other in combinations(signs_of(coupe), 2):
        assert not one.sign.overlaps(other.sign)
    for handle in signs_of(coupe):
        left, top, right, bottom = handle.sign
        for place in ((left, top), (right, bottom), ((left + right) // 2, (top + bottom) // 2)):
            coupe.move(*place)
            assert coupe.viewer.board.handle_at(*place) == handle
            # The second cursor marks the point itself.
            assert coupe.viewer.board.mark == (handle.element, handle.line)
            assert coupe.viewer.board.messages[0].text.startswith(handle.label)


@pytest.mark.parametrize("light", ["key", "side", "back", "rim"])
def test_a_drag_of_a_numeral_moves_its_point_as_far_as_the_pointer(coupe: Hand, light: str) -> None:
    before = scene_of_hand(coupe)
    handle = handle_of(coupe, MovablePoint(AIM, "side", light))
    element, line = handle.sign.left + 3, handle.sign.top + 4
    coupe.drag((element, line), (element + 9, line - 7), (element + 20, line - 15))
    scene = scene_of_hand(coupe)
    assert scene.lights != before.lights
    at = screen_of(coupe).views.position(SIDE, scene.light_in_world(light).aim or (0, 0, 0))
    assert (round(at[0]), round(at[1])) == (handle.element + 20, handle.line - 15)
    assert [each for each in scene.lights if each.name != light] == [
        each for each in before.lights if each.name != light
    ]
    assert is_undone_at_once(coupe, before)


def test_a_pick_on_a_numeral_puts_its_point_at_the_next_pick(coupe: Hand) -> None:
    handle = handle_of(coupe, MovablePoint(AIM, "top", "rim"))
    coupe.click(handle.sign.left + 1, handle.sign.top + 1)
    assert coupe.viewer.message.startswith("rim: aim: ")
    coupe.click(100, 60)
    at = screen_of(coupe).views.position(TOP, scene_of_hand(coupe).light_in_world("rim").aim or (0, 0, 0))
    assert (round(at[0]), round(at[1])) == (100, 60)
