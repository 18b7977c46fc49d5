from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Light
from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.screens.light_and_view.cone_outline import RIM_SIDES, cone_outline
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDES, TOP, OrthographicViews, Side
from tests.autocolor.strategies import directions, numbers, vectors

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def rim_of(light: Light, end: Vector) -> Floats:
    """Many points of the rim: on the cone, as far from the light as the end."""
    assert light.axis is not None
    assert light.cone_angle is not None
    axis = np.array(light.axis)
    one = np.cross(axis, (0.3, -0.5, 0.8))
    one /= np.linalg.norm(one)
    turns = np.linspace(0, 2 * math.pi, 721)[:, None]
    around = np.cos(turns) * one + np.sin(turns) * np.cross(axis, one)
    angle, slant = math.radians(light.cone_angle), math.dist(end, light.position)
    rim: Floats = np.array(light.position) + slant * (math.cos(angle) * axis + math.sin(angle) * around)
    return rim


def test_a_cone_seen_from_the_side_is_two_lines_at_its_angle() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=30.0)
    one, other = cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0))
    element, line = FRONT.area.middle
    side = 20 * np.array([math.cos(math.pi / 6), 0.5])
    assert one == pytest.approx(np.array([(element, line), (element + side[0], line - side[1])]))
    assert other == pytest.approx(np.array([(element, line), (element + side[0], line + side[1])]))


def test_a_cone_that_points_at_the_viewer_is_a_circle() -> None:
    for up in (2.0, -2.0):
        light = Light("key", (0.0, 0.0, 0.0), aim=(0.0, 0.0, up), cone_angle=30.0)
        (rim,) = cone_outline(VIEWS, TOP, light, (0.0, 0.0, up))
        assert len(rim) == RIM_SIDES + 1
        assert np.hypot(*(rim - TOP.area.middle).T) == pytest.approx(np.full(RIM_SIDES + 1, 10.0))


def test_a_cone_of_ninety_degrees_seen_from_the_side_is_a_line_across_its_axis() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=90.0)
    outline = np.concatenate(cone_outline(VIEWS, FRONT, light, (2.0, 0.0, 0.0)))
    assert np.ptp(outline[:, 0]) == pytest.approx(0, abs=1e-9)
    assert np.ptp(outline[:, 1]) == pytest.approx(40, rel=0.01)


def test_a_cone_that_holds_everything_has_no_outline() -> None:
    light = Light("key", (0.0, 0.0, 0.0), aim=(2.0, 0.0, 0.0), cone_angle=180.0)
    assert all(cone_outline(VIEWS, side, light, (2.0, 0.0, 0.0)) == () for side in SIDES)


@given(vectors(), directions, numbers(1, 179), st.sampled_from(SIDES))
def test_the_lines_are_tangents_of_the_rim(
    position: Vector, direction: Vector, cone_angle: float, side: Side
) -> None:
    light = Light("key", position, direction=direction, cone_angle=cone_angle)
    assert light.axis is not None
    end = tuple((np.array(position) + 2 * np.array(light.axis)).tolist())
    along = abs(float(np.dot(light.axis, side.toward)))
    # The cone opens behind the light above 90 degrees.
    half = math.radians(min(cone_angle, 180 - cone_angle))
    assume(abs(math.acos(min(along, 1.0)) - half) > 1e-3)
    assume(abs(cone_angle - 90) > 0.1)
    outline = cone_outline(VIEWS, side, light, end)
    rim = VIEWS.positions(side, rim_of(light, end))
    at = np.array(VIEWS.position(side, position))
    if math.acos(min(along, 1.0)) < half:
        assert len(outline) == 1
        return
    assert len(outline) == 2
    for start, touching in outline:
        assert start == pytest.approx(at)
        # It touches the rim, and the rim lies on one side of it.
        assert np.hypot(*(rim - touching).T).min() < 0.2
        step = (touching - start) / np.linalg.norm(touching - start)
        beside = step[0] * (rim - start)[:, 1] - step[1] * (rim - start)[:, 0]
        assert min(beside.max(), (-beside).max()) < 1e-6
    # The half angle between the lines: sin B = sin A / sin F.
    one, other = (line[1] - line[0] for line in outline)
    between = math.acos(float(np.clip(one @ other / np.linalg.norm(one) / np.linalg.norm(other), -1, 1)))
    expected = math.asin(min(1.0, math.sin(half) / math.sqrt(1 - along * along)))
    assert between / 2 == pytest.approx(expected, abs=1e-4)
