from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light
from tests.autocolor.strategies import directions, lights, vectors


@given(lights())
def test_a_light_keeps_what_it_is_given(light: Light) -> None:
    assert light.replace() == light
    assert light.replace(intensity=2).intensity == 2.0
    assert light.replace(intensity=2).replace(intensity=light.intensity) == light


@given(directions, st.sampled_from([1e-300, 1e-20, 1.0, 1e20]))
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
            "light 'key': direction must not be zero, not (0, 0, 0); give it a length",
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
            "light 'key': the aim must not be the position, not both (0.0, 0.0, 0.0); move one of them",
        ),
        ({"flaps": 3}, "light 'key': flaps must be a table of x, y and z, not 3"),
        ({"flaps": {"w": None}}, "light 'key': flaps: there is no 'w'; known are 'x', 'y', 'z'"),
        (
            {"flaps": {"x": {"minimum": 2, "maximum": 1}}},
            "light 'key': flaps.x: the minimum must not be above the maximum, not 2 to 1; exchange them",
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
    with pytest.raises(InputError, match="there is no 'minimun'; did you mean 'minimum'"):
        Flap().replace(minimun=3)  # type: ignore[call-arg]
