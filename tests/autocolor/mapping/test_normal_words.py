from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light, Scene, Surface, View, render, scene_of
from autocolor.arrays import Singles
from autocolor.checks import Vector
from autocolor.explanation import point as plain
from autocolor.explanation.level import curved
from autocolor.explanation.light import direction_to, specular_factor
from autocolor.explanation.point import dot, minus
from autocolor.images import display_image
from autocolor.lighting.picture import Picture
from autocolor.mapping.normal_words import (
    BINS,
    NormalImage,
    cells_of,
    far_light,
    light_at_normals,
    normal_light,
    spread_of,
    words_at_levels,
    words_of_normals,
)
from autocolor.scene.columns import fields_of
from autocolor.scene.scene import AUTO, OBJECT, Exposure
from autocolor.testing import scenes
from autocolor.visibility.visible_points import SurfaceSlice
from tests.autocolor import reference
from tests.small import sphere

LINES, ELEMENTS = 24, 32


def image_of(scene: Scene, lines: int = LINES, elements: int = ELEMENTS) -> NormalImage:
    scene = scene.replace(words="normals")
    image = display_image(scene, render(scene, lines, elements))
    assert isinstance(image, NormalImage)
    return image


def in_world(scene: Scene, normals: Singles) -> list[Vector]:
    return [tuple(each) for each in (normals.T.astype(float) @ scene.view.axes).tolist()]


# A slow, obvious twin of the entries: a loop over the words, in float64.


def reflected(scene: Scene, normal: Vector, surface: Surface) -> float:
    """The paper's formula at a normal; lights and eye are far away, in their directions from the middle."""
    low, high = scene.object_bounds
    middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    to_eye = plain.unit(minus(scene.view.eye, middle))
    # The models say nothing of a normal that faces away from the eye; they divide by this cosine.
    assume(dot(normal, to_eye) > 1e-3)
    total = scene.ambient
    for light in scene.lights:
        to_light = direction_to(light, middle)
        cos_i = dot(normal, to_light)
        assume(abs(cos_i) > 1e-5)
        if not light.on or cos_i < 0 or not light.links.shines_on_surface(surface.name):
            continue
        row = surface.reflectance
        specular = specular_factor(row.model, tuple(to_light), normal, tuple(to_eye))
        total += light.intensity * (row.diffuse * cos_i + row.specular * specular)
    return total


def range_of(intensities: list[float], exposure: Exposure) -> tuple[float, float]:
    if isinstance(exposure, str) and exposure != AUTO:
        return reference.trimmed(intensities, exposure)
    return min(intensities), max(intensities)


def fraction(scene: Scene, intensity: float, low: float, high: float) -> float:
    if high - low <= 2.0**-20 * high:
        return 0.5
    along = (min(max(intensity, low), high) - low) / (high - low)
    return curved(scene.mapping, along)


def entries(image: NormalImage) -> dict[int, tuple[int, ...]]:
    """The entry of each word in use."""
    scene, words = image.scene, image.normals.words.tolist()
    normals, samples = (in_world(scene, each) for each in (image.normals.normals, image.normals.samples))
    found = {}
    intensity_of = {}
    counts = image.normals.sample_counts.tolist()
    for each in image.normals.sample_slices:
        surface = scene.surfaces[each.surface_number - 1]
        intensity_of[surface.name] = [
            reflected(scene, normal, surface)
            for normal, count in zip(samples[each.pixels], counts[each.pixels], strict=True)
            for _ in range(count)
        ]
    everything = [each for values in intensity_of.values() for each in values]
    held = {} if isinstance(scene.exposure, str) else dict(scene.exposure)
    whole = held.get(OBJECT, range_of(everything or [0], scene.exposure))
    for each in image.normals.slices:
        surface = scene.surfaces[each.surface_number - 1]
        values = intensity_of[surface.name]
        low, high = range_of(values, scene.exposure)
        if scene.scaling == "object" or OBJECT in held:
            low, high = whole
        low, high = held.get(surface.name, (low, high))
        width = high - low - 2.0**-20 * high
        # Whether it has an extent may be decided by rounding.
        assume(abs(width) > 1e-5 * high)
        # A light that grazes all faces leaves a range of rounding alone.
        assume(width <= 0 or width > 1e-5 * sum(light.intensity for light in scene.lights if light.on))
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
    seen = np.unique(image.words)
    assert seen.tolist() == [0, *image.normals.words.tolist()]
    first, levels = image.ranges["shell"]
    assert first <= seen[1]
    assert seen[-1] < first + levels
    assert (image.words == 0).tolist() == (image.picture.surface_number == 0).tolist()


