from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import InputError, Light, Scene, Surface, View, render, scene_of
from autocolor.arrays import Singles
from autocolor.checks import Vector
from autocolor.mapping.display_image import DisplayImage, display_image
from autocolor.mapping.normals.normal_words import normal_light, words_at_levels, words_of_normals
from autocolor.scene.curves import GAMMA, LOGARITHM
from autocolor.scene.scene import OBJECT
from tests.autocolor import reference
from tests.autocolor.meshes import sphere
from tests.autocolor.strategies import scenes

LINES, ELEMENTS = 24, 32


def image_of(scene: Scene, lines: int = LINES, elements: int = ELEMENTS) -> DisplayImage:
    scene = scene.replace(words="normals")
    return display_image(scene, render(scene, lines, elements))


def in_world(scene: Scene, normals: Singles) -> list[Vector]:
    return [tuple(each) for each in (normals.T.astype(float) @ scene.view.axes).tolist()]


# A slow, obvious twin of the entries: a loop over the words, in float64.


def reflected(scene: Scene, normal: Vector, surface: Surface) -> float:
    """The paper's formula at a normal; lights and eye are far away, in their directions from the middle."""
    low, high = scene.object_bounds
    middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    to_eye = reference.unit(reference.minus(scene.view.eye, middle))
    total = scene.ambient
    for light in scene.lights:
        to_light = reference.unit(reference.minus(light.position, middle))
        cos_i = reference.dot(normal, to_light)
        assume(abs(cos_i) > 1e-5)
        if not light.on or cos_i < 0:
            continue
        row = surface.reflectance
        specular = reference.specular_factor(row.model, tuple(to_light), normal, tuple(to_eye))
        total += light.intensity * (row.diffuse * cos_i + row.specular * specular)
    return total


def fraction(scene: Scene, intensity: float, low: float, high: float) -> float:
    if high - low <= 2.0**-20 * high:
        return 0.5
    along = (min(max(intensity, low), high) - low) / (high - low)
    if scene.mapping == "gamma":
        return math.pow(along, 1 / GAMMA)
    if scene.mapping == "logarithm":
        return math.log1p(LOGARITHM * along) / math.log1p(LOGARITHM)
    if scene.mapping == "linear":
        return along
    xs, ys = zip(*scene.mapping, strict=True)
    return float(np.interp(along, xs, ys))


def entries(image: DisplayImage) -> dict[int, tuple[int, ...]]:
    """The entry of each word in use."""
    assert image.normals is not None
    scene, words = image.scene, image.normals.words.tolist()
    normals, samples = (in_world(scene, each) for each in (image.normals.normals, image.normals.samples))
    found = {}
    intensity_of = {}
    for each in image.normals.sample_slices:
        surface = scene.surfaces[each.surface_number - 1]
        intensity_of[surface.name] = [reflected(scene, normal, surface) for normal in samples[each.pixels]]
    everything = [each for values in intensity_of.values() for each in values]
    held = {} if isinstance(scene.exposure, str) else dict(scene.exposure)
    whole = held.get(OBJECT, (min(everything, default=0), max(everything, default=0)))
    for each in image.normals.slices:
        surface = scene.surfaces[each.surface_number - 1]
        values = intensity_of[surface.name]
        low, high = min(values), max(values)
        if scene.scaling == "object" or OBJECT in held:
            low, high = whole
        low, high = held.get(surface.name, (low, high))
        width = high - low - 2.0**-20 * high
        # Whether it has an extent may be decided by rounding.
        assume(abs(width) > 1e-5 * high)
        if width <= 0:
            low, high = whole
            assume(abs(high - low - 2.0**-20 * high) > 1e-5 * high)
        floor = low / high if scene.contrast == "floor" and high > 0 else 0.0
        levels = image.ranges[surface.name].levels
        for word, normal in zip(words[each.pixels], normals[each.pixels], strict=True):
            level = fraction(scene, reflected(scene, normal, surface), low, high) * (levels - 1)
            found[word] = reference.entry_of(surface.paint, levels, level, floor)
    return found


@given(scenes(), st.booleans())
def test_each_entry_is_the_closed_form_at_the_normal_of_its_word(scene: Scene, is_far: bool) -> None:
    scene = dataclasses.replace(scene, scalar=None)
    assume(scene.mapping != "equalize")
    lights = tuple(
        Light(light.name, light.position, light.intensity, light.on) if is_far else light
        for light in scene.lights
    )
    try:
        image = image_of(scene.replace(lights=lights))
    except InputError:
        # Such as levels that do not suffice.
        return
    expected = entries(image)
    for word, entry in expected.items():
        found = image.entries[word].astype(int)
        assert np.abs(found - entry).max() <= 1, (word, found, entry)


