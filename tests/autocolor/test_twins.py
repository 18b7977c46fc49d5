"""Pictures against the slow twins of `twins`: points, intensities, scalars, bands and levels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Scene, View, scene_of
from autocolor.mapping.bands import Bands, band_numbers
from autocolor.mapping.intensity import ordered_thresholds
from autocolor.rendering import rendering
from autocolor.scene.color_scales import COLOR_SCALES, scale_colors
from autocolor.scene.curves import CURVES
from autocolor.scene.scalar import COMPUTED
from autocolor.testing import numbers, scales, scenes
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import ray
from tests.autocolor.twins.level import band_colors, band_of, equalized, ordered_threshold, scalar_value
from tests.autocolor.twins.light import contribution, controls_at, direction_to
from tests.autocolor.twins.point import Camera, PointExplained, dot, point_at
from tests.small import sphere

LINES, ELEMENTS = 24, 32


def every_point(scene: Scene) -> list[PointExplained]:
    """The points at all pixels that see a polygon."""
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    camera = Camera(scene.view, LINES, ELEMENTS)
    return [
        point_at(scene, camera, polygon, *divmod(pixel, ELEMENTS))
        for pixel, polygon in zip(points.pixels.tolist(), points.polygon_numbers.tolist(), strict=True)
    ]


def plane_scene(eye: tuple[float, float, float], target: tuple[float, float, float]) -> Scene:
    """A large floor at z = 0, which reaches behind the eye."""
    corners = np.array([(-9.0, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)])
    return scene_of(Mesh(corners, np.array([[0, 1, 2, 3]])), view=View(eye, target=target))


@pytest.mark.parametrize("eye", [(0.3, -20.0, 4.0), (0.3, -4.0, 1.0)])
def test_a_point_is_where_the_ray_meets_the_plane_also_of_a_floor_behind_the_eye(
    eye: tuple[float, float, float],
) -> None:
    scene = plane_scene(eye, (0.0, 0.0, 0.0))
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    found = every_point(scene)
    assert found
    for at, pixel in zip(found, points.pixels.tolist(), strict=True):
        direction = ray(scene.view, LINES, ELEMENTS, *divmod(pixel, ELEMENTS))
        depth = -eye[2] / direction[2]
        expected = [start + depth * each for start, each in zip(eye, direction, strict=True)]
        assert at.point == pytest.approx(expected, abs=1e-9)
        assert at.normal == pytest.approx((0, 0, 1))
        assert at.distance == pytest.approx(math.dist(eye, expected))


def jumps_nearby(scene: Scene, at: PointExplained) -> bool:
    """Whether float32 may have put the point on the other side of an edge, or hardly knows its normal."""
    if at.normal_length < 0.05 or at.distance < 0.05:
        return True
    for light in scene.lights_in_world:
        if abs(dot(at.normal, direction_to(light, at.point))) < 1e-4:
            return True
        here = controls_at(light, at.point, scene)
        for step in np.concatenate([np.eye(3), -np.eye(3)]) * 4e-6:
            x, y, z = (at.point + step).tolist()
            beside = controls_at(light, (x, y, z), scene)
            if any(abs(share - beside[name]) > 0.4 for name, share in here.items()):
                return True
    return False


@given(scenes(), st.sampled_from([20, ELEMENTS, 40]), st.integers(0, 1 << 30))
def test_the_intensities_of_a_picture_are_those_of_the_twin(scene: Scene, elements: int, seed: int) -> None:
    both = rendering(scene, LINES, elements)
    picture, camera = both.picture, Camera(scene.view, LINES, elements)
    polygons = both.points.polygon_numbers
    for place in np.random.default_rng(seed).permutation(len(picture.pixels))[:3].tolist():
        line, element = divmod(int(picture.pixels[place]), elements)
        at = point_at(scene, camera, int(polygons[place]), line, element)
        assert at.surface == picture.surface_number[line, element]
        assert at.part == picture.part_number[line, element]
        if not jumps_nearby(scene, at):
            lights = [contribution(light, scene, at) for light in scene.lights_in_world]
            whole = picture.ranges.whole.maximum
            intensity = float(picture.intensity[line, element])
            assert intensity == pytest.approx(scene.ambient + math.fsum(lights), abs=1e-4 * whole)


@pytest.mark.parametrize("interpolation", ["scan line", "linear"])
@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
def test_the_points_and_normals_of_a_zigzag_are_those_of_the_renderer(
    angle: float, interpolation: Any
) -> None:
    # A dart, which a line crosses four times, with a bent normal at each corner.
    corners = np.array([(-1.0, 0.2, 1.0), (0.0, 0.0, -0.4), (1.0, 0.1, 1.0), (0.0, 0.0, -1.0)])
    view = View((0.2, -5.0, 0.3), target=(0.0, 0.0, 0.0), angle=angle)
    mesh = Mesh(corners, np.array([[0, 1, 2, 3]]), crease_angle=180.0)
    scene = scene_of(mesh, view=view, interpolation=interpolation)
    points = visible_surfaces(mesh, view, (1,), LINES, ELEMENTS, interpolation=interpolation)
    found = every_point(scene)
    assert np.array([at.point for at in found]) == pytest.approx(points.world_points, abs=1e-6)
    assert np.array([at.normal for at in found]) == pytest.approx(points.world_normals, abs=1e-6)


@pytest.mark.parametrize("name", COMPUTED)
def test_every_computed_scalar_is_that_of_the_picture(name: str) -> None:
    mesh = sphere(16, 8)
    stretched = type(mesh)(mesh.coordinates * (1.0, 0.7, 1.3), mesh.node_numbers, crease_angle=180.0)
    view = View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0))
    scene = scene_of(stretched, view=view).with_scalar(name=name, direction=(0.2, 0.1, 1.0))
    both = rendering(scene, LINES, ELEMENTS)
    values, points = both.picture.scalar_values, both.points
    assert values is not None
    assert scene.scalar is not None
    camera = Camera(view, LINES, ELEMENTS)
    for place in range(0, len(points.pixels), 7):
        pixel = int(points.pixels[place])
        at = point_at(scene, camera, int(points.polygon_numbers[place]), *divmod(pixel, ELEMENTS))
        found, expected = scalar_value(scene.mesh, scene.scalar, at), float(values[place])
        if name == "zebra":
            # The phase goes around.
            found = (found - expected + 0.5) % 1 - 0.5 + expected
        assert found == pytest.approx(expected, rel=1e-4, abs=1e-4)


@given(
    st.integers(0, 40),
    st.tuples(st.booleans(), st.booleans()),
    st.lists(numbers(-2, 12) | st.just(float("nan")), min_size=1, max_size=20),
)
def test_bands_are_those_of_the_picture(count: int, beyond: tuple[bool, bool], values: list[float]) -> None:
    bands = Bands(0.0, 10.0, count + 2, 3, *beyond, True)
    singles = np.array(values, np.float32)
    assert [band_of(float(each), bands) for each in singles] == band_numbers(singles, bands).tolist()


@given(scales() | st.sampled_from(list(COLOR_SCALES)), st.integers(1, 40))
def test_the_colors_of_bands_are_those_of_the_scale(scale: str, count: int) -> None:
    # Rounding decides about halves.
    found, expected = np.array([*band_colors(scale, count)]), scale_colors(scale, count).astype(int)
    assert np.abs(found - expected).max() <= 1
    assert found[[0, -1]].tolist() == expected[[0, -1]].tolist()


def test_the_thresholds_are_those_of_the_picture() -> None:
    found = [ordered_threshold(line, element) for line in range(11) for element in range(13)]
    assert found == ordered_thresholds(11, 13).tolist()


@given(st.lists(numbers(0.1, 3), min_size=2, max_size=30, unique=True), st.booleans())
def test_equalized_levels_are_those_of_the_picture(given: list[float], held: bool) -> None:
    intensities = np.array(given, np.float32)
    low, high = np.float32(0.1 if held else intensities.min()), np.float32(3 if held else intensities.max())
    if high - low < 1e-3:
        return
    curve = CURVES["equalize"](low, high, intensities)
    for each in intensities:
        found = equalized(intensities.astype(np.float64), float(low), float(high), float(each))
        # Intensities that are equal but for rounding count as equal.
        same = np.count_nonzero(np.abs(intensities - each) < 1e-5) / len(intensities)
        assert abs(found - float(curve(np.array([each]))[0])) <= same + 1e-6