def test_the_normal_of_a_word_is_near_the_normals_of_its_pixels() -> None:
    image = image_of(ball_scene(20), 240, 320)
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


@pytest.mark.parametrize(("exponent", "mean", "most"), [(5, 3, 35), (20, 3, 45), (50, 3, 60), (100, 3, 70)])
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
    own = image.entries[image.normals.words]
    assert colors[-1] == own.astype(int).sum(axis=1).max()


def test_the_words_at_levels_are_the_levels_where_words_stand_for_them() -> None:
    scene = ball_scene(20)
    image = display_image(scene, render(scene, LINES, ELEMENTS))
    first, levels = image.ranges["shell"]
    assert image.words_at_levels("shell").tolist() == list(range(first, first + levels))


def unit(vectors: object) -> Singles:
    array = np.asarray(vectors, np.float64)
    normalized: Singles = (array / np.linalg.norm(array, axis=0)).astype(np.float32)
    return normalized


def ball(radius: int) -> Singles:
    """The normals of a ball that is seen from far away, one at each pixel."""
    y, x = np.mgrid[-radius:radius, -radius:radius] + 0.5
    inside = x * x + y * y < radius * radius
    x, y = x[inside] / radius, y[inside] / radius
    return unit([x, y, -np.sqrt(1 - x * x - y * y)])


@given(st.integers(0, 2**31), st.integers(1, 400), st.integers(2, 60), st.sampled_from([0.02, 0.5, 3.0]))
def test_every_cell_holds_a_normal_and_there_are_at_most_as_many_as_asked_for(
    seed: int, count: int, most: int, spread: float
) -> None:
    generator = np.random.default_rng(seed)
    normals = unit(generator.normal(size=(3, count)) * spread + np.array([[0.3], [0.1], [-1.0]]))
    cells = cells_of(normals, most)
    assert cells.normals.dtype == np.float32
    assert cells.normals.shape[1] <= most
    assert np.unique(cells.numbers).tolist() == list(range(cells.normals.shape[1]))
    assert cells.normals.shape[1] <= cells.samples.shape[1] <= count
    # The normal of each cell is the mean of those in it.
    for number, normal in enumerate(cells.normals.T):
        mean = normals[:, cells.numbers == number].astype(np.float64).sum(axis=1)
        assert normal == pytest.approx(mean / np.linalg.norm(mean), abs=1e-5)


def test_a_ball_takes_all_cells_and_each_normal_is_in_one_of_the_nearest() -> None:
    normals = ball(150)
    cells = cells_of(normals, 1000)
    assert cells.normals.shape[1] > 980
    cosines = normals.T @ cells.normals
    own = np.take_along_axis(cosines, cells.numbers[:, None], axis=1)[:, 0]
    angles, nearest = np.arccos(np.clip([own, cosines.max(axis=1)], -1, 1))
    # A pixel may be beyond the border of its cell by no more than its bin reaches.
    assert (angles - nearest).max() < 2 * np.sqrt(2) * 2 / BINS
    # So many cells of a hemisphere have a radius of 0.045 each.
    assert angles.mean() < 0.04
    assert angles.max() < 0.15


def test_cells_are_spread_over_all_that_is_seen_and_denser_where_it_is_larger() -> None:
    cells = cells_of(ball(150), 1000)
    # In zones of equal area, from the silhouette to the middle, where one covers seven times the pixels.
    counts, _ = np.histogram(-cells.normals[2], bins=np.linspace(0, 1, 5))
    assert 60 < counts[0] < counts[-1] < 500


def test_a_hood_that_is_nearly_flat_has_more_cells_than_bins() -> None:
    turns = np.linspace(0, 2 * np.pi, 200)
    tilts = np.radians(4) * np.sqrt(np.linspace(0, 1, 400))[:, None]
    hood = unit([np.sin(tilts) * np.cos(turns), np.sin(tilts) * np.sin(turns), -np.cos(tilts) + 0 * turns])
    normals = np.concatenate([ball(150), hood.reshape(3, -1)], axis=1)
    cells = cells_of(normals, 600)
    bins = np.pi * (BINS / 2 * np.sqrt(2) * np.sin(np.radians(2))) ** 2
    assert np.count_nonzero(-cells.normals[2] > np.cos(np.radians(4))) > 2 * bins


