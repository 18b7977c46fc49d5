from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from autocolor import Flap, Flaps, Light, Mesh, Scene, View, read_scene, scene_of
from autocolor.arrays import Words
from autocolor.screens.light_and_view.marks import AIM, EYE, FLAP, LIGHT, TARGET, MovablePoint
from autocolor.screens.light_and_view.orthographic_views import (
    EDGE,
    FRONT,
    PICTURE_AREA,
    SIDE,
    SIDES,
    TOP,
    ViewSide,
    fitted_views,
    shown_points,
)
from autocolor.screens.screen import Handle
from autocolor.widgets.items import GRAY, LIGHT_GRAY, ORANGE, SLATE
from tests.autocolor.screens.hand import Hand
from tests.autocolor.screens.light_and_view.pointing import (
    FILL,
    KEY,
    boxed,
    handle_of,
    is_undone_at_once,
    movable_of,
    opened,
    place_of,
    point_of,
    screen_of,
)
from tests.autocolor.screens.painting_hand import boxes_scene
from tests.autocolor.widgets.drawing import drawing_on

MIDDLE = round(PICTURE_AREA.middle[0]), round(PICTURE_AREA.middle[1])


def where(hand: Hand, side: ViewSide, light: str = "key") -> tuple[float, float]:
    """Where a light is in one of the views, now."""
    return screen_of(hand).views.position(side, hand.scene.lights_in_world[light].position)


@pytest.mark.parametrize("what", [EYE, TARGET, LIGHT, AIM])
def test_a_drag_moves_the_two_coordinates_that_its_view_shows_and_is_one_step(what: str) -> None:
    for side in SIDES:
        hand = opened(boxed(KEY))
        before = hand.scene
        movable = MovablePoint(what, side, "key" if what in (LIGHT, AIM) else "")
        if what == TARGET:
            # The aim of the light is at the same place.
            hand.pick("eye")
        start = point_of(hand, movable)
        element, line = place_of(hand, movable)
        hand.drag((element, line), (element + 9, line - 4), (element + 21, line - 17))
        end = point_of(hand, movable)
        assert {number for number in range(3) if start[number] != end[number]} == {side.right, side.up}
        assert screen_of(hand).views.position(side, end) == pytest.approx((element + 21, line - 17), abs=0.6)
        assert is_undone_at_once(hand, before)


def test_a_light_is_moved_by_two_picks_in_each_of_two_views_as_in_the_paper() -> None:
    hand = opened(boxed(KEY, FILL))
    before = hand.scene
    hand.click(*place_of(hand, MovablePoint(LIGHT, TOP, "fill")))
    assert hand.viewer.session.light_name == "fill"
    assert hand.message == "fill: x -3  y -3  z 1: pick its new place"
    assert hand.scene is before
    hand.click(200, 60)
    after = hand.scene.lights["fill"].position
    assert after[2] == 1.0
    assert where(hand, TOP, "fill") == pytest.approx((200, 60), abs=0.6)
    assert hand.message.startswith("fill: x ")
    hand.click(*place_of(hand, MovablePoint(LIGHT, SIDE, "fill")))
    hand.click(300, 250)
    assert hand.scene.lights["fill"].position[0] == after[0]
    assert where(hand, SIDE, "fill") == pytest.approx((300, 250), abs=0.6)
    assert hand.viewer.studio.undo()
    assert is_undone_at_once(hand, before)


def test_a_pick_outside_of_its_view_is_refused_and_a_drag_stays_at_its_edge() -> None:
    hand = opened(boxed(KEY))
    before = hand.scene
    hand.click(*place_of(hand, MovablePoint(LIGHT, TOP, "key")))
    for place in ((300, 300), (300, 100), (250, 100)):
        hand.click(*place)
        assert hand.scene is before
        assert hand.message == "key: its new place must be in the top view; pick it there"
        assert (hand.display.words[464:] == ORANGE).any()
    hand.click(100, 90)
    assert where(hand, TOP) == pytest.approx((100, 90), abs=0.6)
    assert is_undone_at_once(hand, before)
    # A drag stays at the edge.
    hand.drag(place_of(hand, MovablePoint(LIGHT, TOP, "key")), (300, 120), (400, 300))
    assert where(hand, TOP) == pytest.approx((TOP.area.right, TOP.area.bottom), abs=0.6)
    hand.drag(place_of(hand, MovablePoint(LIGHT, SIDE, "key")), (10, 10))
    assert where(hand, SIDE) == pytest.approx((SIDE.area.left, SIDE.area.top), abs=0.6)


