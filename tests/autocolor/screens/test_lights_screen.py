from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor import Flap, HalfSpace, Light, View
from autocolor.scene.arrangements import ARRANGEMENTS, arranged
from autocolor.scene.changes import LightChanges
from autocolor.scene.columns import keys_of
from autocolor.scene.following import detached
from autocolor.screens.light_parameters import AIM, DIRECTION, POINT
from autocolor.screens.lights_screen import LIGHTS_A_PAGE, places_of
from autocolor.widgets.items import SCREEN, YELLOW
from autocolor.widgets.menu import WORK
from tests.autocolor.screens.boxes import hand_at, hint_of, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand
from tests.closeness import all_close
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


CLICKS: dict[str, tuple[list[tuple[str, float]], LightChanges]] = {
    "off": ([("on", BOX)], {"on": False}),
    "a new cone": ([("cone angle", BOX), ("cone angle", BOX)], {"cone_angle": 30.0}),
    "a flap off": ([("flaps x", BOX)], {"flaps": {"x": {"on": False}}}),
    "a new flap": ([("flaps", 0.9)], {"flaps": {"y": Flap()}}),
    "one list after the other": (
        [("only surfaces", BOX), ("except surfaces", BOX)],
        {"links": {"except_surfaces": []}},
    ),
    "a half-space off": ([("left", BOX)], {"half_spaces": {"left": {"on": False}}}),
    "a half-space turned": (
        [("  turn", 0.25)],
        {"half_spaces": {"left": {"direction": (-1.0, 0.0, -0.2)}}},
    ),
    "a half-space removed": ([("  turn", 0.75)], {"half_spaces": (TOP,)}),
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


def labels_of(hand: Hand) -> list[str]:
    return [row.label for row in hand.viewer.board.content.rows()]


def test_every_parameter_of_a_light_has_a_row_and_absent_controls_have_one_each(hand: Hand) -> None:
    assert [label for label in labels_of(hand) if "flap" in label or label[:2] in ("x ", "y ", "z ")] == [
        "flaps x", "x minimum", "x maximum", "x edge width",
        "flaps z", "z minimum", "z maximum", "z edge width", "flaps",
    ]  # fmt: skip
    assert hint_of(hand, "flaps") == "Add flaps y. The range of Y that is lit."
    assert "reach" not in labels_of(hand)
    session = hand.viewer.session
    session.edit(session.scene.with_light("key", half_spaces=[LEFT], falloff="linear", reach=3))
    labels = labels_of(hand)
    for name in {key.replace("_", " ") for key in keys_of(Light)} - {"direction", "half spaces"}:
        assert any(label.startswith(name) for label in labels), name
    assert {"left", "  edge width", "  carried"} <= set(labels)
    hand.pick("kind")
    assert {"direction x", "direction y", "direction z"} <= set(labels_of(hand))
    session.edit(session.scene.with_light("key", cone_angle=None))
    assert "inner angle" not in labels_of(hand)


# The kind of a light, what it follows, and what changes with its other parameters.

MIDDLE = (0.5, 0.5, 0.5)
SOFT = Light(
    "key", (2, -3, 4), aim=(0.5, 0.5, 1), concentration=2, cone_angle=30, inner_angle=25, at_infinity=True
)


def row(hand: Hand, label: str) -> Any:
    """A row of the menu, as it is now."""
    hand.viewer.tell("")
    return hand.widget(label)


def put_light(hand: Hand, light: Light) -> None:
    """Make a light the only one, as an edit."""
    hand.viewer.session.edit(boxes().replace(lights=[light]))


@pytest.mark.parametrize("light", [SOFT, SOFT.replace(direction=(1, 0, -1)), Light("key", SOFT.position)])
def test_every_kind_can_be_chosen_from_every_other(hand: Hand, light: Light) -> None:
    for kind in (POINT, AIM, DIRECTION):
        put_light(hand, light)
        row(hand, "kind").choose(kind)
        now = light_of(hand)
        assert row(hand, "kind").present == kind
        assert [now.aim is not None, now.direction is not None] == [kind == AIM, kind == DIRECTION]
        assert now == Light("key", SOFT.position) if kind == POINT else now.position == SOFT.position
        if light.axis is None and kind == AIM:
            assert now.aim == MIDDLE
        elif light.axis is not None and kind != POINT:
            assert now.axis == pytest.approx(light.axis)
            assert (now.concentration, now.cone_angle) == (2, 30)


def test_a_point_source_says_why_it_has_neither_cone_nor_concentration(hand: Hand) -> None:
    row(hand, "kind").choose(POINT)
    dim = [row.label for row in hand.viewer.board.content.rows() if row.why_not]
    assert dim == ["concentration", "cone angle", "at infinity"]
    before = hand.scene
    hand.pick("cone angle", BOX)
    assert told(hand) == ("cone angle: a point source has no axis; choose the kind aim first", True)
    hand.pull("concentration", 0.2, 0.8)
    assert hand.scene is before


@pytest.mark.parametrize(
    ("light", "aim"),
    [
        (Light("key", (0.5, 0.5, 4), direction=(0, 0, -2)), MIDDLE),
        (Light("key", (0.5, 0.5, 4), direction=(1, 0, 0)), (4, 0.5, 4)),
        # From the middle of the object a light is aimed down.
        (Light("key", MIDDLE), (0.5, 0.5, -0.5)),
    ],
)
def test_a_directed_light_is_aimed_ahead(hand: Hand, light: Light, aim: tuple[float, ...]) -> None:
    put_light(hand, light)
    row(hand, "kind").choose(AIM)
    assert light_of(hand).aim == pytest.approx(aim)


def test_a_light_can_follow_the_eye_and_each_light_with_an_aim_and_stays_where_it_is(hand: Hand) -> None:
    session = hand.viewer.session
    key, fill = SOFT.replace(at_infinity=False), Light("fill", (1, -2, 2), direction=(0, 1, -1))
    session.edit(boxes().replace(lights=[key, fill]).with_view(eye=(3, -5, 2), angle=20))
    assert row(hand, "follows").names == ("world", "eye")
    session.choose_light("fill")
    assert (row(hand, "follows").names, row(hand, "follows").present) == (("world", "eye", "key"), "world")
    before, picture = session.scene.lights_in_world["fill"], session.studio.picture.intensity
    for follows in ("eye", "key", "eye", "world"):
        row(hand, "follows").choose(follows)
        light = session.scene.lights_in_world["fill"]
        assert light_of(hand, "fill").follows == (None if follows == "world" else follows)
        assert light.position == pytest.approx(before.position)
        assert light.direction == pytest.approx(before.direction)
        assert row(hand, "follows").present == follows
        assert all_close(session.studio.picture.intensity, picture, abs=1e-5)
    # No light is offered that follows this one.
    row(hand, "follows").choose("key")
    row(hand, "kind").choose(AIM)
    session.choose_light("key")
    assert row(hand, "follows").names == ("world", "eye")
    # A light that follows gets an aim where it shines, and a direction from there.
    session.choose_light("fill")
    row(hand, "follows").choose("eye")
    for kind in (AIM, DIRECTION):
        row(hand, "kind").choose(kind)
        assert row(hand, "kind").present == kind
        assert session.scene.lights_in_world["fill"].axis == pytest.approx(before.axis)
    row(hand, "kind").choose(POINT)
    row(hand, "kind").choose(AIM)
    assert session.scene.lights_in_world["fill"].aim == pytest.approx(MIDDLE)


def test_choosing_a_falloff_gives_a_light_a_reach_and_keeps_one_that_it_has(hand: Hand) -> None:
    row(hand, "falloff").choose("quadratic")
    assert light_of(hand).reach == pytest.approx(hand.viewer.session.world.size)
    row(hand, "reach").put(7)
    row(hand, "falloff").choose("linear")
    assert (light_of(hand).reach, light_of(hand).falloff) == (7, "linear")


@pytest.mark.parametrize(("cone", "inner"), [(40, 25), (25, 25), (20, 20), (None, None)])
def test_the_inner_angle_stays_within_the_cone(hand: Hand, cone: float | None, inner: float | None) -> None:
    put_light(hand, SOFT)
    bar = row(hand, "cone angle")
    bar.put(cone) if cone else bar.flip()
    assert (light_of(hand).cone_angle, light_of(hand).inner_angle) == (cone, inner)


def chosen(hand: Hand) -> Any:
    """The name of the chosen light, as its row shows it."""
    return vars(hand.widget("light"))["present"]


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
    # Without a keyboard, nobody is asked for a name.
    assert not hand.viewer.board.typing.is_on
    if label == "mirror":
        # On the other side of the object.
        assert light_of(hand, name).position == (-1, -3, 4)
    hand.pull("intensity", 0.2, 0.4)
    assert light_of(hand) == KEY
    undo(hand)
    undo(hand)
    assert hand.scene is before


def test_a_new_light_is_named_by_return_and_is_one_step(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    before = hand.scene
    hand.pick("add", 0.75)
    assert hand.hint == "name of the light: key 2"
    # A name that is taken stays to be typed over.
    hand.type("key")
    hand.press("return")
    assert (told(hand)[1], hand.hint) == (True, "name of the light: key")
    hand.type("moon")
    hand.press("return")
    assert [light.name for light in hand.scene.lights] == ["key", "fill", "moon"]
    assert chosen(hand) == "moon"
    assert hand.viewer.studio.history.to_undo == (before,)
    hand.pick("add", 0.75)
    hand.press("escape")
    assert [light.name for light in hand.scene.lights][3:] == ["moon 2"]


def test_lights_are_removed_to_the_last_and_added_again(hand: Hand) -> None:
    hand.pick("mirror", 0.75)
    assert told(hand) == ("light key removed; undo brings it back", False)
    hand.pick("mirror", 0.75)
    assert not hand.scene.lights
    assert labels_of(hand) == ["add a light"]
    hand.pick("add a light")
    assert [light.name for light in hand.scene.lights] == ["light"]
    undo(hand)
    hand.pick("three-point")
    assert [light.name for light in hand.scene.lights] == ["key", "fill", "back"]


# The arrangements.


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_an_arrangement_is_seen_while_the_pointer_is_over_it_and_taken_by_a_click(
    hand: Hand, name: str
) -> None:
    before, studio = hand.scene, hand.viewer.studio
    seen = hand.display.words.copy()
    place = hand.middle(name)
    hand.move(*place)
    # It is no edit, and the marks of the present lights are away.
    assert hand.scene is before
    assert not studio.history.to_undo
    assert hand.hint == f"{ARRANGEMENTS[name].help}; a click replaces all lights."
    other = studio.image_of(arranged(before, name))
    beside = np.s_[300:460, :500]
    assert np.array_equal(hand.display.words[beside], other.words[beside])
    hand.move(300, 400)
    hand.viewer.tell("")
    hand.move(5, 40)
    assert np.array_equal(hand.display.words[beside], seen[beside])
    hand.click(*place)
    assert hand.scene.equals(arranged(before, name))
    assert chosen(hand) == hand.scene.lights[0].name
    # The lights can be dragged at once.
    assert any(each.label.startswith("highlight") for each in hand.viewer.board.content.handles)
    undo(hand)
    assert hand.scene is before


# Half-spaces.


def plane_of(hand: Hand) -> HalfSpace:
    return next(each for each in light_of(hand).half_spaces if each.name == "left")


def test_a_half_space_that_is_carried_from_now_on_stays_where_it_is(cut_hand: Hand) -> None:
    words = cut_hand.viewer.studio.words.copy()
    cut_hand.pick("  carried", BOX)
    assert plane_of(cut_hand).carried
    placed = detached(plane_of(cut_hand), light_of(cut_hand))
    assert placed.point == pytest.approx(LEFT.point)
    assert placed.direction == pytest.approx(LEFT.direction)
    assert (cut_hand.viewer.studio.words != words).mean() < 1e-3
    cut_hand.pick("  carried", BOX)
    assert not plane_of(cut_hand).carried
    assert plane_of(cut_hand).point == pytest.approx(LEFT.point)


def test_the_edge_of_a_half_space_is_dragged_in_the_picture(cut_hand: Hand) -> None:
    element, line = cut_hand.handle("end of the half-space left of key")
    seen = cut_hand.viewer.studio.seen_at(line, element + 30)
    assert seen is not None
    cut_hand.drag((element, line), (element + 15, line), (element + 30, line))
    moved = plane_of(cut_hand)
    assert moved.direction == LEFT.direction
    away = [a - b for a, b in zip(seen.point, moved.point, strict=True)]
    assert sum(a * b for a, b in zip(away, moved.direction, strict=True)) == pytest.approx(0, abs=1e-6)
    assert told(cut_hand)[0].startswith("left: x ")


PLACES = [(300, 300), (340, 330), (320, 200)]
"""Elements and lines at which the cube is seen, not in one line."""

PROMPT = "pick the {} point of the plane on the object; Esc ends"


def pick_points(hand: Hand, places: list[tuple[int, int]] = PLACES) -> None:
    hand.pick("half spaces")
    for place in places:
        hand.click(*place)


def test_three_points_of_the_object_make_a_half_space_in_one_step(hand: Hand) -> None:
    before = hand.scene
    seen = [hand.viewer.studio.seen_at(line, element) for element, line in PLACES]
    hand.pick("half spaces")
    for place, number in zip(PLACES, ("first", "second", "third"), strict=True):
        assert told(hand) == (PROMPT.format(number), False)
        hand.click(5, 400)
        assert told(hand) == (f"no point is seen there; {PROMPT.format(number)}", True)
        assert hand.scene is before
        hand.click(*place)
    assert told(hand) == ("half-space added to key: plane", False)
    (plane,) = light_of(hand).half_spaces
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
    planes = light_of(hand).half_spaces
    assert [plane.name for plane in planes] == ["plane", "plane 2"]
    for plane in planes:
        assert (np.array(light_of(hand).position) - plane.point) @ plane.direction > 0
    # A light from far away is where its rays come from, whatever its position.
    far = boxes().with_light(
        "key", position=(0, 9, 0), direction=(-2, -3, 1), at_infinity=True, cone_angle=None
    )
    hand.viewer.session.edit(far)
    hand.viewer.tell("")
    pick_points(hand)
    (plane,) = light_of(hand).half_spaces
    assert np.array((-2, -3, 1)) @ plane.direction < 0


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
    # Nothing else is grabbed meanwhile, and the points are marked.
    assert handles > 0 == len(hand.viewer.board.content.handles)
    hand.move(20, 400)
    hand.viewer.tell("")
    for element, line in PLACES[:2]:
        assert (hand.display.words[line - 5 : line + 6, element - 5 : element + 6] == YELLOW).any()
    middle = np.mean(PLACES[:2], axis=0).astype(int)
    assert (hand.display.words[middle[1] - 1 : middle[1] + 2, middle[0]] == YELLOW).any()
    assert (row(hand, "half spaces").value, row(hand, "half spaces").is_chosen) == ("2/3", True)
    ENDINGS[by](hand)
    assert hand.viewer.page == "lights"
    assert (row(hand, "half spaces").value, row(hand, "half spaces").is_chosen) == ("add", False)
    hand.click(*PLACES[2])
    assert light_of(hand).half_spaces == ()
    assert len(hand.viewer.board.content.handles) == handles


def test_a_third_point_that_is_refused_is_picked_again(hand: Hand) -> None:
    pick_points(hand, [PLACES[0], PLACES[1], PLACES[0]])
    assert told(hand)[0].startswith("half-space 'plane': its three points must not be in a line")
    assert light_of(hand).half_spaces == ()
    hand.click(*PLACES[2])
    assert [plane.name for plane in light_of(hand).half_spaces] == ["plane"]
    # Points for a light that is gone are forgotten.
    pick_points(hand, PLACES[:2])
    session = hand.viewer.session
    session.edit(session.scene.replace(lights=()))
    hand.click(*PLACES[2])
    assert not told(hand)[1]
    session.edit(boxes())
    hand.click(*PLACES[2])
    assert light_of(hand).half_spaces == ()


def test_points_behind_the_eye_have_no_place() -> None:
    view = View((0.0, -4.0, 0.0), direction=(0.0, 1.0, 0.0))
    points = np.array([(0.0, -9.0, 0.0), (0.0, 0.0, 0.0)])
    assert places_of(points, view).tolist() == [[SCREEN.width / 2 - 0.5, SCREEN.height / 2 - 0.5]]


# The light list.


def row_of(hand: Hand, name: str) -> list[Any]:
    """The name with its switch, the intensity and solo of a light in the list."""
    widgets = hand.viewer.board.widgets()
    number = next(n for n, each in enumerate(widgets) if each.key == f"light list.{name}.intensity")
    return list(widgets[number - 1 : number + 2])


def click_at(hand: Hand, name: str, part: int, share: float = 0.5) -> None:
    left, top, right, _ = row_of(hand, name)[part].area
    hand.click(left + share * (right - left), top + 8)


def test_the_list_shows_and_sets_every_light(hand: Hand) -> None:
    before = hand.scene
    switch, bar, solo = row_of(hand, "fill")
    assert (switch.label, switch.is_on, bar.value) == (" 2 fill", True, 0.5)
    assert not switch.is_chosen
    assert not solo.is_chosen
    click_at(hand, "fill", 0)
    assert chosen(hand) == "fill"
    assert row_of(hand, "fill")[0].is_chosen
    assert hand.scene is before
    click_at(hand, "fill", 0, BOX)
    assert light_of(hand, "fill") == before.lights["fill"].replace(on=False)
    click_at(hand, "key", 1, 0.3)
    assert light_of(hand).intensity not in (0, 1, 2)
    assert light_of(hand, "fill").intensity == 0.5
    left, top, *_ = row_of(hand, "fill")[1].area
    hand.move(left + 20, top + 5)
    hand.type("1.25")
    hand.press("return")
    assert light_of(hand, "fill").intensity == 1.25
    # A click on the name of the chosen light renames it, as one step.
    hand.viewer.session.has_keyboard = True
    before = hand.scene
    click_at(hand, "fill", 0, 0.3)
    hand.type("sky")
    hand.press("return")
    assert [light.name for light in hand.scene.lights] == ["key", "sky"]
    assert chosen(hand) == "sky"
    assert hand.viewer.studio.history.to_undo[-1] is before


def test_a_light_that_is_alone_gives_the_switches_of_all_lights_back(tmp_path: Path) -> None:
    scene = boxes().with_light("key", on=False).with_new_light("rim", position=(0, 0, 9))
    hand = hand_at(tmp_path, "lights", scene)

    def state(name: str) -> tuple[list[bool], bool]:
        """Whether each light is on, and whether the light is alone."""
        switches = [row_of(hand, light.name)[0].is_on for light in hand.scene.lights]
        assert switches == [light.on for light in hand.scene.lights]
        return switches, row_of(hand, name)[2].is_chosen

    click_at(hand, "key", 2)
    assert state("key") == ([True, False, False], True)
    assert hand.message == "light key alone; again: the lights as before"
    # Alone with another light, and back to the switches before both.
    click_at(hand, "rim", 2)
    assert state("key") == ([False, False, True], False)
    click_at(hand, "rim", 2)
    assert state("rim") == ([False, True, True], False)
    assert hand.message == "the lights are switched as before"
    undo(hand)
    assert state("rim")[1]
    # It is no longer alone when another is switched on.
    click_at(hand, "key", 0, BOX)
    assert not state("rim")[1]
    hand.pick("all lights on")
    assert state("rim")[0] == [True] * 3
    assert hand.message == "all lights on"


def test_the_list_has_pages_shows_the_chosen_light_and_folds(tmp_path: Path) -> None:
    lights = [KEY.replace(name=f"lamp {each}") for each in range(30)]
    hand = hand_at(tmp_path, "lights", boxes().replace(lights=lights))
    labels = [f"{number:2} lamp {number - 1}" for number in range(1, 31)]
    assert [label for label in hand.labels if label in labels] == labels[:LIGHTS_A_PAGE]
    assert WORK.covers(hand.widget("all lights on").area)
    hand.choose("light", "lamp 25")
    assert row_of(hand, "lamp 25")[0].is_chosen
    # Another page begins with the light that is then chosen.
    hand.pick("page", 0.05)
    assert chosen(hand) == "lamp 12"
    hand.pick("light list")
    assert not {*labels, *ARRANGEMENTS} & set(hand.labels)
    hand.pick("light list")
    assert row_of(hand, "lamp 12")[0].is_chosen


def test_the_list_covers_handles_which_are_free_when_panels_are_hidden(hand: Hand) -> None:
    place, end = (100, 60), hand.widget("all lights on").area
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
