"""The claims of the paper in its own order, a short test for each: D. R. Warn, SIGGRAPH 1983.

`pytest -m paper` runs these alone. Most of them light a wall, a square in the plane y = 0, that the eye sees
straight from the front, so that every angle of Figures 1 and 3 is known for every pixel.
"""

from __future__ import annotations

import mmap
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pytest

import autocolor
from autocolor import Flap, Light, Mesh, Paint, Reflectance, Scene, Studio, View, scene_of
from autocolor.screens.viewer import Viewer
from autocolor.testing import Recoloring, check_entries_outside_range_stay, check_recoloring_moves_no_word
from ramtek_emu import Configuration, Ramtek9300
from tests.autocolor.reference import first_hit, ray
from tests.autocolor.screens.painting_hand import PaintingHand, boxes_scene
from tests.small import STRETCHED, cube, grid, sphere, wall, wall_scene

pytestmark = pytest.mark.paper

COUPE = Path(__file__).parents[1] / "scenes" / "coupe"
SHAPE = LINES, ELEMENTS = (48, 64)
SIZE = (ELEMENTS, LINES)
SMALL = Configuration(name="SMALL", elements=ELEMENTS, lines=LINES, planes=10, entries=1024)
EYE = np.array([0.0, -4.0, 0.0])
NORMAL = np.array([0.0, -1.0, 0.0])
D, S, N = 0.7, 0.5, 20.0

Floats = npt.NDArray[np.float64]


def lit_wall(*lights: Light, **fields: Any) -> Scene:
    """The wall, which fills the raster, with these lights alone."""
    return wall_scene(wall(half=2.0), Reflectance(D, S, N), lights=lights, **fields)


def intensity(scene: Scene) -> npt.NDArray[np.float32]:
    """The unscaled intensities of a scene, (48, 64)."""
    return autocolor.render(scene, SIZE).intensity


def points() -> Floats:
    """The point P of the wall at the center of each pixel, (48, 64, 3)."""
    pixel = 2 * 4 * np.tan(np.radians(25) / 2) / LINES
    x = (np.arange(ELEMENTS) + 0.5 - ELEMENTS / 2) * pixel
    z = (LINES / 2 - np.arange(LINES) - 0.5) * pixel
    across, up = np.meshgrid(x, z)
    return np.stack([across, np.zeros(SHAPE), up], axis=-1)


def unit(vectors: Floats) -> Floats:
    """Vectors of length 1."""
    lengths: Floats = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / lengths


def cosines(position: tuple[float, float, float]) -> tuple[Floats, Floats]:
    """cos(I) and cos(E) of Figure 1 at each pixel for a light at a position."""
    to_light, to_eye = unit(np.array(position) - points()), unit(EYE - points())
    cos_incidence = to_light @ NORMAL
    reflected = 2 * cos_incidence[..., None] * NORMAL - to_light
    return cos_incidence, np.clip((reflected * to_eye).sum(axis=-1), 0, 1)


def cos_light(position: tuple[float, float, float], direction: tuple[float, float, float]) -> Floats:
    """cos(L) of Figure 3 at each pixel."""
    toward: Floats = unit(points() - np.array(position)) @ unit(np.array(direction))
    return toward


def shown(scene: Scene) -> tuple[Studio, Ramtek9300]:
    """A scene in the studio, and the small display that shows it."""
    display = Ramtek9300(SMALL)
    return Studio(scene, display), display


def two_boxes() -> Scene:
    """Two cubes, each with a surface of its own, under one light."""
    lamp = Light("lamp", (-3.0, -5.0, 6.0))
    return boxes_scene(2).replace(**STRETCHED).replace(lights=[lamp])


# Introduction.