def test_the_lines_of_a_light_that_is_held_go_when_it_is_let_go_of() -> None:
    hand = opened(boxed(KEY))
    for end in (
        lambda: hand.press("escape"),
        lambda: hand.pick("display"),
        lambda: hand.drag((20, 440), (21, 440)),
        lambda: hand.click(150, 150),
    ):
        element, line = place_of(hand, MovablePoint(LIGHT, TOP, "key"))
        hand.click(element, line)
        assert (hand.display.words[240:440, element] == SLATE).sum() > 150
        end()
        hand.move(20, 440)
        assert (hand.display.words[240:440, element] == SLATE).sum() < 100


def test_a_view_without_a_target_looks_where_the_end_of_its_arrow_was_put() -> None:
    hand = opened(boxed(KEY).replace(view=View((-2.0, -3.0, 2.0), direction=(2.5, 3.5, -1.5))))
    end = point_of(hand, MovablePoint(TARGET, TOP))
    hand.pick("eye")
    element, line = place_of(hand, MovablePoint(TARGET, TOP))
    hand.drag((element, line), (element + 60, line), (element, line - 30))
    view, views = hand.scene.view, screen_of(hand).views
    assert (view.target, view.eye) == (None, (-2.0, -3.0, 2.0))
    wanted = np.array(views.placed(TOP, end, element, line - 30)) - np.array(view.eye)
    assert view.axes[2] == pytest.approx(wanted / np.linalg.norm(wanted), abs=5e-3)


@pytest.mark.parametrize(("end", "other", "beyond"), [("minimum", 0.9, 240), ("maximum", 0.1, 450)])
def test_an_end_of_a_flap_is_dragged_as_far_as_the_other(end: str, other: float, beyond: int) -> None:
    hand = opened(boxed(KEY.replace(flaps=Flaps(z=Flap(0.1, 0.9)))))
    before = hand.scene
    element, line = place_of(hand, MovablePoint(FLAP, FRONT, "key", "z", end))
    hand.drag((element, line), (element, line + 3), (element, beyond))
    assert hand.scene.lights["key"].flaps.z == Flap(other, other)
    assert hand.message == f"key: flap z, {end} {other:g}"
    assert is_undone_at_once(hand, before)


def test_the_views_are_rescaled_moved_and_fitted_to_everything_the_object_and_a_surface() -> None:
    hand = opened(boxes_scene(), shows_all=False)
    views = fitted_views(hand.scene.object_coordinates)
    assert screen_of(hand).views == views
    hand.pick("rescale", 0.95)
    assert screen_of(hand).views == views.zoomed(1.25)
    hand.viewer.on_pointer(20, 440, "wheel up", steps=2)
    views = views.zoomed(1.25).zoomed(1.25)
    assert screen_of(hand).views == views
    # A drag beside everything moves the three views together.
    hand.drag((20, 440), (40, 420))
    assert screen_of(hand).views == views.panned(FRONT, 20, -20)
    hand.viewer.session.choose_surface("box 1")
    for label, share, points, shown in (
        ("fit all", 0.25, shown_points(hand.scene), "everything"),
        ("fit all", 0.75, hand.scene.object_coordinates, "the object"),
        ("fit surface", 0.25, hand.scene.mesh.coordinates_of_parts([1]), "box 1"),
    ):
        hand.pick(label, share)
        assert screen_of(hand).views == fitted_views(points)
        assert hand.message == f"the views show {shown}"
    assert hand.scene is hand.viewer.studio.history.start


def test_a_scene_without_polygons_and_lights_has_three_views_that_stay() -> None:
    mesh = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    hand = opened(scene_of(mesh, lights=[]))
    views = screen_of(hand).views
    hand.pick("fit surface")
    assert screen_of(hand).views is views
    assert {movable_of(each).what for each in hand.viewer.board.content.handles} == {EYE, TARGET}


def test_angle_frame_a_drag_and_the_wheel_change_the_view_by_one_step_each() -> None:
    hand = opened(boxed(KEY))
    before = hand.scene
    hand.pick("angle", 0.95)
    assert hand.message == "angle 5 degrees"
    assert hand.scene.view == before.view.replace(angle=5.0)
    assert is_undone_at_once(hand, before)
    acts: tuple[Callable[[], object], ...] = (
        lambda: hand.pick("frame"),
        lambda: hand.drag(MIDDLE, (MIDDLE[0] + 5, MIDDLE[1]), (MIDDLE[0] + 20, MIDDLE[1] + 10)),
        lambda: hand.viewer.on_pointer(*MIDDLE, "wheel up"),
    )
    for act in acts:
        act()
        assert hand.scene.view.eye != before.view.eye
        assert is_undone_at_once(hand, before)


