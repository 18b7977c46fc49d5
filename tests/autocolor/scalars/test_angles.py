from __future__ import annotations

import math

import numpy as np
import pytest

from autocolor import Mesh, View
from autocolor.rendering import rendering
from autocolor.scalars.angles import draft_angle, slope
from autocolor.scalars.ranges import ScalarValues
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints
from tests.autocolor.meshes import cube, grid, wall_scene

PITCH = 35.0


def roof() -> Mesh:
    """Two sides of a roof along y that face outward, the left one rising to the right by PITCH degrees."""
    rise = math.tan(math.radians(PITCH))
    left = grid(3, 2, (-1.0, -1.0, 0.0), (1.0, 0.0, rise), (0.0, 2.0, 0.0), "left")
    right = grid(3, 2, (0.0, -1.0, rise), (1.0, 0.0, -rise), (0.0, 2.0, 0.0), "right")
    return Mesh.joined([left, right])


def cone(angle: float, columns: int = 180) -> Mesh:
    """The side of a cut cone about z that narrows upward, its side `angle` degrees off the axis."""
    turns = np.arange(columns) * 2 * np.pi / columns
    lower = np.stack([2 * np.cos(turns), 2 * np.sin(turns), np.zeros(columns)], axis=1)
    narrow = 1 - math.tan(math.radians(angle)) / 2
    upper = lower * (narrow, narrow, 0) + (0.0, 0.0, 1.0)
    column = np.arange(columns)
    after = (column + 1) % columns
    quads = np.stack([column, after, after + columns, column + columns], axis=1)
    return Mesh(np.concatenate([lower, upper]), quads, part_names=("cone",))


def points_of(mesh: Mesh, view: View) -> VisiblePoints:
    return rendering(wall_scene(mesh, view=view), 30, 40).points


def of_roof(eye: tuple[float, float, float], direction: tuple[float, float, float]) -> ScalarValues:
    points = points_of(roof(), View(eye, target=(0.0, 0.0, 0.3)))
    return slope(roof(), Scalar("slope", direction=direction), points)


@pytest.mark.parametrize("eye", [(0.5, -2.0, 6.0), (0.5, -1.0, -5.0)])
def test_the_slope_of_a_roof_is_its_pitch_from_above_and_from_below(eye: tuple[float, float, float]) -> None:
    values, limits = of_roof(eye, (0.0, 0.0, 1.0))
    assert len(values) > 100
    assert values == pytest.approx(PITCH, abs=1e-4)
    assert limits == (0, 90)


def test_the_slope_is_counted_from_what_is_across_the_direction() -> None:
    values, _ = of_roof((0.5, -2.0, 6.0), (1.0, 0.0, 0.0))
    assert values == pytest.approx(90 - PITCH, abs=1e-4)
    along, _ = of_roof((0.5, -2.0, 6.0), (0.0, 5.0, 0.0))
    assert along == pytest.approx(90, abs=1e-4)


@pytest.mark.parametrize("angle", [0.0, 3.0, 20.0])
@pytest.mark.parametrize("pull", [1.0, -1.0])
def test_the_draft_angle_of_a_cone_is_that_of_its_side(angle: float, pull: float) -> None:
    mesh = cone(angle)
    for eye in ((0.0, -9.0, 2.0), (0.0, -9.0, 14.0)):
        # From the second place the inside is seen, too: the outside counts.
        points = points_of(mesh, View(eye, target=(0.0, 0.0, 0.5)))
        values, limits = draft_angle(mesh, Scalar("draft angle", direction=(0.0, 0.0, pull)), points)
        assert len(values) > 50
        assert values == pytest.approx(pull * angle, abs=0.01)
        assert limits == (-90, 90)


def test_the_sides_of_a_box_have_the_draft_angles_of_a_mold() -> None:
    mesh = cube()
    points = points_of(mesh, View((2.0, -3.0, 2.5), target=(0.5, 0.5, 0.5)))
    values, _ = draft_angle(mesh, Scalar("draft angle"), points)
    of_polygon = {
        polygon: sorted(set(np.round(values[points.polygon_numbers == polygon], 3).tolist()))
        for polygon in np.unique(points.polygon_numbers).tolist()
    }
    assert of_polygon == {1: [90.0], 2: [0.0], 5: [0.0]}