def test_where_words_are_in_use_they_are_those_of_the_pixels_and_each_surface_has_its_range() -> None:
    scene = ball_scene(20)
    image = image_of(scene, 48, 64)
    assert image.normals is not None
    seen = np.unique(image.words)
    assert seen.tolist() == [0, *image.normals.words.tolist()]
    first, levels = image.ranges["shell"]
    assert first <= seen[1]
    assert seen[-1] < first + levels
    assert (image.words == 0).tolist() == (image.picture.surface_number == 0).tolist()


def test_the_normal_of_a_word_is_near_that_of_each_of_its_pixels() -> None:
    image = image_of(ball_scene(20), 240, 320)
    assert image.normals is not None
    assert image.picture.normals is not None
    normals = np.zeros((1024, 3), np.float32)
    normals[image.normals.words] = image.normals.normals.T
    cosines = (normals[image.words.ravel()[image.picture.pixels]].T * image.picture.normals).sum(axis=0)
    assert np.degrees(np.arccos(np.clip(cosines, -1, 1))).max() < 8


def test_the_words_of_a_picture_without_any_surface_are_the_background() -> None:
    scene = ball_scene(20).with_view(eye=(0, 9, 0), target=(0, 20, 0))
    image = image_of(scene)
    assert not image.words.any()
    assert image.entries.shape == (1024, 3)
    words, stand_for = words_of_normals(image.picture, image.ranges)
    assert not words.any()
    lit = normal_light(image.scene, stand_for)
    assert lit.at_words.relative.shape == lit.at_samples.relative.shape == (0,)


def ball_scene(exponent: float, eye_distance: float = 200.0) -> Scene:
    """A smooth ball under two lights far away, seen from far away."""
    lights = (
        Light("key", (300.0, -500.0, 400.0)),
        Light("fill", (-600.0, -200.0, 100.0), 0.4),
    )
    view = View((0, -eye_distance, 0), target=(0, 0, 0), field_of_view=math.degrees(2.3 / eye_distance))
    scene = scene_of(sphere(128, 64), surfaces=[Surface("shell")], surface_of_part={"sphere": "shell"})
    scene = scene.replace(lights=lights, view=view, ambient=0.1)
    return scene.with_surface("shell", diffuse=0.75, specular=0.5, exponent=exponent, blend=0.6)


def errors(scene: Scene) -> npt.NDArray[np.int64]:
    """The difference of each component from the true picture, at the visible pixels of 640 x 480."""
    scene = scene.replace(words="levels")
    picture = render(scene, 480, 640)
    true = display_image(scene, picture).colors.astype(np.int64)
    found = image_of(scene, 480, 640).colors
    differences: npt.NDArray[np.int64] = np.abs(found - true)[picture.surface_number > 0]
    return differences


@pytest.mark.parametrize(("exponent", "mean", "most"), [(5, 3, 35), (20, 3, 50), (50, 3, 60), (100, 3, 70)])
def test_the_picture_of_a_ball_differs_little_from_the_true_one(
    exponent: float, mean: float, most: int
) -> None:
    found = errors(ball_scene(exponent))
    assert found.mean() < mean
    assert found.max() < most


@given(st.lists(st.floats(0, 1, width=32), min_size=1, max_size=30), st.integers(2, 40))
def test_each_level_is_shown_by_the_word_whose_fraction_is_nearest(
    fractions: list[float], levels: int
) -> None:
    given = np.array(fractions, np.float32)
    words = words_at_levels(5, given, levels)
    assert words.shape == (levels,)
    for level, word in enumerate(words.tolist()):
        wanted = level / (levels - 1)
        assert abs(given[word - 5] - wanted) == pytest.approx(np.abs(given - wanted).min(), abs=1e-6)


def test_the_levels_of_a_ball_rise_from_its_darkest_to_its_brightest_color() -> None:
    image = image_of(ball_scene(20), 240, 320)
    colors = image.entries[image.words_at_levels("shell")].astype(int).sum(axis=1)
    assert (np.diff(colors) >= 0).all()
    own = image.entries[image.normals.words] if image.normals is not None else image.entries
    assert colors[-1] == own.astype(int).sum(axis=1).max()


def test_the_words_at_levels_are_the_levels_where_words_stand_for_them() -> None:
    scene = ball_scene(20)
    image = display_image(scene, render(scene, LINES, ELEMENTS))
    first, levels = image.ranges["shell"]
    assert image.words_at_levels("shell").tolist() == list(range(first, first + levels))