def test_the_message_line_tells_what_is_where_the_pointer_is() -> None:
    hand = opened(boxed(KEY))
    for place, hint in (
        (place_of(hand, MovablePoint(EYE, TOP)), "eye: x -2  y -3  z 2: drag it, or click"),
        (MIDDLE, "The view: "),
        ((250, 228), screen_of(hand).help),
    ):
        hand.move(*place)
        assert hand.hint.startswith(hint)
    # The front names the views.
    for front, name in (("x", "right: x "), ("-y", "front: x "), ("unknown", "from -y: x ")):
        hand.choose("front", front)
        assert hand.scene.front == (None if front == "unknown" else front)
        hand.viewer.tell("")
        hand.move(20, 440)
        assert hand.hint.startswith(name)


def test_pointing_sends_the_message_and_the_mark_alone_and_a_drag_the_small_picture_and_lines() -> None:
    hand = opened(boxed(KEY, FILL))
    hand.move(20, 440)
    display = hand.display
    before = display.words_received
    hand.move(*place_of(hand, MovablePoint(LIGHT, TOP, "key")))
    assert display.words_received - before < 200
    hand.grab(*place_of(hand, MovablePoint(LIGHT, TOP, "key")))
    hand.move(*(100, 90))
    before = display.words_received
    hand.move(104, 95)
    # Each line is taken away with the small area around it.
    assert 232 * 174 < display.words_received - before < 232 * 174 + 30_000


def test_a_click_turns_to_the_lines_that_the_eye_sees_and_another_back_to_the_picture() -> None:
    hand = opened(boxed(KEY))

    def quarter(scene: Scene) -> Words:
        hand.viewer.session.edit(scene)
        hand.move(20, 440)
        hand.viewer.tell("")
        return hand.display.words[:230, 260:500].copy()

    scene = hand.scene
    picture = quarter(scene)
    hand.click(*MIDDLE)
    lines = quarter(scene)
    # The outline and the three edges in the middle of a cube are seen, and the nine edges behind are not.
    assert 300 < (lines == LIGHT_GRAY).sum() < 500
    assert 100 < (lines == GRAY).sum() < 300
    assert not np.array_equal(quarter(scene.with_view(angle=30.0)), lines)
    # On a stage that is made, the object has the same lines.
    assert (quarter(scene.replace(stage="bowl"))[lines == LIGHT_GRAY] == LIGHT_GRAY).all()
    hand.click(*MIDDLE)
    assert np.array_equal(quarter(scene), picture)


@pytest.mark.parametrize("what", [EYE, LIGHT])
def test_an_arrow_at_the_edge_follows_the_pointer_and_brings_its_point_nearer(what: str) -> None:
    for side in SIDES:
        hand = opened(boxed(KEY), shows_all=False)
        movable = MovablePoint(what, side, "key" if what == LIGHT else "")
        views = screen_of(hand).views
        start = point_of(hand, movable)
        element, line = place_of(hand, movable)
        middle = views.position(side, (0.5, 0.5, 0.5))
        # Along the edge, the arrow stays under the pointer.
        along = (0, 9) if element in (side.area.left + EDGE, side.area.right - EDGE) else (9, 0)
        place = element + along[0], line + along[1]
        hand.drag((element, line), place)
        assert place_of(hand, movable) == pytest.approx(place, abs=1)
        # Halfway to its aim, the point is halfway there, and its coordinate across the view stays.
        wanted, place = np.array(point_of(hand, movable)), place_of(hand, movable)
        wanted[[side.right, side.up]] = (wanted[[side.right, side.up]] + 0.5) / 2
        hand.drag(place, (round((place[0] + middle[0]) / 2), round((place[1] + middle[1]) / 2)))
        point = point_of(hand, movable)
        assert point == pytest.approx(wanted, abs=0.05)
        (across,) = {0, 1, 2} - {side.right, side.up}
        assert point[across] == start[across]


