"""The stage that is made for any mesh, and the backdrop."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import Light, Mesh, Scene, Studio, Surface, View, image, read_picture, render, scene_of
from autocolor.images import display_image
from autocolor.mapping.ranges import BACKDROP, SURFACE_WORDS
from autocolor.scene.columns import from_plain, to_plain
from autocolor.scene.creation import new_light_of
from autocolor.scene.defaults import sphere_around
from autocolor.testing import numbers
from tests.small import car, cube, fresh, grid, held, opened, sphere

STAGES = pytest.mark.parametrize("stage", ["floor", "bowl"])
COLORS = ((10, 20, 30), (200, 190, 180))


def ball(**fields: Any) -> Scene:
    """A ball of radius 2 around (3, 0, 5)."""
    coordinates = sphere().coordinates * 2 + [3, 0, 5]
    return scene_of(Mesh(coordinates, sphere().node_numbers, sphere().part_numbers, ("ball",)), **fields)


def made_nodes(scene: Scene) -> np.ndarray:
    """The nodes of the stage."""
    mesh = scene.staged.mesh
    return mesh.coordinates_of_parts([len(scene.parts)])


@STAGES
@given(height=numbers(-9, 9), size=numbers(0.1, 9))
def test_the_floor_is_a_hair_below_the_lowest_point(stage: Any, height: float, size: float) -> None:
    mesh = cube(size)
    moved = Mesh(mesh.coordinates + np.array([0, 0, height]), mesh.node_numbers, mesh.part_numbers, ("cube",))
    floor = made_nodes(scene_of(moved, stage=stage))[:, 2].min()
    assert height - 0.01 * size < floor < height


def test_without_a_stage_a_scene_is_rendered_as_it_is() -> None:
    scene = car()
    assert scene.staged is scene
    assert scene.replace(stage="floor").replace(stage="none", surfaces=scene.surfaces).equals(scene)
    shown = display_image(scene, render(scene, (64, 48)))
    assert (shown.words[shown.picture.surface_number == 0] == 0).all()


@given(azimuth=numbers(0, 360), elevation=numbers(0, 90), distance=numbers(0.01, 500), stage=st.just("bowl"))
def test_a_bowl_keeps_the_eye_inside(azimuth: float, elevation: float, distance: float, stage: Any) -> None:
    a, e = math.radians(azimuth), math.radians(elevation)
    eye = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)]) * distance + [3, 0, 5]
    view = View(tuple(eye.tolist()), direction=(-1, 0.5, -0.25))
    nodes, middle = made_nodes(ball(stage=stage, view=view)), np.array([3, 0])
    away = np.linalg.norm(nodes[:, :2] - middle, axis=1)
    is_flat = nodes[:, 2] < nodes[:, 2].min() + 1e-9
    # Inside of the flat part, no point of the wall is above or below the eye.
    assert np.linalg.norm(eye[:2] - middle) < away[is_flat].max()
    assert nodes[:, 2].min() < eye[2] < nodes[:, 2].max()


def test_a_bowl_is_round_and_bends_smoothly_into_a_wall_that_faces_the_object() -> None:
    scene = ball(stage="bowl")
    mesh = scene.staged.mesh
    own = mesh.part_numbers == len(scene.parts)
    nodes, vectors = mesh.node_numbers[own], mesh.normals.numbers[own]
    # A node has one normal in all polygons.
    assert len({*zip(nodes.ravel().tolist(), vectors.ravel().tolist(), strict=True)}) == len(np.unique(nodes))
    places, normals = mesh.coordinates[nodes.ravel()], mesh.normals.vectors[vectors.ravel()]
    inward = ((np.array([3, 0]) - places[:, :2]) * normals[:, :2]).sum(axis=1)
    is_wall = places[:, 2] > places[:, 2].min() + 1e-9
    away = np.linalg.norm(places[:, :2] - [3, 0], axis=1)
    assert (inward[is_wall] > 0).all()
    assert np.ptp(away[places[:, 2] == places[:, 2].max()]) < 1e-9
    # The bend is a circle: its normals are those of the surface, to the angle between two rings.
    along = mesh.coordinates[nodes]
    rises = np.ptp(along[:, :, 2], axis=1) > 1e-9
    facets = np.cross(along[:, 2] - along[:, 0], along[:, 3] - along[:, 1])
    facets[rises] /= np.linalg.norm(facets[rises], axis=1)[:, None]
    cosines = np.einsum("ni,nci->nc", facets[rises], mesh.normals.vectors[vectors[rises]])
    assert cosines.min() > math.cos(math.radians(12))


def test_the_pool_below_the_object_is_dark_and_the_floor_around_it_is_lit() -> None:
    """With a light straight above, light falls as cos(I) of the normals that lean."""
    light = Light("sun", (0.5, 0.5, 500))
    view = View((0.5, 0.5, 9), target=(0.5, 0.5, 0))
    scene = scene_of(cube(), stage="floor", view=view, lights=[light], ambient=0.0)
    picture = render(scene, (257, 193))
    line = picture.intensity[96][picture.surface_number[96] == 2]
    right = line[len(line) // 2 :]
    assert right[0] < 0.25 * right.max()
    assert (np.diff(right[: right.argmax()]) >= 0).all()
    assert right[-1] > 0.7


def test_an_eye_below_the_floor_sees_the_object() -> None:
    view = View((3, -9, -5), target=(3, 0, 5))
    scene = ball(view=view)
    below = scene.replace(stage="floor")
    assert below.staged is below
    assert (render(below, (32, 24)).surface_number == render(scene, (32, 24)).surface_number).all()


@STAGES
def test_an_underside_in_the_plane_of_the_floor_is_not_torn(stage: Any) -> None:
    sheet = scene_of(grid(1, 1, (0, 0, 0), (1, 0, 0), (0, 1, 0)), surfaces=[Surface("sheet")])
    view = View((0.5, -3, 0.6), target=(0.5, 0.5, 0))
    sheet = sheet.replace(view=view)
    bare, staged = (render(each, (160, 120)) for each in (sheet, sheet.replace(stage=stage)))
    assert ((bare.surface_number == 1) == (staged.surface_number == 1)).all()


# Names and tables.


@STAGES
def test_a_stage_leaves_the_names_of_the_object_alone(stage: Any) -> None:
    mesh = Mesh.joined([grid(1, 1, (0, 0, 0), (1, 0, 0), (0, 0, 1), name) for name in ("stage", "stage 2")])
    scene = scene_of(mesh, surfaces="parts").replace(stage=stage)
    assert [row.name for row in scene.surfaces] == ["stage", "stage 2", "stage 3"]
    assert scene.staged.mesh.part_names == ("stage", "stage 2", "stage 3")
    assert scene.stage_surface == "stage 3"
    repainted = scene.with_paint("stage 3", object_color="#ff0000")
    assert render(repainted, (32, 24)).surfaces == ("stage", "stage 2", "stage 3")


def test_a_surface_that_is_given_paints_the_stage_and_no_part() -> None:
    given = Surface("stage").replace(object_color="#123456")
    scene = scene_of(cube(), surfaces=[given], stage="bowl")
    assert [part.surface for part in scene.parts] == ["surface"]
    assert scene.stage_surface == "stage"
    assert scene.surfaces["stage"] == given


@STAGES
def test_a_stage_is_not_the_object(stage: Any) -> None:
    scene = car()
    staged = scene.replace(stage=stage)
    assert staged.object_bounds == scene.object_bounds
    assert staged.parts == scene.parts
    assert staged.mesh is scene.mesh
    assert new_light_of(staged) == new_light_of(scene)


@STAGES
def test_a_stage_comes_through_files(stage: Any, tmp_path: Path) -> None:
    scene = car().replace(stage=stage, backdrop=COLORS).with_paint("stage", object_color="#808890")
    for name in ("scene/scene.toml", "scene.sqlite"):
        autocolor.write_scene(tmp_path / name, scene)
        again = autocolor.read_scene(tmp_path / name)
        assert (to_plain(again) | {"name": ""}) == (to_plain(scene) | {"name": ""})
        assert (render(again, (32, 24)).surface_number == render(scene, (32, 24)).surface_number).all()
    autocolor.write_picture(tmp_path / "scene.npz", scene, render(scene, (32, 24)))
    saved = read_picture(tmp_path / "scene.npz")
    assert saved.picture.ranges == render(scene, (32, 24)).ranges
    assert (image(*saved) == image(scene, size=(32, 24), smooth=1)).all()
    assert from_plain(Scene, {**to_plain(scene), "mesh": scene.mesh}).equals(scene)


# Words.


@given(st.integers(1, 200), st.sampled_from(["covered", "equal"]))
def test_a_stage_and_its_backdrop_take_at_most_160_words(count: int, division: Any) -> None:
    quads = [grid(1, 1, (n, 0, 0), (0.9, 0, 0), (0, 0, 1), f"part {n}") for n in range(count)]
    scene = scene_of(Mesh.joined(quads), surfaces="parts", stage="bowl", division=division)
    ranges = display_image(scene, render(scene, (32, 24))).ranges
    assert 2 <= ranges["stage"].levels <= 160 - BACKDROP.levels == 128
    assert max(each.last for each in ranges.values()) < BACKDROP.first
    # The others have what they need first.
    assert ranges["stage"].levels == 128 or min(each.levels for each in ranges.values()) <= 16


@pytest.mark.parametrize("words", ["levels", "normals"])
def test_the_backdrop_is_by_line_and_without_polygons(words: Any) -> None:
    scene = ball(backdrop=COLORS, words=words)
    shown = display_image(scene, render(scene, (64, 48)))
    is_empty = shown.picture.surface_number == 0
    expected = BACKDROP.first + np.arange(48)[:, None] * 32 // 48
    assert (shown.words[is_empty] == np.broadcast_to(expected, (48, 64))[is_empty]).all()
    assert (shown.words[~is_empty] < BACKDROP.first).all()
    assert shown.entries[[BACKDROP.first, BACKDROP.last]].tolist() == [list(color) for color in COLORS]
    assert (np.diff(shown.entries[BACKDROP.first : BACKDROP.last + 1].astype(int)[:, 0]) >= 0).all()
    assert render(scene, (64, 48)).surfaces == ("surface",)


@STAGES
@pytest.mark.parametrize("words", ["levels", "normals"])
def test_the_colors_of_the_backdrop_are_entries_alone(stage: Any, words: Any) -> None:
    scene = car().without_scalar().replace(words=words)
    studio, display = opened(scene)
    studio.stage(stage)
    written = display.frame_buffer.written
    studio.stage(stage, COLORS)
    studio.stage(stage, ["red", "#0000ff"])
    assert display.entries[BACKDROP.first].tolist() == [255, 0, 0]
    assert held(display) == fresh(studio.scene)
    studio.recolor("stage", object_color="#224466")
    assert display.frame_buffer.written == written
    assert held(display) == fresh(studio.scene)
    for _ in range(4):
        assert studio.undo()
    assert held(display) == fresh(scene)


@STAGES
def test_a_stage_catches_the_lights(stage: Any) -> None:
    studio, _ = opened(car().replace(stage=stage, scalar=None))
    name = studio.scene.lights[0].name
    before = studio.picture.intensity[studio.picture.surface_number == len(studio.picture.surfaces)]
    studio.light(name, on=False)
    after = studio.picture.intensity[studio.picture.surface_number == len(studio.picture.surfaces)]
    assert len(before)
    assert after.sum() < before.sum()
    studio.light(name, on=True, except_surfaces=["stage"])
    assert np.allclose(
        studio.picture.intensity[studio.picture.surface_number == len(studio.picture.surfaces)], after
    )


@STAGES
@pytest.mark.parametrize("exposure", ["auto", "99.5 %"])
def test_a_stage_takes_no_part_in_the_range_of_the_object(stage: Any, exposure: Any) -> None:
    scene = ball(exposure=exposure)
    bare, staged = render(scene, (160, 120)), render(scene.replace(stage=stage), (160, 120))
    assert staged.ranges.whole == pytest.approx(bare.ranges.whole, rel=1e-5)
    colors = [image(each, size=(160, 120), smooth=1) for each in (scene, scene.replace(stage=stage))]
    is_object = bare.surface_number == 1
    # The levels are fewer, but mean the same intensities.
    difference = np.abs(colors[0][is_object].astype(int) - colors[1][is_object])
    assert difference.max() <= 2


def test_a_highlight_is_on_the_object_unless_the_stage_is_named() -> None:
    studio = Studio(ball(stage="bowl"))
    for light in studio.scene.lights:
        place = studio.highlight_of(light.name)
        assert place is None or studio.seen_at(*place).surface == "surface"  # type: ignore[union-attr]
    place = studio.highlight_of("key", "stage")
    assert place is None or studio.seen_at(*place).part == "stage"  # type: ignore[union-attr]


@STAGES
def test_pixels_of_stage_and_backdrop_are_explained(stage: Any) -> None:
    studio, _ = opened(ball(stage=stage, view=View((3, -30, 4), target=(3, 0, 7))))
    shown = studio.display_image
    line, element = np.argwhere(shown.picture.surface_number == 2)[-1].tolist()
    point = studio.explain(line, element).point
    assert point is not None
    assert (point.part_name, point.surface_name) == ("stage", "stage")
    assert studio.explain(line, element).word == studio.words[line, element]
    lines = np.concatenate([words for _, words in studio.watch()])
    assert (lines == studio.words).all()
    if stage == "floor":
        assert studio.explain(0, 0).point is None
        assert studio.explain(0, 0).word == BACKDROP.first


@STAGES
def test_a_scalar_colors_no_stage_and_its_bands_have_the_words_first(stage: Any) -> None:
    scene = ball(stage=stage).with_scalar(name="z", bands=100, shades=8)
    shown = display_image(scene, render(scene, (32, 24)))
    assert shown.bands.keys() == {"surface"}
    assert shown.ranges["surface"].levels == 800
    assert 2 <= shown.ranges["stage"].levels <= SURFACE_WORDS - BACKDROP.levels - 800


@given(turn=numbers(0, 360), stage=st.sampled_from(["floor", "bowl"]))
def test_an_eye_that_turns_around_the_object_moves_no_wall(turn: float, stage: Any) -> None:
    scene = ball(stage=stage)
    x, y = scene.view.eye[0] - 3, scene.view.eye[1]
    cosine, sine = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    eye = (3 + x * cosine - y * sine, x * sine + y * cosine, scene.view.eye[2])
    turned = scene.replace(view=View(eye, target=(3, 0, 5)))
    assert (
        np.abs(made_nodes(turned) - made_nodes(scene)).max()
        < 0.11 * sphere_around(*map(np.array, scene.object_bounds))[1]
    )


def test_a_backdrop_has_two_colors() -> None:
    with pytest.raises(autocolor.InputError, match="backdrop must be a list of 2 colors, not"):
        car().replace(backdrop=["red"])
