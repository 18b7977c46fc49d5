from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View, scene_of
from autocolor.scene.orbit import moved, panned, seen_from, side_name, sides_of, target_of, turned
from autocolor.scene.scene import FRONTS
from tests.small import cube, grid, wall_scene


def distance(view: View) -> float:
    assert view.target is not None
    return math.dist(view.eye, view.target)


@given(st.floats(-180, 180), st.floats(-40, 40))
def test_going_around_keeps_the_distance_and_the_target(right: float, up: float) -> None:
    scene = wall_scene(view=View((3, -4, 1), target=(0, 0, 0.5)))
    view = turned(scene, right, up)
    assert view.target == (0, 0, 0.5)
    assert distance(view) == pytest.approx(distance(scene.view))
    level = turned(scene, right, 0)
    assert level.eye[2] == pytest.approx(1)
    assert turned(scene.replace(view=level), -right, 0).eye == pytest.approx(scene.view.eye)


def test_the_eye_stays_away_from_straight_above() -> None:
    scene = wall_scene(view=View((0, -4, 0), target=(0, 0, 0)))
    for _ in range(40):
        scene = scene.replace(view=turned(scene, 0, 5))
    assert scene.view.eye[2] == pytest.approx(4 * math.sin(math.radians(85)))
    assert turned(scene, 0, 5) is scene.view
    assert turned(scene, 0, -5) != scene.view


def test_a_direction_is_gone_around_without_a_jump() -> None:
    scene = wall_scene(view=View((0, -4, 0), direction=(0, 2, 0)))
    assert np.allclose(target_of(scene), 0)
    view = turned(scene, 0, 0)
    assert view.eye == pytest.approx(scene.view.eye)
    # What lies behind the eye is not gone around.
    assert target_of(wall_scene(view=View((0, -4, 0), direction=(0, -1, 0))))[1] < -4
    assert np.allclose(view.axes, scene.view.axes)


def test_moving_closer_and_farther_again_comes_back() -> None:
    scene = wall_scene(view=View((3, -4, 1), target=(0, 0, 0)))
    closer = moved(scene, 0.5)
    assert distance(closer) == pytest.approx(0.5 * distance(scene.view))
    assert moved(scene.replace(view=closer), 2).eye == pytest.approx(scene.view.eye)


@pytest.mark.parametrize("height", [10.0, -10.0])
def test_going_around_from_straight_above_or_below_does_not_turn_the_picture(height: float) -> None:
    scene = wall_scene(view=View((0, 0, height), target=(0, 0, 0)))
    before = scene.view.axes
    after = turned(scene, 1e-6, 0).axes
    assert after[0] == pytest.approx(before[0], abs=1e-5)
    assert float(after[2] @ before[2]) > np.cos(np.radians(6))


def test_the_eye_goes_around_the_object_and_not_around_its_stage() -> None:
    view = View((0.5, -4, 0.5), direction=(0, 1, 0))
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    alone = scene_of(cube(), view=view)
    scene = scene_of(Mesh.joined([cube(), floor]), view=view, parts={"floor": {"stage": True}})
    assert target_of(scene) == target_of(alone) == (0.5, 0.5, 0.5)
    assert target_of(scene.with_part("floor", stage=False))[1] > 1


STAGED = scene_of(
    Mesh.joined([cube(), grid(1, 1, (-5, -5, 0.2), (10, 0, 0), (0, 10, 0), "floor")]),
    view=View((3, -4, 2), target=(0.5, 0.5, 0.5)),
    parts={"floor": {"stage": True}},
)
"""A cube on a floor at z 0.2."""


@given(
    st.lists(
        st.tuples(
            st.floats(-400, 400), st.floats(-400, 400), st.sampled_from(["turn", "pan", "move", "tilt"])
        )
    )
)
def test_an_eye_above_the_stage_stays_above_it(steps: list[tuple[float, float, str]]) -> None:
    scene = STAGED
    for right, down, kind in steps:
        if kind == "tilt":
            view = scene.view.replace(angle=right)
        elif kind == "move":
            view = moved(scene, 2 ** (right / 200))
        else:
            view = turned(scene, right, -down) if kind == "turn" else panned(scene, right, down, 480, 640)
        scene = scene.replace(view=view)
        assert view.eye[2] > 0.2


