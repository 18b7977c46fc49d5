from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, InputError, Light, Mesh, Rig, Scene, Surface, scene_of
from autocolor.checks import Vector
from autocolor.scene.lights import Links, free_name, middle_between
from autocolor.testing import directions, numbers, some_of, vectors
from tests.autocolor.twins.point import cross, dot, minus
from tests.small import grid
from tests.tables import call, refused


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
    assert Light("key", position).axis is None
    if position == aim:
        return
    axis = Light("key", position, aim=aim).axis
    away = np.array(aim) - np.array(position)
    assert axis == pytest.approx(away / np.linalg.norm(away))


test_a_field_that_no_light_has_is_refused = refused(
    lambda changes: Light("key", (0, 0, 0)).replace(**changes),
    [
        (
            {name: "red"},
            f"light 'key': there is no field {name!r}; a light has no color here: set the surface's"
            " light_color",
        )
        for name in ("color", "colour", "light_color")
    ],
)

test_a_light_that_breaks_a_rule_is_refused_with_its_name = refused(
    lambda fields: Light(**{"name": "key", "position": (0, 0, 0), **fields}),
    [
        (fields, "\n".join(f"light 'key': {sentence}" for sentence in sentences))
        for fields, *sentences in (
            (
                {"concentration": 3, "cone_angle": 30, "at_infinity": True},
                *(
                    f"{name} must come with a direction or an aim, not with a point source; add an aim"
                    for name in ("concentration", "cone_angle", "at_infinity")
                ),
            ),
            (
                {"direction": (1, 0, 0), "aim": (1, 1, 1)},
                "it must have a direction or an aim, not both; leave one out",
            ),
            (
                {"aim": (0, 0, 0)},
                "the aim must differ from the position, (0.0, 0.0, 0.0); move one of them",
            ),
            (
                {"inner_angle": 10, "aim": (1, 1, 1)},
                "inner_angle must come with a cone, not without one; add a cone_angle",
            ),
            (
                {"inner_angle": 31, "cone_angle": 30, "aim": (1, 1, 1)},
                "inner_angle must be at most the cone_angle, 30, not 31; exchange them",
            ),
            ({"falloff": "linear"}, "falloff must come with a reach, not 'linear' alone; add a reach"),
            (
                {"falloff": "quadratic", "reach": 2, "at_infinity": True, "aim": (1, 1, 1)},
                "falloff must be 'none' for a light at infinity, not 'quadratic'; change one of them",
            ),
            ({"flaps": 3}, "flaps must be a table of x, y and z, not 3"),
            ({"flaps": {"w": None}}, "flaps: there is no field 'w'; choose 'x', 'y' or 'z'"),
            (
                {"flaps": {"x": {"minimum": 2, "maximum": 1}}},
                "flaps.x: the minimum must be at most the maximum, not 2 to 1; exchange them",
            ),
            (
                {
                    "links": {
                        "only_surfaces": ["a"],
                        "except_surfaces": [],
                        "only_parts": [],
                        "except_parts": [],
                    }
                },
                "except_surfaces must be absent where only_surfaces is given; leave one out",
                "except_parts must be absent where only_parts is given; leave one out",
            ),
        )
    ],
)


def test_the_controls_of_a_light_stand_at_their_limits() -> None:
    light = Light("key", (0, 0, 0), aim=(1, 1, 1), cone_angle=30, inner_angle=30)
    assert (light.cone_angle, light.inner_angle) == (30, 30)
    assert Flap(1, 1).minimum == 1
    assert Light("sun", (0, 0, 0), direction=(0, 0, -1), at_infinity=True, reach=3).falloff == "none"


def test_a_change_of_one_flap_leaves_its_other_columns_and_the_other_flaps() -> None:
    light = Light("key", (0, 0, 0), flaps=Flaps(x=Flap(0, 1), z=Flap(0.2, 1.0)))
    off = light.replace(flaps={"z": {"on": False}, "y": {"maximum": 2}})
    assert off.flaps == Flaps(Flap(0, 1), Flap(maximum=2), Flap(0.2, 1.0, on=False))
    assert off.replace(flaps={"z": {"on": True}, "y": None}) == light
    assert light.flaps.replace(x={"edge_width": 0.2}).x == Flap(0, 1, edge_width=0.2)


