from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Light, Scene, scene_of
from autocolor.screens.lights.light_parameters import (
    AIM,
    DIRECTION,
    NEEDS_AXIS,
    POINT,
    aim_of,
    choose_kind,
    kind_of,
    parameter_rows,
    put_light,
)
from autocolor.screens.session import Session
from autocolor.studio import Studio
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import cube

AIMED = Light("key", (2.0, -3.0, 4.0), aim=(0.5, 0.5, 1.0), concentration=2.0, cone_angle=30.0)


def session_of(light: Light) -> Session:
    display = Ramtek9300()
    scene: Scene = scene_of(cube(), lights=[light])
    return Session(Studio(scene, display), display, Path())


def test_the_kind_of_a_light_is_told_by_what_it_has() -> None:
    assert kind_of(AIMED) == AIM
    assert kind_of(AIMED.replace(direction=(0, 0, -1))) == DIRECTION
    assert kind_of(Light("key", (0.0, 0.0, 0.0))) == POINT


def test_the_row_of_the_kind_stands_before_what_only_some_kinds_have() -> None:
    session = session_of(AIMED)
    for leave_out in ([], ["name", "position"]):
        labels = [row.label for row in parameter_rows(session, AIMED, leave_out)]
        assert labels[labels.index("kind") - 1 : labels.index("kind") + 2] == ["on", "kind", "aim x"]
    without = parameter_rows(session, AIMED, ["aim", "concentration", "cone_angle", "flaps"])
    assert [row.label for row in without][-1] == "kind"


def test_every_kind_can_be_chosen_from_every_other() -> None:
    for kind in (POINT, AIM, DIRECTION):
        for light in (AIMED, AIMED.replace(direction=(1, 0, -1)), Light("key", (2.0, -3.0, 4.0))):
            session = session_of(light)
            choose_kind(session, light, kind)
            assert kind_of(session.scene.light("key")) == kind
            assert session.scene.light("key").position == light.position


def test_a_light_that_gets_an_aim_is_aimed_at_the_middle_of_the_object() -> None:
    session = session_of(Light("key", (2.0, -3.0, 4.0)))
    choose_kind(session, session.scene.light("key"), AIM)
    assert session.scene.light("key").aim == (0.5, 0.5, 0.5)


def test_a_light_that_gets_a_direction_shines_where_it_did() -> None:
    session = session_of(AIMED)
    choose_kind(session, AIMED, DIRECTION)
    light = session.scene.light("key")
    assert light.axis == pytest.approx(AIMED.axis)
    assert (light.concentration, light.cone_angle) == (2.0, 30.0)


def test_a_point_source_has_no_concentration_and_no_cone() -> None:
    session = session_of(AIMED)
    choose_kind(session, AIMED, POINT)
    light = session.scene.light("key")
    assert (light.concentration, light.cone_angle) == (0.0, None)
    dim = {row.label for row in parameter_rows(session, light) if row.why_not == NEEDS_AXIS}
    assert dim == {"concentration", "cone angle"}
    assert not any(row.why_not for row in parameter_rows(session, AIMED))


def test_the_row_of_the_kind_goes_on_to_the_next() -> None:
    session = session_of(AIMED)
    (row,) = [row for row in parameter_rows(session, AIMED) if row.label == "kind"]
    row.nudge(1)
    assert kind_of(session.scene.light("key")) == DIRECTION


def test_a_light_that_gets_another_name_stays_chosen() -> None:
    session = session_of(AIMED)
    put_light(session, "key", {"name": "sun"})
    assert session.light_name == "sun"


def test_a_directed_light_is_aimed_ahead() -> None:
    ahead = aim_of(Light("a", (0, 0, 4), direction=(0, 0, -2)), (-1, -1, -1), (1, 1, 1))
    assert ahead == pytest.approx((0, 0, 0))
    aside = aim_of(Light("a", (0, 0, 4), direction=(1, 0, 0)), (-1, -1, -1), (1, 1, 1))
    assert aside == pytest.approx((4, 0, 4))
    assert aim_of(Light("a", (0, 0, 4)), (-1, -1, -1), (3, 1, 1)) == (1, 0, 0)


def test_a_light_in_the_middle_of_the_object_is_aimed_down() -> None:
    assert aim_of(Light("a", (0, 0, 0)), (-1, -1, -1), (1, 1, 1)) == (0, 0, -1)
