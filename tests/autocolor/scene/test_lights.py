from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    HalfSpace,
    InputError,
    Light,
    Mesh,
    Rig,
    Scene,
    Studio,
    Surface,
    read_journal,
    read_rig,
    read_scene,
    render,
    scene_of,
    write_rig,
    write_scene,
)
from autocolor.checks import Vector
from autocolor.explanation.point import cross, dot, minus
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.scene.columns import Tier
from autocolor.scene.lights import Links, free_name, middle_between
from autocolor.scene.scene import cost_of_edit
from autocolor.testing import directions, lights, numbers, some_of, vectors
from ramtek_emu import Ramtek9300
from tests.autocolor.journal.random_steps import journal_of
from tests.small import grid


@given(lights())
def test_a_light_keeps_what_it_is_given(light: Light) -> None:
    assert light.replace() == light
    assert light.replace(intensity=2).intensity == 2.0
    assert light.replace(intensity=2).replace(intensity=light.intensity) == light


@given(directions(), st.sampled_from([1e-300, 1e-20, 1.0, 1e20]))
def test_the_axis_is_a_unit_vector_however_long_the_direction_is(
    direction: tuple[float, float, float], size: float
) -> None:
    axis = Light("key", (0, 0, 0), direction=tuple(x * size for x in direction)).axis  # type: ignore[arg-type]
    assert axis is not None
    assert math.hypot(*axis) == pytest.approx(1)
    assert np.cross(axis, direction) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.dot(axis, direction) > 0


@given(vectors(), vectors())
def test_an_aim_follows_the_position(
    position: tuple[float, float, float], aim: tuple[float, float, float]
) -> None:
    if position == aim:
        return
    axis = Light("key", position, aim=aim).axis
    away = np.array(aim) - np.array(position)
    assert axis == pytest.approx(away / np.linalg.norm(away))


def test_a_light_with_neither_direction_nor_aim_is_a_point_source() -> None:
    assert Light("key", (0, 0, 0)).axis is None


def test_giving_a_direction_drops_the_aim_and_the_other_way_round() -> None:
    aimed = Light("key", (0, 0, 0), aim=(1, 0, 0))
    directed = aimed.replace(direction=(0, 1, 0))
    assert (directed.direction, directed.aim) == ((0.0, 1.0, 0.0), None)
    assert (directed.replace(aim=(0, 0, 1)).direction, directed.replace(aim=(0, 0, 1)).aim) == (
        None,
        (0, 0, 1),
    )


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"intensity": -1}, "light 'key': intensity must be a finite number of at least 0, not -1"),
        ({"intensity": math.nan}, "light 'key': intensity must be a finite number of at least 0, not nan"),
        (
            {"position": (1, 2)},
            "light 'key': position must be three finite numbers of at most 1e36, not (1, 2)",
        ),
        (
            {"direction": (0, 0, 0)},
            "light 'key': direction must have a length above 0, not (0, 0, 0); change it",
        ),
        ({"on": 1}, "light 'key': on must be true or false, not 1"),
        (
            {"cone_angle": 181, "aim": (1, 1, 1)},
            "light 'key': cone_angle must be a number above 0 and at most 180, not 181",
        ),
        (
            {"cone_angle": 0, "aim": (1, 1, 1)},
            "light 'key': cone_angle must be a number above 0 and at most 180, not 0",
        ),
        (
            {"concentration": 3},
            "light 'key': concentration must come with a direction or an aim, not with a point source;"
            " add an aim",
        ),
        (
            {"cone_angle": 30},
            "light 'key': cone_angle must come with a direction or an aim, not with a point source;"
            " add an aim",
        ),
        (
            {"direction": (1, 0, 0), "aim": (1, 1, 1)},
            "light 'key': it must have a direction or an aim, not both; leave one out",
        ),
        (
            {"aim": (0, 0, 0)},
            "light 'key': the aim must differ from the position, (0.0, 0.0, 0.0); move one of them",
        ),
        ({"flaps": 3}, "light 'key': flaps must be a table of x, y and z, not 3"),
        ({"flaps": {"w": None}}, "light 'key': flaps: there is no field 'w'; choose 'x', 'y' or 'z'"),
        (
            {"flaps": {"x": {"minimum": 2, "maximum": 1}}},
            "light 'key': flaps.x: the minimum must be at most the maximum, not 2 to 1; exchange them",
        ),
    ],
)
def test_a_light_that_breaks_a_rule_is_refused_with_its_name(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        Light(**{"name": "key", "position": (0, 0, 0), **fields})
    assert str(refusal.value) == sentence


def test_all_problems_of_a_light_are_told_at_once() -> None:
    with pytest.raises(InputError) as refusal:
        Light("key", (1, 2), intensity=-1, on=0)  # type: ignore[arg-type]
    assert len(refusal.value.problems) == 3


@pytest.mark.parametrize("name", ["", 3, None])
def test_a_light_must_have_a_name(name: Any) -> None:
    with pytest.raises(InputError, match=r"light: name must be a string of at least one character, not"):
        Light(name, (0, 0, 0))


def test_switching_a_flap_off_keeps_its_minimum_and_maximum() -> None:
    light = Light("key", (0, 0, 0), flaps=Flaps(z=Flap(0.2, 1.0)))
    off = light.replace(flaps={"z": {"on": False}})
    assert off.flaps.z == Flap(0.2, 1.0, on=False)
    assert off.replace(flaps={"z": {"on": True}}) == light


def test_changing_one_flap_leaves_the_others() -> None:
    light = Light("key", (0, 0, 0), flaps=Flaps(x=Flap(0, 1), z=Flap(0.2, 1.0)))
    changed = light.replace(flaps={"x": {"minimum": 0.5}, "y": {"maximum": 2}})
    assert changed.flaps == Flaps(Flap(0.5, 1), Flap(maximum=2), Flap(0.2, 1.0))
    assert light.replace(flaps={"x": None}).flaps.x is None


@pytest.mark.parametrize(
    "flap",
    [
        {"minimum": math.nan},
        {"minimum": "1"},
        {"maximum": True},
        {"minimum": math.inf},
        {"maximum": -math.inf},
        {"on": 1},
    ],
)
def test_a_flap_that_breaks_a_rule_is_refused(flap: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"flap: (minimum|maximum|on) must be .*, not "):
        Flap(**flap)


def test_a_flap_takes_numbers_of_any_kind() -> None:
    assert Flap(np.float32(0.5), np.int64(2)) == Flap(0.5, 2.0)  # type: ignore[arg-type]


def test_an_unknown_field_of_a_flap_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="there is no field 'minimun'; did you mean 'minimum'"):
        Flap().replace(minimun=3)  # type: ignore[call-arg]


