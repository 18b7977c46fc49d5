from __future__ import annotations

import math

import numpy as np
import pytest

from autocolor import Flap, Flaps, Light, Scene, Surface, View, render, scene_of
from autocolor.checks import Vector
from autocolor.lighting.picture import Picture
from autocolor.mapping.normals.far_light import far_light, light_at_normals
from autocolor.visibility.visible_points import SurfaceSlice
from tests.autocolor.meshes import sphere

FAR = 1e4


def ball(*lights: Light, eye: Vector = (0.0, -FAR, 0.0), **reflectance: float) -> Scene:
    """A ball around the origin whose eye is far away."""
    view = View(eye, target=(0, 0, 0), field_of_view=math.degrees(2.4 / FAR))
    scene = scene_of(sphere(), surfaces=[Surface("shell")], surface_of_part={"sphere": "shell"})
    return scene.replace(lights=lights, view=view, ambient=0.1).with_surface("shell", **reflectance)  # type: ignore[arg-type]


def intensities(scene: Scene, *normals: Vector) -> list[float]:
    """What light_at_normals finds at normals in the axes of the world."""
    count = len(normals)
    in_camera = (scene.view.axes @ np.array(normals, float).T).astype(np.float32)
    slices = (SurfaceSlice(1, 0, count),)
    lit = light_at_normals(scene, in_camera, slices, np.arange(count), count)
    return (lit.relative * lit.scale).tolist()  # type: ignore[no-any-return]


LEFT = (math.sqrt(0.5), -math.sqrt(0.5), 0.0)


def test_a_light_gives_its_diffuse_and_specular_term_at_a_normal() -> None:
    scene = ball(Light("key", (FAR, 0, 0), 2.0), diffuse=0.5, specular=0.25, exponent=8)
    # At LEFT, half-way between light and eye, the light is reflected into the eye.
    expected = [0.1 + 2 * (0.5 * math.sqrt(0.5) + 0.25), 0.1 + 2 * 0.5, 0.1, 0.1]
    found = intensities(scene, LEFT, (1, 0, 0), (0, -1, 0), (-1, 0, 0))
    assert found == pytest.approx(expected, rel=1e-5)


def test_every_pixel_of_a_ball_has_the_light_of_its_normal_where_lights_and_eye_are_far() -> None:
    lights = Light("key", (FAR, -FAR, FAR)), Light("rim", (-FAR, 0, 0.3 * FAR), 0.6)
    scene = ball(*lights, diffuse=0.7, specular=0.6, exponent=20).replace(words="normals")
    picture = render(scene, 60, 80)
    assert picture.normals is not None
    count = len(picture.pixels)
    lit = light_at_normals(scene, picture.normals, picture.slices, np.arange(count), count)
    # Some of the difference is that of the eye, which is not endlessly far.
    assert lit.relative * lit.scale == pytest.approx(picture.relative * picture.scale, abs=1e-3)


def test_a_light_at_infinity_shines_along_its_axis() -> None:
    sun = Light("sun", (5, 5, 5), direction=(-1, 0, 0), at_infinity=True)
    point = Light("point", (1, 0, 0))
    assert intensities(ball(sun), LEFT, (0, 0, 1)) == intensities(ball(point), LEFT, (0, 0, 1))


def test_a_light_that_follows_the_eye_shines_from_there() -> None:
    head_lamp = Light("head", (0, 0, 0), follows="eye")
    assert intensities(ball(head_lamp), (0, -1, 0)) == intensities(ball(Light("a", (0, -3, 0))), (0, -1, 0))


def test_what_depends_on_places_is_left_out() -> None:
    plain = Light("key", (4, -3, 2), 1.5)
    shaped = plain.replace(
        aim=(9, 9, 9), concentration=40, cone_angle=5, flaps=Flaps(x=Flap(8, 9)), reach=0.1, falloff="linear"
    )
    normals = LEFT, (0, 0, 1), (1, 0, 0)
    assert intensities(ball(shaped), *normals) == intensities(ball(plain), *normals)
    assert far_light(shaped, (0, 0, 0)) == far_light(plain, (0, 0, 0))


def test_links_to_surfaces_stay_and_those_to_parts_are_left_out() -> None:
    light = Light("key", (4, -3, 2), on=False).replace(only_parts=("sphere",), except_surfaces=("shell",))
    far = far_light(light, (0, 0, 0))
    assert far.links.except_surfaces == ("shell",)
    assert far.links.only_parts is None
    assert not far.on


def test_a_light_in_the_middle_of_the_object_gives_nothing() -> None:
    assert intensities(ball(Light("inside", (0, 0, 0))), LEFT, (0, -1, 0)) == pytest.approx([0.1, 0.1])


def test_without_lights_there_is_the_ambient_light_alone() -> None:
    assert intensities(ball(), LEFT, (0, 0, 0)) == pytest.approx([0.1, 0.1])


def test_the_distance_of_lights_and_eye_does_not_matter() -> None:
    near, far = ball(Light("a", (0, 0, 2)), eye=(0, -3, 0)), ball(Light("a", (0, 0, 2e20)), eye=(0, -3e20, 0))
    assert intensities(near, LEFT, (0, 0, 1)) == pytest.approx(intensities(far, LEFT, (0, 0, 1)))


def test_the_picture_of_normals_has_one_line_with_an_element_for_each_number() -> None:
    normals = np.array([[0.0], [0.0], [-1.0]], np.float32)
    lit = light_at_normals(ball(), normals, (SurfaceSlice(1, 0, 1),), np.array([7]), 10)
    assert isinstance(lit, Picture)
    assert lit.intensity.shape == (1, 10)
    assert np.flatnonzero(lit.surface_number).tolist() == [7]