def test_the_shape_is_a_mesh_of_polygons_with_three_or_four_sides() -> None:
    """A triangle repeats its last node."""
    mesh = Mesh(np.eye(4, 3), np.array([[0, 1, 2, 3], [0, 1, 2, 2]]), np.array([0, 0]), ("part",))
    assert mesh.node_numbers.tolist() == [[0, 1, 2, 3], [0, 1, 2, 2]]
    with pytest.raises(autocolor.InputError, match=r"\(rows, 3\) or \(rows, 4\)"):
        Mesh(np.eye(5, 3), np.array([[0, 1, 2, 3, 4]]), np.array([0]), ("part",))


def test_polygons_form_parts_and_each_part_has_a_surface_type() -> None:
    scene = autocolor.read_scene(COUPE)
    assert len(scene.mesh.part_names) > len({part.surface for part in scene.parts}) > 1
    assert {part.surface for part in scene.parts} <= {surface.name for surface in scene.surfaces}


def test_the_tables_are_a_relational_data_base_that_can_be_asked_and_changed(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "boxes.sqlite", two_boxes())
    with autocolor.open_tables(tmp_path / "boxes.sqlite") as tables:
        (row,) = tables.select(
            "SELECT count(*) AS polygons FROM polygons JOIN parts ON polygons.part = parts.name"
            " WHERE parts.surface = 'box 1'"
        )
        assert row == {"polygons": 6}
        tables.update("lights", "lamp", intensity=2.5)
    assert autocolor.read_scene(tmp_path / "boxes.sqlite").lights["lamp"].intensity == 2.5


def test_tables_that_are_missing_are_created_and_give_the_same_picture_when_saved(tmp_path: Path) -> None:
    created = scene_of(cube())
    assert created.lights
    assert created.surfaces
    autocolor.write_scene(tmp_path / "scene", created)
    saved = autocolor.read_scene(tmp_path / "scene")
    assert (intensity(saved) == intensity(created)).all()


def test_tables_are_mapped_into_memory_and_read_as_they_are_used(tmp_path: Path) -> None:
    np.save(tmp_path / "nodes.npy", cube().coordinates)
    np.save(tmp_path / "polygons.npy", cube().node_numbers)
    mesh = autocolor.read_scene(tmp_path).mesh
    for table in (mesh.coordinates, mesh.node_numbers):
        base: Any = table
        while isinstance(base, np.ndarray):
            base = base.base
        assert isinstance(base, mmap.mmap)


def test_the_hidden_surface_algorithm_sees_what_a_ray_through_each_pixel_meets_first() -> None:
    cubes = scene_of(
        cube(), view=View((3.0, -4.0, 2.0), target=(0.5, 0.5, 0.5)), surface_of_part={"cube": "cube"}
    )
    seen = autocolor.render(cubes, SIZE).surface_number > 0
    hit = [
        [
            first_hit(cubes.mesh, cubes.view.eye, ray(cubes.view, *SHAPE, line, element)).polygon >= 0
            for element in range(ELEMENTS)
        ]
        for line in range(LINES)
    ]
    assert (seen == hit).all()


def test_polygons_that_pierce_each_other_are_cut_where_they_cross() -> None:
    """The top of the leaning wall is nearer than the upright one; they cross at z = 0."""
    upright, leaning = wall(), grid(1, 1, (-1, 0.5, -1), (2, 0, 0), (0, -1, 2), "leaning")
    picture = autocolor.render(wall_scene(Mesh.joined([upright, leaning])), SIZE)
    column = [picture.surfaces[number - 1] if number else "" for number in picture.surface_number[:, 32]]
    assert column[10:24] == ["leaning"] * 14
    assert column[24:34] == ["wall"] * 10


def test_scalars_such_as_curvature_are_shown_as_colors() -> None:
    ball = scene_of(sphere(), ambient=0.5).with_scalar(name="mean curvature", limits=(0, 2), bands=4)
    studio, display = shown(ball)
    studio.scalar(shades=1)
    assert len(np.unique(display.field().reshape(-1, 3), axis=0)) <= 4 + 1