def test_a_flap_has_sharp_edges_and_no_ends_unless_they_are_given() -> None:
    assert (Flap().minimum, Flap().maximum, Flap().on, Flap().edge_width) == (-math.inf, math.inf, True, 0)


@pytest.mark.parametrize("width", [-0.1, math.inf, math.nan])
def test_an_edge_width_is_a_number_from_0_on(width: float) -> None:
    with pytest.raises(InputError, match=r"^flap: edge_width must be a finite number of at least 0"):
        Flap(0, 1, edge_width=width)


def test_a_minimum_above_the_maximum_is_refused() -> None:
    message = r"^flap: the minimum must be at most the maximum, not 2 to 1; exchange them$"
    with pytest.raises(InputError, match=message):
        Flap(2, 1)


def test_a_table_changes_the_edge_width_of_one_flap_alone() -> None:
    flaps = Flaps(x=Flap(0, 1), z=Flap(minimum=0.5))
    assert flaps.replace(x={"edge_width": 0.2}) == Flaps(x=Flap(0, 1, edge_width=0.2), z=Flap(minimum=0.5))


@given(vectors(), vectors(), vectors())
def test_the_plane_goes_through_all_three_points(a: Vector, b: Vector, c: Vector) -> None:
    assume(any(cross(minus(b, a), minus(c, a))))
    half_space = HalfSpace.through("left", a, b, c)
    assert half_space.point == a
    assert math.hypot(*half_space.direction) == pytest.approx(1)
    for point in (b, c):
        assert dot(minus(point, a), half_space.direction) == pytest.approx(0, abs=1e-12)


@given(vectors(), vectors(), vectors(), directions())
def test_from_the_lit_side_the_points_turn_counterclockwise(
    a: Vector, b: Vector, c: Vector, eye: Vector
) -> None:
    # As an eye sees them: to its left of the way from a to b is c.
    turn = dot(cross(minus(b, a), minus(c, a)), minus(eye, a))
    assume(abs(turn) > 1e-6)
    is_lit = dot(minus(eye, a), HalfSpace.through("left", a, b, c).direction) > 0
    assert is_lit == (turn > 0)
    assert HalfSpace.through("left", a, c, b).direction == pytest.approx(
        [-each for each in HalfSpace.through("left", a, b, c).direction]
    )


@pytest.mark.parametrize("size", [1e-150, 1e-20, 1.0, 1e20, 1e36])
def test_the_size_of_the_triangle_does_not_matter(size: float) -> None:
    points = [(0.0, 0.0, 0.0), (size, 0.0, 0.0), (0.0, size, size)]
    direction = HalfSpace.through("left", *points).direction
    assert direction == pytest.approx((0, -math.sqrt(0.5), math.sqrt(0.5)))


