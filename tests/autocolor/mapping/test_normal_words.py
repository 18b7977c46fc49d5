from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light, Scene, Surface, View, render, scene_of
from autocolor.arrays import Singles
from autocolor.checks import Vector
from autocolor.images import display_image
from autocolor.mapping.normal_words import (
    BINS,
    NormalImage,
    cells_of,
    light_at_normals,
    normal_light,
    spread_of,
    words_at_levels,
    words_of_normals,
)
from autocolor.scene.scene import AUTO, OBJECT, Exposure
from autocolor.testing import scenes
from autocolor.visibility.visible_points import SurfaceSlice
from tests.autocolor import reference
from tests.autocolor.twins import point as plain
from tests.autocolor.twins.level import curved
from tests.autocolor.twins.light import direction_to, specular_factor
from tests.autocolor.twins.point import dot, minus
from tests.small import sphere

LINES, ELEMENTS = 24, 32


def image_of(scene: Scene, lines: int = LINES, elements: int = ELEMENTS) -> NormalImage:
    scene = scene.replace(words="normals")
    image = display_image(scene, render(scene, (elements, lines)))
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
    # Whether there is light is decided by rounding, too.
    most, dark = max(everything or [0]), scene.ambient * (1 + 2.0**-20)
    assume(most == scene.ambient or most > dark * (1 + 1e-5))
    is_dark = OBJECT not in held and most <= dark
    if is_dark:
        # Nothing but ambient light is mapped to the lowest level.
        whole = whole[0], 1e9 * max(whole[1], 1)
    for each in image.normals.slices:
        surface = scene.surfaces[each.surface_number - 1]
        values = intensity_of[surface.name]
        brightest, extent = max(values), max(values) - min(values)
        # Whether a surface has an extent may be decided by rounding.
        assume(not 1e-7 * brightest < extent < 1e-5 * brightest)
        # A surface without extent is not trimmed, and has the range of the object.
        low, high = whole if extent <= 1e-7 * brightest else range_of(values, scene.exposure)
        if scene.scaling == "object" or OBJECT in held or is_dark:
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
    # Without a stage, all samples are of the object.
    parts = tuple(part.replace(stage=False) for part in scene.parts)
    scene = dataclasses.replace(scene, scalar=None, parts=parts)
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
    scene = scene_of(sphere(96, 48), surfaces=[Surface("shell")], surface_of_part={"sphere": "shell"})
    scene = scene.replace(lights=lights, view=view, ambient=0.1)
    return scene.with_surface("shell", diffuse=0.75, specular=0.5, exponent=exponent, blend=0.6)


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


def test_a_hood_that_is_nearly_flat_has_more_cells_than_bins() -> None:
    turns = np.linspace(0, 2 * np.pi, 200)
    tilts = np.radians(4) * np.sqrt(np.linspace(0, 1, 400))[:, None]
    hood = unit([np.sin(tilts) * np.cos(turns), np.sin(tilts) * np.sin(turns), -np.cos(tilts) + 0 * turns])
    normals = np.concatenate([ball(150), hood.reshape(3, -1)], axis=1)
    cells = cells_of(normals, 600)
    bins = np.pi * (BINS / 2 * np.sqrt(2) * np.sin(np.radians(2))) ** 2
    assert np.count_nonzero(-cells.normals[2] > np.cos(np.radians(4))) > 2 * bins


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


def test_no_normals_have_no_cells_and_a_zero_normal_has_one() -> None:
    nothing = cells_of(np.empty((3, 0), np.float32), 10)
    assert nothing.normals.shape == (3, 0)
    assert nothing.numbers.shape == (0,)
    zero = cells_of(np.zeros((3, 4), np.float32), 10)
    assert zero.normals.tolist() == [[0], [0], [0]]
    assert zero.numbers.tolist() == [0, 0, 0, 0]


def test_the_spread_of_normals_is_how_much_of_the_sphere_they_take() -> None:
    front = ball(400)
    half = spread_of(front)
    # Half of the sphere is half of the disk in the square of all bins.
    assert half == pytest.approx(np.pi / 4 * BINS**2 / 2, rel=0.03)
    # A cap of half the height has half the area of the half sphere, and the whole sphere twice the area.
    assert spread_of(front[:, front[2] < -0.5]) == pytest.approx(half / 2, rel=0.03)
    assert spread_of(np.concatenate([front, -front], axis=1)) == pytest.approx(2 * half, rel=0.03)


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


def test_every_pixel_of_a_ball_has_the_light_of_its_normal_where_lights_and_eye_are_far() -> None:
    lights = Light("key", (FAR, -FAR, FAR)), Light("rim", (-FAR, 0, 0.3 * FAR), 0.6)
    scene = far_ball(*lights, diffuse=0.7, specular=0.6, exponent=20).replace(words="normals")
    picture = render(scene, (80, 60))
    assert picture.normals is not None
    count = len(picture.pixels)
    lit = light_at_normals(scene, picture.normals, picture.slices, np.arange(count), count)
    # Some of the difference is that of the eye, which is not endlessly far.
    assert lit.relative * lit.scale == pytest.approx(picture.relative * picture.scale, abs=1e-3)