def test_the_chosen_light_has_rows_of_its_parameters_and_the_eye_has_none() -> None:
    hand = opened(boxed(KEY, FILL))

    def labels() -> list[str]:
        return [row.label for row in hand.viewer.board.layout.rows]

    parameters = ["kind", "concentration", "cone angle", "flaps"]
    first = labels().index("chosen light") + 1
    assert labels()[first : first + 4] == parameters
    hand.pick("eye")
    assert {"chosen light", *parameters}.isdisjoint(labels())
    assert screen_of(hand).chosen == ""
    hand.pick("2 fill", 0.3)
    assert "kind" in labels()
    assert screen_of(hand).chosen == hand.viewer.session.light_name == "fill"
    hand.pick("1 key", 0.95)
    assert not hand.scene.lights["key"].on


# The aims of the coupe's lights are a few pixels from each other when the screen opens.


@pytest.fixture
def coupe() -> Hand:
    return opened(read_scene(Path(__file__).parents[4] / "scenes/coupe"))


def signs_of(hand: Hand) -> list[Handle]:
    return [each for each in hand.viewer.board.content.handles if not each.sign.is_empty]


def test_lights_and_aims_that_are_close_together_are_told_apart_by_numerals(coupe: Hand) -> None:
    aims = [each for each in signs_of(coupe) if "aim" in each.label]
    assert len(aims) == 4 * len(SIDES)
    apart = [max(abs(a.element - b.element), abs(a.line - b.line)) for a, b in combinations(aims, 2)]
    assert sum(distance <= 10 for distance in apart) > 5
    for one, other in combinations(signs_of(coupe), 2):
        assert not one.sign.overlaps(other.sign)
    for handle in signs_of(coupe):
        for place in (handle.sign[:2], handle.sign[2:]):
            coupe.move(*place)
            # The second cursor marks the point itself.
            assert coupe.viewer.board.mark == (handle.element, handle.line)
            assert coupe.viewer.board.messages[0].text.startswith(handle.label)


def test_a_drag_of_a_numeral_moves_its_point_as_far_as_the_pointer(coupe: Hand) -> None:
    before = coupe.scene
    for light in ("key", "rim"):
        aim = MovablePoint(AIM, SIDE, light)
        handle = handle_of(coupe, aim)
        element, line = handle.sign.left + 3, handle.sign.top + 4
        coupe.drag((element, line), (element + 9, line - 7), (element + 20, line - 15))
        assert place_of(coupe, aim) == (handle.element + 20, handle.line - 15)
        assert [one.name for one in coupe.scene.lights if one not in before.lights] == [light]
        assert is_undone_at_once(coupe, before)


LIGHTS = (
    KEY.replace(cone_angle=20.0, flaps=Flaps(x=Flap(-0.93, 1.37), y=Flap(-2.13), z=Flap(0.21, on=False))),
    Light("spot", (-1.13, 2.17, 1.71), direction=(0.31, -0.72, -0.45), cone_angle=37.0),
    Light("lamp", (-3.19, -3.07, 1.03), intensity=0.5, on=False),
    Light("wide", (1.07, 1.91, 2.59), aim=(0.53, 0.49, 0.51), cone_angle=110.0),
    Light("far", (41.3, 2.3, 1.7), aim=(0.5, 0.5, 0.5)),
    Light("rider", (0.31, 0.17, 0.23), direction=(0.1, 1.0, 0.3), follows="eye"),
)

# If the views change on purpose, look at them, and copy the new numbers from the failure.
DRAWN = {
    "all lights": 3960272845,
    "held": 3520680427,
    "the eye and the mesh": 3818525958,
    "nearer": 3889551925,
    "the coupe": 2845751936,
}


def test_the_views_are_drawn_as_they_were(coupe: Hand) -> None:
    hand = opened(boxed(*LIGHTS))
    hand.pick("fit all", 0.75)
    hand.pick("rescale", 0.05)
    found = {}

    def note(name: str) -> None:
        hand.move(20, 440)
        hand.viewer.tell("")
        found[name] = drawing_on(hand.display)

    note("all lights")
    hand.click(*place_of(hand, MovablePoint(LIGHT, FRONT, "spot")))
    note("held")
    hand.press("escape")
    hand.pick("eye")
    hand.click(*MIDDLE)
    while hand.viewer.board.content.idle():
        pass
    note("the eye and the mesh")
    hand.pick("1 key", 0.3)
    for _ in range(5):
        hand.pick("rescale", 0.95)
    note("nearer")
    hand = coupe
    note("the coupe")
    assert found == DRAWN