def test_as_few_normals_as_there_are_cells_have_a_cell_each() -> None:
    normals = unit([[0, 0, 0.7, 0, 0.7], [0, 0.5, 0, 0, 0], [-1, -0.8, -0.7, -1, -0.7]])
    cells = cells_of(normals, 3)
    assert cells.normals[:, cells.numbers] == pytest.approx(normals, abs=1e-6)
    assert cells.normals.shape[1] == 3


def test_a_flat_surface_has_one_cell_whatever_the_rounding_of_its_normals() -> None:
    generator = np.random.default_rng(1)
    flat = unit(np.array([[0.2], [-0.4], [-0.9]]) + generator.normal(size=(3, 500)) * 1e-6)
    cells = cells_of(flat, 300)
    assert cells.normals.shape == (3, 1)
    assert cells.normals[:, 0] == pytest.approx(flat[:, 0], abs=1e-5)
    assert spread_of(flat) == 1


def test_normals_that_differ_little_still_take_the_cells() -> None:
    generator = np.random.default_rng(2)
    normals = unit(np.array([[0.2], [-0.4], [-0.9]]) + generator.uniform(-0.02, 0.02, size=(3, 9000)))
    assert cells_of(normals, 300).normals.shape[1] > 290


def test_the_same_normals_give_the_same_cells() -> None:
    one, other = cells_of(ball(40), 100), cells_of(ball(40), 100)
    assert one.normals.tobytes() == other.normals.tobytes()
    assert one.numbers.tobytes() == other.numbers.tobytes()


def test_no_normals_have_no_cells_and_a_zero_normal_has_one() -> None:
    nothing = cells_of(np.empty((3, 0), np.float32), 10)
    assert nothing.normals.shape == (3, 0)
    assert nothing.numbers.shape == (0,)
    zero = cells_of(np.zeros((3, 4), np.float32), 10)
    assert zero.normals.tolist() == [[0], [0], [0]]
    assert zero.numbers.tolist() == [0, 0, 0, 0]


def test_normals_that_face_away_from_the_eye_have_cells_too() -> None:
    normals = unit([[0.1, 0.0, 1.0, -1.0], [0.0, 0.0, 0.2, 0.3], [0.99, -1.0, 0.9, 0.8]])
    cells = cells_of(normals, 4)
    assert cells.normals[:, cells.numbers] == pytest.approx(normals, abs=1e-6)


def test_the_spread_of_normals_is_how_much_of_the_sphere_they_take() -> None:
    half = spread_of(ball(400))
    # Half of the sphere is half of the disk in the square of all bins.
    assert half == pytest.approx(np.pi / 4 * BINS**2 / 2, rel=0.03)
    front = ball(400)
    # A cap of half the height has half the area of the half sphere.
    assert spread_of(front[:, front[2] < -0.5]) == pytest.approx(half / 2, rel=0.03)


FAR = 1e4


def far_ball(*lights: Light, eye: Vector = (0.0, -FAR, 0.0), **reflectance: float) -> Scene:
    """A ball around the origin whose eye is far away."""
    view = View(eye, target=(0, 0, 0), field_of_view=math.degrees(2.4 / FAR))
    scene = scene_of(sphere(), surfaces=[Surface("shell")], surface_of_part={"sphere": "shell"})
    return scene.replace(lights=lights, view=view, ambient=0.1).with_surface("shell", **reflectance)  # type: ignore[arg-type]


def intensities(scene: Scene, *normals: Vector) -> list[float]:
    """The intensities of `light_at_normals` at normals in the axes of the world."""
    count = len(normals)
    in_camera = (scene.view.axes @ np.array(normals, float).T).astype(np.float32)
    slices = (SurfaceSlice(1, 0, count),)
    lit = light_at_normals(scene, in_camera, slices, np.arange(count), count)
    return (lit.relative * lit.scale).tolist()  # type: ignore[no-any-return]


LEFT = (math.sqrt(0.5), -math.sqrt(0.5), 0.0)


