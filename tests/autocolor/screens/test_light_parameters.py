from __future__ import annotations

import math
from pathlib import Path

import pytest

from autocolor import Light, Scene, scene_of
from autocolor.screens.light_parameters import (
    AIM,
    DIRECTION,
    POINT,
    aim_of,
    choose_kind,
    kind_of,
    parameter_rows,
    put_light,
)
from autocolor.screens.session import Session
from autocolor.studio import Studio
from autocolor.widgets.widget import Choice
from ramtek_emu import Ramtek9300
from tests.closeness import all_close
from tests.small import cube

AIMED = Light("key", (2.0, -3.0, 4.0), aim=(0.5, 0.5, 1.0), concentration=2.0, cone_angle=30.0)
SOFT = AIMED.replace(inner_angle=10, at_infinity=True)


def session_of(light: Light) -> Session:
    display = Ramtek9300()
    scene: Scene = scene_of(cube(), lights=[light])
    return Session(Studio(scene, display), display, Path())


def row_of(session: Session, label: str, name: str = "key") -> Choice:
    """A choice among the rows of a light."""
    rows = parameter_rows(session, session.scene.lights[name], ["kind", "follows", "falloff"])
    (row,) = [row for row in rows if isinstance(row, Choice) and row.label == label]
    return row


def test_every_kind_can_be_chosen_from_every_other() -> None:
    for kind in (POINT, AIM, DIRECTION):
        for light in (SOFT, SOFT.replace(direction=(1, 0, -1)), Light("key", AIMED.position)):
            session = session_of(light)
            choose_kind(session, light, kind)
            now = session.scene.lights["key"]
            assert kind_of(now) == kind
            assert [now.aim is not None, now.direction is not None] == [kind == AIM, kind == DIRECTION]
            assert now == Light("key", AIMED.position) if kind == POINT else now.position == light.position
            if light.axis is None and kind == AIM:
                assert now.aim == (0.5, 0.5, 0.5)
            elif light.axis is not None and kind != POINT:
                assert now.axis == pytest.approx(light.axis)
                assert (now.concentration, now.cone_angle) == (2.0, 30.0)


def test_a_directed_light_is_aimed_ahead_and_others_at_the_object() -> None:
    ahead = aim_of(Light("a", (0, 0, 4), direction=(0, 0, -2)), (-1, -1, -1), (1, 1, 1))
    assert ahead == pytest.approx((0, 0, 0))
    aside = aim_of(Light("a", (0, 0, 4), direction=(1, 0, 0)), (-1, -1, -1), (1, 1, 1))
    assert aside == pytest.approx((4, 0, 4))
    assert aim_of(Light("a", (0, 0, 4)), (-1, -1, -1), (3, 1, 1)) == (1, 0, 0)
    # From the middle of the object a light is aimed down.
    assert aim_of(Light("a", (0, 0, 0)), (-1, -1, -1), (1, 1, 1)) == (0, 0, -1)


def test_a_light_can_follow_the_eye_and_each_light_with_an_aim_and_stays_where_it_is() -> None:
    # A light beside the aimed one, in a view from the front and turned.
    scene = scene_of(cube(), lights=[AIMED, Light("fill", (1.0, -2.0, 2.0), direction=(0, 1, -1))])
    display = Ramtek9300()
    session = Session(Studio(scene.with_view(eye=(3, -5, 2), angle=20), display), display, Path())
    assert row_of(session, "follows").names == ("world", "eye")
    row = row_of(session, "follows", "fill")
    assert (row.names, row.present) == (("world", "eye", "key"), "world")
    before, picture = session.scene.lights_in_world["fill"], session.studio.picture.intensity
    for follows in ("eye", "key", "eye", "world"):
        row_of(session, "follows", "fill").choose(follows)
        light = session.scene.lights_in_world["fill"]
        assert session.scene.lights["fill"].follows == (None if follows == "world" else follows)
        assert light.position == pytest.approx(before.position)
        assert light.direction == pytest.approx(before.direction)
        assert row_of(session, "follows", "fill").present == follows
        assert all_close(session.studio.picture.intensity, picture, abs=1e-5)
    # No light is offered that follows this one.
    row_of(session, "follows", "fill").choose("key")
    choose_kind(session, session.scene.lights["fill"], AIM)
    assert row_of(session, "follows").names == ("world", "eye")
    # A light that follows gets an aim where it shines, and a direction from there.
    row_of(session, "follows", "fill").choose("eye")
    for kind in (AIM, DIRECTION):
        choose_kind(session, session.scene.lights["fill"], kind)
        assert kind_of(session.scene.lights["fill"]) == kind
        assert session.scene.lights_in_world["fill"].axis == pytest.approx(before.axis)
    choose_kind(session, session.scene.lights["fill"], POINT)
    choose_kind(session, session.scene.lights["fill"], AIM)
    assert session.scene.lights_in_world["fill"].aim == pytest.approx((0.5, 0.5, 0.5))


def test_choosing_a_falloff_gives_a_light_a_reach_and_keeps_one_that_it_has() -> None:
    session = session_of(AIMED)
    row_of(session, "falloff").choose("quadratic")
    assert session.scene.lights["key"].reach == pytest.approx(math.sqrt(3))
    put_light(session, "key", {"reach": 7})
    row_of(session, "falloff").choose("linear")
    assert session.scene.lights["key"].reach == 7
    assert session.scene.lights["key"].falloff == "linear"


@pytest.mark.parametrize(("cone", "inner"), [(40.0, 25.0), (25.0, 25.0), (20.0, 20.0), (None, None)])
def test_the_inner_angle_stays_within_the_cone(cone: float | None, inner: float | None) -> None:
    session = session_of(AIMED.replace(inner_angle=25.0))
    put_light(session, "key", {"cone_angle": cone})
    light = session.scene.lights["key"]
    assert (light.cone_angle, light.inner_angle) == (cone, inner)