@given(vectors(), directions(), numbers(-3, 3))
def test_three_points_in_one_line_are_refused(a: Vector, toward: Vector, far: float) -> None:
    b, c = (tuple((np.array(a) + step * np.array(toward)).tolist()) for step in (1.0, far))
    with pytest.raises(InputError, match=r"^half-space 'left': its three points must not be in a line, "):
        HalfSpace.through("left", a, b, c)


@pytest.mark.parametrize("wrong", [(1, 2), "x", (math.nan, 0, 0), None])
def test_a_point_that_is_none_is_refused_by_its_letter(wrong: Any) -> None:
    with pytest.raises(InputError, match=r"^half-space 'left': b must be three finite numbers"):
        HalfSpace.through("left", (0, 0, 0), wrong, (0, 1, 0))


def test_further_fields_are_given_with_the_points() -> None:
    half_space = HalfSpace.through("left", (0, 0, 1), (1, 0, 1), (0, 1, 1), edge_width=0.2, on=False)
    assert half_space == HalfSpace("left", (0, 0, 1), (0, 0, 1), edge_width=0.2, on=False)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"direction": (0, 0, 0)}, "direction must have a length above 0, not (0, 0, 0); change it"),
        ({"edge_width": -1}, "edge_width must be a finite number of at least 0, not -1"),
        ({"carried": 2}, "carried must be true or false, not 2"),
    ],
)
def test_an_invalid_half_space_is_refused(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as refusal:
        HalfSpace("left", **{"point": (0, 0, 0), "direction": (1, 0, 0), **fields})
    assert str(refusal.value).startswith(f"half-space 'left': {message}")


NAMES = ["body", "glass", "floor"]


def panels(**links: object) -> Scene:
    """Three walls side by side, two of them of one surface, under one light."""
    rows = [grid(1, 1, (2 * column, 0, 0), (2, 0, 0), (0, 0, 2), name) for column, name in enumerate("abc")]
    return scene_of(
        Mesh.joined(rows),
        surfaces=[Surface("body"), Surface("glass")],
        surface_of_part={"a": "body", "b": "body", "c": "glass"},
        lights=[Light("key", (3, -4, 1), links=links)],  # type: ignore[arg-type]
    )


@given(some_of(NAMES), some_of(NAMES))
def test_a_light_shines_on_what_is_named_or_on_all_but_what_is_excepted(
    some: tuple[str, ...], others: tuple[str, ...]
) -> None:
    for name in NAMES:
        assert Links().shines_on_surface(name)
        assert Links(only_surfaces=some).shines_on_surface(name) == (name in some)
        assert Links(except_surfaces=some).shines_on_surface(name) == (name not in some)
    assert Links().lit_parts(NAMES) == {*NAMES}
    assert Links(only_parts=others).lit_parts(NAMES) == {*others}
    assert Links(except_parts=others).lit_parts(NAMES) == {*NAMES} - {*others}
    assert Links(only_parts=(*others, "elsewhere")).lit_parts(NAMES) == {*others}


@pytest.mark.parametrize("what", ["surfaces", "parts"])
def test_names_and_excepted_names_do_not_come_together(what: str) -> None:
    with pytest.raises(InputError) as refused:
        Links(**{f"only_{what}": ("a",), f"except_{what}": ("b",)})
    assert f"except_{what} must be absent where only_{what} is given; leave one out" in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"only_surfaces": ["bodi"]},
            "light 'key': only_surfaces 'bodi' is not in the surface table; did you mean 'body'?",
        ),
        ({"except_parts": ["d"]}, "light 'key': except_parts 'd' is not in the part table"),
        ({"links": Links(only_parts=("a", "d"))}, "light 'key': only_parts 'd' is not in the part table"),
        ({"links": {"only_parts": ["d"]}}, "light 'key': only_parts 'd' is not in the part table"),
    ],
)
def test_what_is_not_in_the_scene_is_refused_by_name(changes: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        panels().with_light("key", **changes)  # type: ignore[arg-type]
    assert str(refused.value).startswith(sentence)


def test_a_surface_that_a_light_is_linked_to_is_not_renamed_nor_removed_alone() -> None:
    scene = panels()
    scene = scene.replace(surfaces=(*scene.surfaces, Surface("spare")))
    scene = scene.with_light("key", except_surfaces=["spare"])
    sentence = "light 'key': except_surfaces 'spare' is not in the surface table"
    with pytest.raises(InputError) as refused:
        scene.with_surface("spare", name="other")
    assert str(refused.value).startswith(sentence)
    with pytest.raises(InputError) as refused:
        scene.replace(surfaces=scene.surfaces[:2])
    assert str(refused.value).startswith(sentence)
    renamed = scene.replace(
        surfaces=(*scene.surfaces[:2], Surface("other")),
        lights=(scene.light("key").replace(except_surfaces=["other"]),),
    )
    assert renamed.light("key").links == Links(except_surfaces=("other",))


def test_another_mesh_without_a_part_that_a_light_is_linked_to_is_refused() -> None:
    scene = panels(only_parts=["c"])
    fewer = panels()
    rows = [grid(1, 1, (2 * column, 0, 0), (2, 0, 0), (0, 0, 2), name) for column, name in enumerate("ab")]
    with pytest.raises(InputError) as refused:
        scene.replace(mesh=Mesh.joined(rows), parts=fewer.parts[:2])
    assert str(refused.value).startswith("light 'key': only_parts 'c' is not in the part table")


def test_links_to_surfaces_cost_the_sum_and_links_to_parts_the_light() -> None:
    scene = panels()
    for field in ("only_surfaces", "except_surfaces"):
        linked = scene.with_light("key", **{field: ["glass"]})  # type: ignore[arg-type]
        assert cost_of_edit(scene, linked) == cost_of_edit(linked, scene) == Tier.MIX
    for field in ("only_parts", "except_parts"):
        linked = scene.with_light("key", **{field: ["a"]})  # type: ignore[arg-type]
        assert cost_of_edit(scene, linked) == cost_of_edit(linked, scene) == Tier.LIGHT


@pytest.mark.parametrize(
    ("links", "left"),
    [
        (Links(), Links()),
        (Links(only_surfaces=("body", "chrome")), Links(only_surfaces=("body",))),
        (Links(except_surfaces=("chrome",)), Links()),
        (Links(only_surfaces=("chrome",), except_parts=("b", "z")), Links(except_parts=("b",))),
        (Links(only_parts=("z",), except_surfaces=()), Links(except_surfaces=())),
        (Links(only_parts=()), Links(only_parts=())),
    ],
)
def test_a_rig_leaves_out_the_links_to_what_a_scene_does_not_have(links: Links, left: Links) -> None:
    scene = panels()
    rig = Rig(*scene.object_bounds, (Light("rim", (3, -4, 1), links=links),))
    assert scene.with_rig(rig).light("rim").links == left
    assert links.within(["body", "glass", "chrome"], ["a", "b", "z"]) == links


def test_links_are_kept_by_scene_files_and_rig_files(tmp_path: Path) -> None:
    scene = panels(only_surfaces=["body", "glass"], except_parts=["a"])
    write_scene(tmp_path / "scene", scene)
    again = read_scene(tmp_path / "scene")
    assert again.lights == scene.lights
    assert render(again, 12, 16).intensity.tobytes() == render(scene, 12, 16).intensity.tobytes()
    write_rig(tmp_path / "rig.toml", scene)
    assert read_rig(tmp_path / "rig.toml").lights == scene.lights


def test_links_are_undone_and_told_by_the_journal(tmp_path: Path) -> None:
    source = Source(str(tmp_path / "scene"))
    write_scene(source.path, panels())
    studio = Studio(History(read_scene(source.path), place_of(source)), Ramtek9300())
    before = studio.words.copy()
    studio.light("key", only_surfaces=["glass"])
    assert (studio.words != before).any()
    studio.light("key", only_surfaces=None, except_parts=["b"])
    history = read_journal(journal_of(studio.history, tmp_path)).history
    assert history.scene.light("key").links == Links(except_parts=("b",))
    assert (Studio(history, Ramtek9300()).words == studio.words).all()
    studio.undo()
    assert studio.scene.light("key").links == Links(only_surfaces=("glass",))
    studio.undo()
    assert (studio.words == before).all()


def test_the_middle_of_two_points_is_halfway_also_between_the_largest() -> None:
    assert middle_between((1, 2, -3), (3, 2, 5)) == (2, 2, 1)
    assert middle_between((1.5e308, 0, 0), (1.7e308, 0, 0)) == (1.6e308, 0, 0)


@given(
    st.lists(st.sampled_from(["key", "key 2", "key 3", "key 4", "rim"])), st.sampled_from(["key", "key 2"])
)
def test_a_free_name_is_not_taken_and_keeps_the_word(taken: list[str], name: str) -> None:
    free = free_name(name, taken)
    assert free not in taken
    assert free.startswith("key")
    assert (free == name) == (name not in taken)


def test_a_name_that_is_a_number_alone_is_kept_whole() -> None:
    assert free_name("2", ["2"]) == "2 2"