def test_a_light_gives_its_diffuse_and_specular_term_at_a_normal() -> None:
    scene = far_ball(Light("key", (FAR, 0, 0), 2.0), diffuse=0.5, specular=0.25, exponent=8)
    # At LEFT, half-way between light and eye, the light is reflected into the eye.
    expected = [0.1 + 2 * (0.5 * math.sqrt(0.5) + 0.25), 0.1 + 2 * 0.5, 0.1, 0.1]
    found = intensities(scene, LEFT, (1, 0, 0), (0, -1, 0), (-1, 0, 0))
    assert found == pytest.approx(expected, rel=1e-5)


def test_every_pixel_of_a_ball_has_the_light_of_its_normal_where_lights_and_eye_are_far() -> None:
    lights = Light("key", (FAR, -FAR, FAR)), Light("rim", (-FAR, 0, 0.3 * FAR), 0.6)
    scene = far_ball(*lights, diffuse=0.7, specular=0.6, exponent=20).replace(words="normals")
    picture = render(scene, 60, 80)
    assert picture.normals is not None
    count = len(picture.pixels)
    lit = light_at_normals(scene, picture.normals, picture.slices, np.arange(count), count)
    # Some of the difference is that of the eye, which is not endlessly far.
    assert lit.relative * lit.scale == pytest.approx(picture.relative * picture.scale, abs=1e-3)


def test_a_light_at_infinity_shines_along_its_axis() -> None:
    sun = Light("sun", (5, 5, 5), direction=(-1, 0, 0), at_infinity=True)
    point = Light("point", (1, 0, 0))
    assert intensities(far_ball(sun), LEFT, (0, 0, 1)) == intensities(far_ball(point), LEFT, (0, 0, 1))


def test_a_light_that_follows_the_eye_shines_from_there() -> None:
    head_lamp = Light("head", (0, 0, 0), follows="eye")
    assert intensities(far_ball(head_lamp), (0, -1, 0)) == intensities(
        far_ball(Light("a", (0, -3, 0))), (0, -1, 0)
    )


def test_controls_and_links_that_depend_on_places_are_left_out() -> None:
    plain = Light("key", (4, -3, 2), 1.5)
    shaped = plain.replace(
        aim=(9, 9, 9), concentration=40, cone_angle=5, flaps=Flaps(x=Flap(8, 9)), reach=0.1, falloff="linear"
    )
    normals = LEFT, (0, 0, 1), (1, 0, 0)
    assert intensities(far_ball(shaped), *normals) == intensities(far_ball(plain), *normals)


def test_a_far_light_keeps_every_column_but_those_of_its_place() -> None:
    light = Light("sun", (4, -3, 2), aim=(9, 9, 9), at_infinity=True).replace(only_parts=("sphere",))
    far = far_light(light, (0, 0, 0))
    differing = {name for name in fields_of(Light) if vars(far)[name] != vars(light)[name]}
    assert differing == {"position", "at_infinity", "links"}


def test_links_to_surfaces_stay_and_links_to_parts_are_left_out() -> None:
    light = Light("key", (4, -3, 2), on=False).replace(only_parts=("sphere",), except_surfaces=("shell",))
    far = far_light(light, (0, 0, 0))
    assert far.links.except_surfaces == ("shell",)
    assert far.links.only_parts is None
    assert not far.on


def test_a_light_in_the_middle_of_the_object_gives_nothing() -> None:
    assert intensities(far_ball(Light("inside", (0, 0, 0))), LEFT, (0, -1, 0)) == pytest.approx([0.1, 0.1])


def test_without_lights_there_is_the_ambient_light_alone() -> None:
    assert intensities(far_ball(), LEFT, (0, 0, 0)) == pytest.approx([0.1, 0.1])


def test_the_distance_of_lights_and_eye_does_not_matter() -> None:
    near, far = (
        far_ball(Light("a", (0, 0, 2)), eye=(0, -3, 0)),
        far_ball(Light("a", (0, 0, 2e20)), eye=(0, -3e20, 0)),
    )
    assert intensities(near, LEFT, (0, 0, 1)) == pytest.approx(intensities(far, LEFT, (0, 0, 1)))


def test_the_picture_of_normals_has_one_line_with_an_element_for_each_number() -> None:
    normals = np.array([[0.0], [0.0], [-1.0]], np.float32)
    lit = light_at_normals(far_ball(), normals, (SurfaceSlice(1, 0, 1),), np.array([7]), 10)
    assert isinstance(lit, Picture)
    assert lit.intensity.shape == (1, 10)
    assert np.flatnonzero(lit.surface_number).tolist() == [7]