@given(vectors(), vectors(), vectors())
def test_the_plane_goes_through_all_three_points(a: Vector, b: Vector, c: Vector) -> None:
    assume(any(cross(minus(b, a), minus(c, a))))
    half_space = HalfSpace.through("left", a, b, c)
    assert half_space.point == a
    assert HalfSpace.through("left", a, b, c, on=False) == half_space.replace(on=False)
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


@given(vectors(), directions(), numbers(-3, 3))
def test_three_points_in_one_line_are_refused(a: Vector, toward: Vector, far: float) -> None:
    b, c = (tuple((np.array(a) + step * np.array(toward)).tolist()) for step in (1.0, far))
    with pytest.raises(InputError, match=r"^half-space 'left': its three points must not be in a line, "):
        HalfSpace.through("left", a, b, c)


test_points_without_a_plane_are_refused = refused(
    lambda points: HalfSpace.through("left", *points),
    [
        (
            ((0, 0, 0), (1, 2, 3), (2, 4, 6)),
            "half-space 'left': its three points must not be in a line, not (0.0, 0.0, 0.0), (1.0, 2.0, 3.0),"
            " (2.0, 4.0, 6.0); move one of them",
        ),
        (
            ((0, 0, 0), (1, 2), None),
            "half-space 'left': b must be three finite numbers of at most 1e36, not (1, 2)\n"
            "half-space 'left': c must be three finite numbers of at most 1e36, not None",
        ),
    ],
)


NAMES = ["body", "glass", "floor"]


def walls(names: str) -> Mesh:
    """Walls side by side, each a part named by a letter."""
    return Mesh.joined(
        [grid(1, 1, (2 * column, 0, 0), (2, 0, 0), (0, 0, 2), name) for column, name in enumerate(names)]
    )


def panels(**links: object) -> Scene:
    """Three walls side by side, two of them of one surface, under one light."""
    return scene_of(
        walls("abc"),
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


NOT_IN_PARTS = "is not in the part table; choose 'a', 'b' or 'c'"
SPARE = "light 'key': except_surfaces 'spare' is not in the surface table"


def linked_to_spare() -> Scene:
    """The walls under a light that excepts a surface which no part has."""
    scene = panels()
    scene = scene.replace(surfaces=(*scene.surfaces, Surface("spare")))
    return scene.with_light("key", except_surfaces=["spare"])


test_links_to_what_is_not_in_the_scene_are_refused_by_name = refused(
    call,
    [
        (
            lambda: panels().with_light("key", only_surfaces=["bodi"]),
            "light 'key': only_surfaces 'bodi' is not in the surface table; did you mean 'body'?",
        ),
        (
            lambda: panels().with_light("key", except_parts=["d"]),
            f"light 'key': except_parts 'd' {NOT_IN_PARTS}",
        ),
        (
            lambda: panels().with_light("key", links={"only_parts": ["d"]}),
            f"light 'key': only_parts 'd' {NOT_IN_PARTS}",
        ),
        (
            lambda: linked_to_spare().with_surface("spare", name="other"),
            f"{SPARE}; choose 'body', 'glass' or 'other'",
        ),
        (
            lambda: linked_to_spare().replace(surfaces=panels().surfaces),
            f"{SPARE}; choose 'body' or 'glass'",
        ),
        (
            lambda: panels(only_parts=["c"]).replace(mesh=walls("ab"), parts=panels().parts[:2]),
            "light 'key': only_parts 'c' is not in the part table; choose 'a' or 'b'",
        ),
    ],
)


def test_a_surface_is_renamed_together_with_the_links_to_it() -> None:
    scene = linked_to_spare()
    renamed = scene.replace(
        surfaces=(*scene.surfaces[:2], Surface("other")),
        lights=(scene.lights["key"].replace(except_surfaces=["other"]),),
    )
    assert renamed.lights["key"].links == Links(except_surfaces=("other",))


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
    assert scene.with_rig(rig).lights["rim"].links == left
    assert links.within(["body", "glass", "chrome"], ["a", "b", "z"]) == links


def test_the_middle_of_two_points_is_halfway_also_between_the_largest() -> None:
    assert middle_between((1, 2, -3), (3, 2, 5)) == (2, 2, 1)
    assert middle_between((1.5e308, 0, 0), (1.7e308, 0, 0)) == (1.6e308, 0, 0)


def test_a_name_that_is_a_number_alone_is_kept_whole() -> None:
    assert free_name("2", ["2"]) == "2 2"