# The lighting model: Figures 1 and 2.


@pytest.mark.parametrize("strength", [0.5, 3.0])
def test_each_light_gives_its_intensity_times_d_cos_i_plus_s_cos_n_e(strength: float) -> None:
    position = (1.0, -3.0, 2.0)
    cos_incidence, cos_eye = cosines(position)
    expected = strength * (D * cos_incidence + S * cos_eye**N)
    assert intensity(lit_wall(Light("a", position, strength))) == pytest.approx(expected, rel=1e-4)


def test_a_surface_that_is_turned_away_from_a_light_gets_nothing_from_it() -> None:
    assert not intensity(lit_wall(Light("behind", (0.0, 3.0, 0.0)))).any()


def test_the_intensity_at_a_point_is_the_sum_of_all_lights_and_an_ambient_term() -> None:
    a, b = Light("a", (1.0, -3.0, 2.0)), Light("b", (-2.0, -2.0, 0.0), 0.4)
    both = intensity(lit_wall(a, b, ambient=0.3))
    alone = intensity(lit_wall(a)) + intensity(lit_wall(b))
    assert both == pytest.approx(alone + 0.3, rel=1e-5)


def test_normals_are_interpolated_between_the_nodes() -> None:
    """A sphere of 12 flat polygons around is lit as a true sphere is, by cos(I) of its own normal."""
    ball = wall_scene(sphere(12, 96), lights=[Light("far", (0.0, -1e4, 0.0))])
    ball = ball.with_surface("sphere", diffuse=1.0, specular=0.0)

    studio, _ = shown(ball)
    for element in range(20, 44):
        seen = studio.seen_at(LINES // 2, element)
        if seen is not None:
            around = np.array([seen.point[0], seen.point[1]])
            cos_incidence = -around[1] / np.linalg.norm(around)
            assert studio.picture.intensity[LINES // 2, element] == pytest.approx(cos_incidence, abs=0.02)


def test_s_may_be_a_function_of_the_angle_of_incidence() -> None:
    """Section 2: "For a more accurate rendering"; the highlight of a grazing light grows, D does not."""
    grazing = Light("low", (0.0, -0.4, 3.0))
    plain = lit_wall(grazing)
    model = plain.surfaces[0].replace(refractive_index=1.5)
    assert intensity(plain.replace(surfaces=[model])).max() > intensity(plain).max()


def test_intensities_are_unscaled_floats_without_an_upper_limit() -> None:
    bright = intensity(lit_wall(Light("a", (0.0, -3.0, 0.0), 1e6)))
    assert bright.dtype == np.float32
    assert bright.max() > 1e6


def test_the_number_of_the_surface_at_each_pixel_is_in_an_array_of_its_own() -> None:
    picture = autocolor.render(two_boxes(), SIZE)
    assert picture.surface_number.shape == SHAPE
    assert set(np.unique(picture.surface_number)) == {0, 1, 2}
    assert picture.surfaces == ("box 0", "box 1")


def test_minimum_and_maximum_are_found_for_the_picture_and_for_each_surface() -> None:
    picture = autocolor.render(two_boxes(), SIZE)
    for number, name in enumerate(picture.surfaces, 1):
        of_surface = picture.intensity[picture.surface_number == number]
        assert picture.ranges.surfaces[name] == (of_surface.min(), of_surface.max())
    seen = picture.intensity[picture.surface_number > 0]
    assert picture.ranges.whole == (seen.min(), seen.max())


@pytest.mark.parametrize("scaling", ["surface", "object"])
def test_intensities_are_rescaled_by_the_range_of_each_surface_or_of_the_object(
    scaling: Literal["surface", "object"],
) -> None:
    studio, _ = shown(two_boxes().replace(scaling=scaling))
    picture = studio.picture
    for number, name in enumerate(picture.surfaces, 1):
        first, levels = studio.level_ranges[name]
        low, high = picture.ranges.surfaces[name] if scaling == "surface" else picture.ranges.whole
        here = picture.surface_number == number
        fractions = (picture.intensity[here].astype(float) - low) / (high - low)
        assert np.abs(studio.words[here] - first - fractions * (levels - 1)).max() <= 0.5 + 1e-3


@pytest.mark.parametrize("factor", [0.01, 1000.0])
def test_any_multiple_of_all_light_gives_the_same_words(factor: float) -> None:
    """So there is no restriction on D, S, and the number or intensity of lights."""
    scene = two_boxes()
    stronger = [light.replace(intensity=light.intensity * factor) for light in scene.lights]
    words = shown(scene)[0].words
    assert (shown(scene.replace(lights=stronger, ambient=scene.ambient * factor))[0].words == words).all()


def test_nonlinear_mappings_are_tried_without_rendering_again() -> None:
    studio, _ = shown(two_boxes())
    picture, linear = studio.picture, studio.words
    studio.edit(studio.scene.replace(mapping="logarithm"))
    assert studio.picture.intensity is picture.intensity
    assert (studio.words >= linear).all()
    assert (studio.words > linear).any()


# Light Controls: Figures 3 and 4, flaps and cones.


@pytest.mark.parametrize("concentration", [1.0, 10.0, 40.0])
def test_a_directed_light_is_multiplied_by_cos_c_l(concentration: float) -> None:
    position, direction = (0.5, -2.0, 0.5), (0.2, 1.0, -0.4)
    point = Light("a", position)
    aimed = point.replace(direction=direction, concentration=concentration)
    factor = cos_light(position, direction) ** concentration
    assert intensity(lit_wall(aimed)) == pytest.approx(factor * intensity(lit_wall(point)), rel=1e-3)


@pytest.mark.parametrize(("concentration", "degrees"), [(1, 60.0), (10, 21.1), (40, 10.6)])
def test_the_light_falls_to_a_half_at_the_angle_that_its_concentration_tells(
    concentration: float, degrees: float
) -> None:
    assert np.cos(np.radians(degrees)) ** concentration == pytest.approx(0.5, abs=3e-3)
    x = float(np.tan(np.radians(degrees)))
    lamp = Light("a", (0.0, -1.0, 0.0), direction=(0.0, 1.0, 0.0), concentration=concentration)
    eye = View((x, -0.1, 0.0), target=(x, 0.0, 0.0))
    scene = wall_scene(wall(half=4.0), Reflectance(1, 0, 1), view=eye, lights=[lamp])
    half, all_of_it = intensity(scene), intensity(scene.replace(lights=[lamp.replace(concentration=0)]))
    middle = LINES // 2, ELEMENTS // 2
    assert half[middle] / all_of_it[middle] == pytest.approx(0.5, abs=0.01)


def test_with_a_concentration_of_0_it_is_a_point_source_light() -> None:
    lamp = Light("a", (1.0, -2.0, 0.0))
    aimed = lamp.replace(direction=(1.0, 0.0, 0.0))
    assert (intensity(lit_wall(aimed)) == intensity(lit_wall(lamp))).all()


def test_a_concentrated_light_shines_forward_alone() -> None:
    away = Light("a", (0.0, -2.0, 0.0), direction=(0.0, -1.0, 0.0), concentration=1)
    assert not intensity(lit_wall(away)).any()


def test_aiming_takes_the_bright_spot_off_the_plane() -> None:
    """Figure 4, A and B."""
    scene = autocolor.read_scene(COUPE.parent / "pyramid")
    point = autocolor.render(scene, SIZE)
    aimed = scene.lights["lamp"].replace(aim=(0.5, 0.0, 0.9), concentration=1)
    flood = autocolor.render(scene.replace(lights=[aimed]), SIZE)
    assert flood.ranges.surfaces["plane"].maximum < 0.6 * point.ranges.surfaces["plane"].maximum


def test_the_controls_modify_the_light_of_any_reflection_model() -> None:
    position, direction = (0.5, -2.0, 0.5), (0.0, 1.0, 0.0)
    lamp = Light("a", position)
    aimed = lamp.replace(direction=direction, concentration=5)
    for model in ("blinn", "cook-torrance"):
        scene = lit_wall(lamp)
        scene = scene.replace(surfaces=[scene.surfaces[0].replace(model=model)])
        expected = cos_light(position, direction) ** 5 * intensity(scene)
        assert intensity(scene.replace(lights=[aimed])) == pytest.approx(expected, rel=1e-3)


def test_each_light_can_be_shown_alone_and_the_picture_is_their_sum() -> None:
    """Figure 8."""
    scene = autocolor.read_scene(COUPE)
    dark = scene.replace(ambient=0)
    alone = np.sum([intensity(dark.only_lights(light.name)) for light in scene.lights], axis=0)
    whole = autocolor.render(scene, SIZE)
    seen = whole.surface_number > 0
    assert whole.intensity[seen] == pytest.approx(alone[seen] + scene.ambient, rel=1e-4)


def test_words_may_stand_for_normals_so_that_a_light_moves_by_entries_alone() -> None:
    """Reference 2, D. H. Bass: "using the lookup table to store surface normal information"."""
    ball = scene_of(sphere(), words="normals", lights=[Light("sun", (-5.0, -5.0, 5.0))])
    studio, display = shown(ball)
    written, field = display.frame_buffer.written, display.field()
    studio.light("sun", position=(5.0, -5.0, 5.0))
    assert display.frame_buffer.written == written
    assert (display.field() != field).any()


def test_flaps_leave_light_between_a_minimum_and_a_maximum_of_a_coordinate() -> None:
    lamp = Light("a", (0.0, -3.0, 0.0))
    flapped = lamp.replace(flaps={"x": {"minimum": -0.3, "maximum": 0.2}})
    x = points()[..., 0]
    expected = np.where((x >= -0.3) & (x <= 0.2), intensity(lit_wall(lamp)), 0)
    assert (intensity(lit_wall(flapped)) == expected).all()


def test_a_flap_that_is_switched_off_keeps_its_values_and_leaves_all_light() -> None:
    lamp = Light("a", (0.0, -3.0, 0.0))
    off = lamp.replace(flaps={"z": {"minimum": 0.0, "maximum": 0.1, "on": False}})
    assert off.flaps.z == Flap(0.0, 0.1, on=False)
    assert (intensity(lit_wall(off)) == intensity(lit_wall(lamp))).all()


def test_flaps_along_any_plane_are_half_spaces() -> None:
    lamp = Light("a", (0.0, -3.0, 0.0))
    cut = lamp.replace(half_spaces={"slanted": {"point": (0, 0, 0), "direction": (1, 0, 1)}})
    inside = points() @ np.array([1.0, 0.0, 1.0]) >= 0
    assert (intensity(lit_wall(cut)) == np.where(inside, intensity(lit_wall(lamp)), 0)).all()


def test_a_cone_lights_what_is_within_its_angle_and_its_rim_is_sharp() -> None:
    position, direction, angle = (0.5, -2.0, 0.0), (-0.2, 1.0, 0.1), 15.0
    lamp = Light("a", position, direction=direction)
    inside = cos_light(position, direction) >= np.cos(np.radians(angle))
    coned = intensity(lit_wall(lamp.replace(cone_angle=angle)))
    assert (coned == np.where(inside, intensity(lit_wall(lamp)), 0)).all()


def test_a_cone_isolates_one_of_several_objects() -> None:
    scene = two_boxes().replace(ambient=0.0)
    coned = scene.lights[0].replace(position=(1.9, 0.5, 9.0), aim=(1.9, 0.5, 0.5), cone_angle=4.0)
    picture = autocolor.render(scene.replace(lights=[coned]), SIZE)
    assert picture.ranges.surfaces["box 1"].maximum > 0
    assert picture.ranges.surfaces["box 0"].maximum == 0


def test_all_controls_can_be_used_together() -> None:
    position, direction = (0.2, -2.0, 0.0), (0.0, 1.0, 0.0)
    lamp = Light("a", position)
    every = lamp.replace(
        direction=direction, concentration=8, cone_angle=20.0, flaps={"z": {"minimum": -0.1, "maximum": 1.0}}
    )
    cosine = cos_light(position, direction)
    inside = (cosine >= np.cos(np.radians(20))) & (points()[..., 2] >= -0.1)
    expected = np.where(inside, cosine**8 * intensity(lit_wall(lamp)), 0)
    assert intensity(lit_wall(every)) == pytest.approx(expected, rel=1e-3)


# Light Source Color Blending: Figures 11, 12 and 15.


def test_the_display_has_words_of_ten_bits_and_one_table_of_1024_entries_of_24_bits() -> None:
    display = Ramtek9300()
    assert display.words.shape == (480, 640)
    assert display.configuration.planes == 10
    assert display.entries.shape == (1024, 3)
    assert display.entries.dtype == np.uint8


def test_each_surface_type_has_a_sequential_range_of_the_table() -> None:
    """Figure 11."""
    studio, display = shown(two_boxes())
    ranges = sorted(studio.level_ranges.values())
    assert all(low.last < high.first for low, high in pairwise(ranges))
    for number, name in enumerate(studio.picture.surfaces, 1):
        own = display.words[studio.picture.surface_number == number]
        first, levels = studio.level_ranges[name]
        assert first <= own.min() <= own.max() < first + levels


def test_recoloring_replaces_one_range_of_entries_and_computes_no_picture() -> None:
    studio, display = shown(two_boxes())
    picture, entries = studio.picture, display.entries
    edit = Recoloring("box 1", {"object_color": "#123456", "light_color": "#ffeedd", "blend": 0.2})
    check_recoloring_moves_no_word(
        studio, lambda studio: check_entries_outside_range_stay(studio, edit, "box 1")
    )
    assert (display.entries != entries).any()
    assert studio.picture is picture


def blended(blend: float, percentage: float = 100.0) -> Floats:
    """The entries of a surface in pure red under green light, from its lowest level up."""
    paint = Paint((255, 0, 0), (0, 255, 0), blend, percentage)
    scene = lit_wall(Light("a", (0.0, -3.0, 0.0)))
    studio, display = shown(scene.replace(surfaces=[scene.surfaces[0].replace(paint=paint)]))
    first, levels = studio.level_ranges["wall"]
    return display.entries[first : first + levels].astype(float)


def test_below_the_blend_intensity_there_is_object_color_alone() -> None:
    entries = blended(0.5)
    assert not entries[: len(entries) // 2, 1].any()


def test_above_the_blend_intensity_the_color_goes_in_equal_steps_to_the_light_color() -> None:
    """Figure 12: N equal steps; the share of the light color grows by the same each level."""
    entries = blended(0.5)
    above = entries[len(entries) // 2 + 1 :]
    share = above[:, 1] / above.sum(axis=1)
    assert share[-1] == 1
    assert np.diff(share) == pytest.approx(np.full(len(share) - 1, 1 / len(share)), abs=0.01)


def test_the_share_of_the_light_color_at_the_maximum_can_be_set() -> None:
    assert blended(0.5, 40.0)[-1].tolist() == pytest.approx([0.6 * 255, 0.4 * 255, 0], abs=1)


def test_a_blend_from_the_lowest_intensity_looks_like_metallic_paint() -> None:
    """Figure 15, C: the color shifts at every level."""
    entries = blended(0.0)[16:]
    share = entries[:, 1] / entries.sum(axis=1)
    assert (np.diff(share) > -0.02).all()
    assert share[len(share) // 2] == pytest.approx(0.5, abs=0.02)


def test_a_blend_at_the_highest_intensity_leaves_the_object_color() -> None:
    assert not blended(1.0)[:, 1].any()


# The interactive displays: Figures 5, 13 and 14.


@pytest.fixture
def hand(tmp_path: Path) -> Callable[[Scene], PaintingHand]:
    """A hand on the joystick of a display that shows the studio."""
    return lambda scene: PaintingHand(Viewer(scene, Ramtek9300(), tmp_path))


def test_a_light_is_moved_in_two_views_without_typing_coordinates(
    hand: Callable[[Scene], PaintingHand],
) -> None:
    """Figure 5: the top view changes x and y, the front view z."""
    at_work = hand(two_boxes())
    at_work.turn_to("light & view")
    x, y, z = at_work.viewer.studio.scene.lights["lamp"].position
    element, line = place_of_lamp(at_work, "top")
    at_work.drag((element, line), (element + 12, line + 9))
    moved = at_work.viewer.studio.scene.lights["lamp"].position
    assert (moved[0] != x, moved[1] != y, moved[2] == z) == (True, True, True)
    element, line = place_of_lamp(at_work, "front")
    at_work.drag((element, line), (element, line + 9))
    lowered = at_work.viewer.studio.scene.lights["lamp"].position
    assert (lowered[1] == moved[1], lowered[2] < z) == (True, True)


def place_of_lamp(hand: PaintingHand, view: str) -> tuple[int, int]:
    """Where the position of the lamp is marked in one of the three views: element and line."""
    (place,) = (
        (handle.element, handle.line)
        for handle in hand.viewer.board.content.handles
        if handle.label.startswith("lamp") and f"'{view}'" in repr(handle.key)
    )
    return place


def test_the_angle_turns_the_horizontal_axis_of_the_picture_plane() -> None:
    """Figure 5, ANGLE: a quarter turn of a square picture turns its rows into columns."""
    scene = lit_wall(Light("a", (1.0, -3.0, 2.0)))
    upright = autocolor.render(scene, (40, 40)).intensity
    turned = autocolor.render(scene.with_view(angle=90.0), (40, 40)).intensity
    assert turned == pytest.approx(np.rot90(upright, -1), rel=1e-4)


def test_a_color_is_mixed_by_bars_and_then_the_picture_is_sent_again(
    hand: Callable[[Scene], PaintingHand],
) -> None:
    """Figure 13."""
    at_work = hand(two_boxes())
    at_work.turn_to("color mixing")
    red = at_work.paint.object_color[0]
    at_work.pull("object, red", 0.3, 0.9)
    assert at_work.paint.object_color[0] != red
    at_work.leave()
    assert at_work.shows(at_work.scene)


def test_the_white_bar_changes_all_three_components_by_the_same_amount(
    hand: Callable[[Scene], PaintingHand],
) -> None:
    """Figure 13: "to generate tints or shades"."""
    at_work = hand(two_boxes())
    at_work.turn_to("color mixing")
    before = np.array(at_work.paint.object_color)
    at_work.pull("object, white", 0.3, 0.4)
    assert len(set(at_work.paint.object_color - before)) == 1
    assert at_work.paint.object_color[0] != before[0]


def test_the_blend_is_picked_on_a_bar_beside_the_picture_and_shows_at_once(
    hand: Callable[[Scene], PaintingHand],
) -> None:
    """Figure 14."""
    at_work = hand(two_boxes())
    at_work.turn_to("light blending")
    written, blend = at_work.display.frame_buffer.written, at_work.paint.blend
    area = at_work.widget("blend level").area
    at_work.click((area.left + area.right) // 2, area.top + area.height // 4)
    assert at_work.paint.blend != blend
    assert at_work.display.frame_buffer.written - written < 0.1 * at_work.display.words.size