def test_a_pan_at_the_stage_stays_in_the_picture_plane_and_without_a_stage_goes_below() -> None:
    below = STAGED.replace(view=View((3, -4, 0.1), target=(0.5, 0.5, 0.5)))
    for scene in (STAGED.with_part("floor", stage=False), below):
        assert turned(scene, 0, -40).eye[2] < 0
        assert panned(scene, 0, -900, 480, 640).eye[2] < 0
    shift = np.array(panned(STAGED, 30, -900, 480, 640).eye) - np.array(STAGED.view.eye)
    assert float(shift @ STAGED.view.axes[2]) == pytest.approx(0, abs=1e-9)
    free_view = panned(STAGED.with_part("floor", stage=False), 30, -900, 480, 640)
    free = np.array(free_view.eye) - np.array(STAGED.view.eye)
    assert float((shift - free) @ STAGED.view.axes[0]) == pytest.approx(0, abs=1e-9)


def place(view: View, point: npt.ArrayLike) -> tuple[float, float]:
    """Where a point is seen, in elements and lines from the middle of a picture of 480 lines."""
    right, down, deep = (np.array(point) - np.array(view.eye)) @ view.axes.T
    scale = 240 / math.tan(math.radians(view.field_of_view) / 2)
    return scale * right / deep, scale * down / deep


@given(st.floats(-300, 300), st.floats(-200, 200), st.floats(-170, 170), st.booleans())
def test_the_target_moves_with_the_picture(right: float, down: float, angle: float, has_target: bool) -> None:
    aim = {"target": (0.3, 0.1, 0.5)} if has_target else {"direction": (-3, 4, -1)}
    scene = wall_scene(view=View((3, -4, 1), angle=angle, field_of_view=40, **aim))
    before = target_of(scene)
    view = panned(scene, right, down, 480, 640)
    assert np.allclose(view.axes, scene.view.axes)
    old = place(scene.view, before)
    assert place(view, before) == pytest.approx((old[0] + right, old[1] + down), abs=1e-6)
    assert distance(view) == pytest.approx(math.dist(scene.view.eye, before))


@pytest.mark.parametrize(
    ("side", "right", "down"),
    [
        ("from -y", (1, 0, 0), (0, 0, -1)),
        ("from x", (0, 1, 0), (0, 0, -1)),
        ("from y", (-1, 0, 0), (0, 0, -1)),
        ("from -x", (0, -1, 0), (0, 0, -1)),
        ("top", (1, 0, 0), (0, -1, 0)),
    ],
)
def test_a_named_view_has_the_axes_of_a_drawing_and_the_object_fills_it(
    side: str, right: tuple[int, ...], down: tuple[int, ...]
) -> None:
    scene = scene_of(cube()).with_view(angle=30.0, field_of_view=20.0)
    view = seen_from(scene, side)
    assert np.allclose(view.axes[:2], (right, down))
    assert view.field_of_view == 20
    places = np.array([place(view, node) for node in cube().coordinates])
    assert np.abs(places).max() == pytest.approx(0.86 * 240)


@pytest.mark.parametrize("front", FRONTS)
def test_sides_have_the_names_that_the_front_gives_them(front: Any) -> None:
    scene = scene_of(cube(), front=front)
    sign, axis = -1 if "-" in front else 1, "xyz".index(front[-1])
    seen = {side: seen_from(scene, side) for side in sides_of(scene)}
    # The object faces the eye, and its left is at the right of the picture.
    assert seen["front"].axes[2][axis] == -sign
    assert np.allclose(seen["front"].axes[0], -seen["left"].axes[2])
    assert np.allclose(seen["back"].axes[2], -seen["front"].axes[2])
    assert np.allclose(seen["right"].axes[2], -seen["left"].axes[2])
    # Three quarters is the direction of a created view, from wherever.
    alone = scene_of(cube())
    plain = seen_from(alone.replace(view=turned(alone, 50, 10)), "three quarters")
    assert plain.eye == pytest.approx(alone.view.eye)
    corner = seen["three quarters"]
    assert float(corner.axes[2] @ seen["front"].axes[2]) == pytest.approx(plain.axes[2][1])
    assert corner.axes[2][2] == pytest.approx(plain.axes[2][2])
    for side in ("front", "left", "back", "right"):
        toward = -seen[side].axes[2]
        assert side_name(scene, (round(toward[0]), round(toward[1]), 0.0)) == side