@pytest.mark.parametrize(("exponent", "mean", "most"), [(5, 3, 35), (100, 3, 70)])
def test_the_picture_of_a_ball_differs_little_from_the_true_one(
    exponent: float, mean: float, most: int
) -> None:
    scene = ball_scene(exponent)
    picture = render(scene, (160, 120))
    image = image_of(scene, 120, 160)
    differences = np.abs(image.colors - display_image(scene, picture).colors.astype(np.int64))
    on_ball = picture.surface_number > 0
    assert differences[on_ball].mean() < mean
    assert differences.max() < most

    # The words in use are those of the pixels, and within the range of the surface.
    low, levels = image.ranges["shell"]
    seen = np.unique(image.words)
    assert seen.tolist() == [0, *image.normals.words.tolist()]
    assert low <= seen[1] <= seen[-1] < low + levels
    assert ((image.words > 0) == on_ball).all()
    # Levels rise from the darkest to the brightest color.
    at_levels = image.words_at_levels("shell")
    colors = image.entries[at_levels].astype(int).sum(axis=1)
    assert (np.diff(colors) >= 0).all()
    assert colors[-1] == image.entries[seen].astype(int).sum(axis=1).max()
    plain = display_image(scene, picture)
    assert plain.words_at_levels("shell").tolist() == list(range(1, 1 + plain.ranges["shell"].levels))


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
    # In zones of equal area, from the silhouette to the middle, where one covers seven times the pixels.
    counts, _ = np.histogram(-cells.normals[2], bins=np.linspace(0, 1, 5))
    assert 60 < counts[0] < counts[-1] < 500


@pytest.mark.parametrize(
    ("normals", "count"),
    [
        ([[0, 0, 0.7, 0, 0.7], [0, 0.5, 0, 0, 0], [-1, -0.8, -0.7, -1, -0.7]], 3),
        # Some face away from the eye.
        ([[0.1, 0.0, 1.0, -1.0], [0.0, 0.0, 0.2, 0.3], [0.99, -1.0, 0.9, 0.8]], 4),
    ],
)
def test_as_few_normals_as_there_are_cells_have_a_cell_each(normals: list[list[float]], count: int) -> None:
    cells = cells_of(unit(normals), count)
    assert cells.normals[:, cells.numbers] == pytest.approx(unit(normals), abs=1e-6)
    assert cells.normals.shape[1] == count


LEFT = (math.sqrt(0.5), -math.sqrt(0.5), 0.0)
SIDES: list[Vector] = [LEFT, (1, 0, 0), (0, -1, 0), (-1, 0, 0), (0, 0, 1)]
KEY = Light("key", (4, -3, 2), 1.5)


def test_a_light_gives_its_diffuse_and_specular_term_at_a_normal() -> None:
    scene = far_ball(Light("key", (FAR, 0, 0), 2.0), diffuse=0.5, specular=0.25, exponent=8)
    # At LEFT, half-way between light and eye, the light is reflected into the eye.
    expected = [0.1 + 2 * (0.5 * math.sqrt(0.5) + 0.25), 0.1 + 2 * 0.5, 0.1, 0.1, 0.1]
    assert intensities(scene, *SIDES) == pytest.approx(expected, rel=1e-5)
    # Without lights, and at a zero normal, there is the ambient light alone.
    assert intensities(far_ball(), LEFT, (0, 0, 0)) == pytest.approx([0.1, 0.1])
    assert intensities(far_ball(Light("inside", (0, 0, 0))), LEFT, (0, -1, 0)) == pytest.approx([0.1, 0.1])


@pytest.mark.parametrize(
    ("light", "like"),
    [
        # A light at infinity shines along its axis, and one that follows the eye from there.
        (Light("sun", (5, 5, 5), direction=(-1, 0, 0), at_infinity=True), Light("point", (1, 0, 0))),
        (Light("head", (0, 0, 0), follows="eye"), Light("point", (0, -3, 0))),
        # The distance does not matter, nor do controls and links that depend on places.
        (KEY.replace(position=(4e20, -3e20, 2e20)), KEY),
        (
            KEY.replace(aim=(9, 9, 9), concentration=40, cone_angle=5, flaps=Flaps(x=Flap(8, 9))).replace(
                reach=0.1, falloff="linear", only_parts=()
            ),
            KEY,
        ),
    ],
)
def test_a_far_light_is_like_one_in_its_direction(light: Light, like: Light) -> None:
    assert intensities(far_ball(light), *SIDES) == pytest.approx(
        intensities(far_ball(like), *SIDES), rel=1e-6
    )
