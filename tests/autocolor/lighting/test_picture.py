from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Picture, Scene, render
from autocolor.mapping.intensity import mapped_ranges, words_of
from autocolor.mapping.ranges import level_ranges
from autocolor.testing import scenes
from tests.small import sphere, wall_scene


def close_to(expected: object, largest: float) -> object:
    return pytest.approx(expected, abs=4e-6 * max(largest, 1e-30), rel=0)


@given(scenes())
def test_ranges_are_the_minima_and_maxima_of_the_arrays(scene: Scene) -> None:
    picture = render(scene, (16, 12))
    on_object = picture.surface_number > 0
    points = {picture.surfaces[number - 1] for number in np.unique(picture.surface_number[on_object])}
    assert set(picture.ranges.surfaces) == points
    for name, extent in picture.ranges.surfaces.items():
        of_surface = picture.intensity[picture.surface_number == picture.surfaces.index(name) + 1]
        assert extent == (of_surface.min(), of_surface.max())
    if points:
        assert picture.ranges.whole == (
            picture.intensity[on_object].min(),
            picture.intensity[on_object].max(),
        )
    else:
        assert picture.ranges.whole == (0, 0)


@given(scenes())
def test_the_part_at_a_pixel_has_the_surface_there(scene: Scene) -> None:
    picture = render(scene, (13, 9))
    assert picture.parts == scene.mesh.part_names
    assert (picture.part_number.shape, picture.part_number.dtype.name) == ((9, 13), "int32")
    assert not picture.part_number.flags.writeable
    surfaces = np.array([0, *scene.surface_number_of_part])
    assert (surfaces[picture.part_number] == picture.surface_number).all()


def test_a_picture_works_its_part_numbers_out_when_they_are_asked_for() -> None:
    picture = render(wall_scene(sphere()), (16, 12))
    assert picture.visible_parts is not None
    assert "numbers" not in vars(picture.visible_parts)
    assert picture.part_number.max() == 1
    with_scalar = dataclasses.replace(picture, scalar_values=None)
    assert with_scalar.visible_parts is picture.visible_parts


@given(scenes(), st.sampled_from([1e-20, 1e-6, 0.1, 1 / 3, 2.0, 3.7, 1e6, 1e20]))
def test_every_light_and_the_ambient_k_times_as_strong_change_no_word(scene: Scene, k: float) -> None:
    times_k = scene.replace(
        ambient=scene.ambient * k,
        lights=tuple(light.replace(intensity=light.intensity * k) for light in scene.lights),
    )
    assert words(times_k).tolist() == words(scene).tolist()


def words(scene: Scene) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    ranges = level_ranges(scene.surfaces, {part.surface: 1 for part in scene.parts})
    picture = render(scene, (16, 12))
    return words_of(picture, ranges, mapped_ranges(picture, scene.scaling, "auto"), scene.mapping)


@given(scenes())
def test_nothing_is_where_nothing_is_seen_and_arrays_are_read_only(scene: Scene) -> None:
    picture = render(scene, (13, 9))
    assert picture.intensity.shape == picture.surface_number.shape == (9, 13)
    assert [picture.intensity.dtype.name, picture.surface_number.dtype.name] == ["float32", "uint8"]
    assert (picture.intensity[picture.surface_number == 0] == 0).all()
    assert np.isfinite(picture.intensity).all()
    assert (picture.intensity >= 0).all()
    for array in (picture.intensity, picture.surface_number):
        assert not array.flags.writeable


@given(scenes())
def test_the_planes_of_the_lights_add_up_to_the_picture(scene: Scene) -> None:
    picture = render(scene, (16, 12))
    total = np.where(picture.surface_number > 0, scene.ambient, 0.0)
    for light in scene.lights:
        if light.on and light.intensity > 0:
            plane = picture.planes[light.name]
            for number, surface in enumerate(scene.surfaces, 1):
                d, s = surface.reflectance.diffuse, surface.reflectance.specular
                both = light.intensity * (d * plane.diffuse + s * plane.specular)
                if light.links.shines_on_surface(surface.name):
                    total += np.where(picture.surface_number == number, both, 0)
    assert picture.intensity == close_to(total, picture.ranges.whole.maximum)


@given(scenes())
def test_a_picture_from_its_own_rasters_is_the_same_picture(scene: Scene) -> None:
    picture = render(scene, (13, 9))
    relative = np.zeros(9 * 13, np.float32)
    relative[picture.pixels] = picture.relative
    again = Picture.from_rasters(
        relative.reshape(9, 13),
        picture.surface_number,
        picture.surfaces,
        picture.scale,
        part_number=picture.part_number,
        parts=picture.parts,
    )
    assert again.part_number.tobytes() == picture.part_number.tobytes()
    assert again.parts == picture.parts
    assert again.intensity.tobytes() == picture.intensity.tobytes()
    assert again.surface_number.tobytes() == picture.surface_number.tobytes()
    assert again.ranges == picture.ranges
    assert [(each.surface_number, each.start, each.stop) for each in again.slices] == [
        (each.surface_number, each.start, each.stop) for each in picture.slices
    ]


def test_a_picture_from_its_rasters_has_the_scalar() -> None:
    picture = render(wall_scene(sphere(), scalar={"name": "z"}), (13, 9))
    assert picture.scalar is not None
    assert np.isnan(picture.scalar[picture.surface_number == 0]).all()
    again = Picture.from_rasters(
        picture.intensity,
        picture.surface_number,
        picture.surfaces,
        1.0,
        picture.scalar,
        picture.scalar_limits,
    )
    assert again.scalar is not None
    assert again.scalar.tobytes() == picture.scalar.tobytes()
    assert again.scalar_limits == picture.scalar_limits
    # It was not told its parts.
    assert again.parts == ()
    assert not again.part_number.any()
