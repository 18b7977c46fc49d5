from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, Picture, Scene, Surface, render, scene_of
from autocolor.rendering import BLOCKS, PICTURE_SECONDS, Rendering, block_for, blocks_of, rendering
from autocolor.testing import scenes
from tests.small import cube, grid, sphere, wall_scene
from tests.tables import refused

ROOT = Path(__file__).resolve().parents[2]


def two_surfaces() -> Scene:
    mesh = Mesh.joined([sphere(12, 8), cube(1.2)])
    return scene_of(mesh, surfaces=[Surface("sphere"), Surface("cube"), Surface("spare")])


def raw(picture: Picture) -> list[bytes]:
    """Everything that a picture shows."""
    rasters = picture.intensity, picture.surface_number, picture.part_number, picture.scalar
    return [np.array(each).tobytes() for each in (*rasters, picture.scalar_limits)]


def edited(scene: Scene, edit: Any) -> tuple[Rendering, Rendering]:
    before = rendering(scene, 24, 32)
    return before, rendering(edit(scene), 24, 32, before)


RECOLORINGS = [
    lambda scene: scene.with_surface("cube", object_color="#102030", light_color="#ffffff", blend=0.1),
    lambda scene: scene.replace(mapping="gamma"),
    lambda scene: scene.replace(scaling="object"),
    lambda scene: scene.replace(contrast="floor"),
    lambda scene: scene.replace(background="#ffffff"),
    lambda scene: scene.with_surface("cube", levels=50),
    lambda scene: scene.replace(name="other"),
]
MIXES = [
    lambda scene: scene.replace(ambient=0.5),
    lambda scene: scene.with_light("key", intensity=3),
    lambda scene: scene.with_light("key", on=False),
    lambda scene: scene.with_surface("cube", diffuse=0.1, specular=2),
    lambda scene: scene.replace(lights=scene.lights[::-1]),
    lambda scene: scene.replace(lights=scene.lights[:2]),
    lambda scene: scene.with_light("key", only_surfaces=["cube"]),
    lambda scene: scene.with_light("key", except_surfaces=["cube"]),
]
KEY_LIGHT = [
    lambda scene: scene.with_light("key", position=(4, -3, 2)),
    lambda scene: scene.with_light("key", aim=(0.1, 0, 0)),
    lambda scene: scene.with_light("key", concentration=30),
    lambda scene: scene.with_light("key", cone_angle=10),
    lambda scene: scene.with_light("key", flaps={"x": {"minimum": 0.3}}),
    lambda scene: scene.with_light("key", name="lamp"),
    lambda scene: scene.with_light("key", only_parts=["cube"]),
    lambda scene: scene.with_light("key", except_parts=["cube"], only_surfaces=["sphere"]),
]
SCALARS = [
    lambda scene: scene.replace(scalar={"name": "x"}),
    lambda scene: scene.replace(scalar={"direction": (1, 0, 0)}),
    lambda scene: scene.replace(scalar={"stripes": 5}),
]
SCALAR_COLORS = [
    lambda scene: scene.replace(scalar={"limits": (0, 1)}),
    lambda scene: scene.replace(scalar={"scale": "grays", "bands": 7, "shades": 3}),
    lambda scene: scene.replace(scalar={"below": "#000000", "missing": "#ffffff", "surfaces": ["cube"]}),
]
EVERYTHING = [
    lambda scene: scene.with_view(angle=10),
    lambda scene: scene.with_part("cube", surface="sphere"),
    lambda scene: scene.with_surface("sphere", two_sided=False),
    lambda scene: scene.replace(mesh=Mesh.joined([sphere(12, 8), cube(1.3)])),
]


EXPONENT = [lambda scene: scene.with_surface("cube", exponent=3)]
EDITS = {
    "colors": RECOLORINGS,
    "scalar colors": SCALAR_COLORS,
    "scalar": SCALARS,
    "mix": MIXES,
    "key light": KEY_LIGHT,
    "exponent": EXPONENT,
    "everything": EVERYTHING,
}
edits_by_kind = pytest.mark.parametrize(
    ("kind", "edit"), [(kind, edit) for kind, edits in EDITS.items() for edit in edits]
)


def in_color(scene: Scene) -> Scene:
    """The scene with a scalar."""
    return scene.replace(scalar={"name": "z"})


def test_a_scalar_has_a_raster_and_a_range() -> None:
    scene = in_color(two_surfaces())
    picture = render(scene, (32, 24))
    assert picture.scalar is not None
    assert picture.scalar.dtype == np.float32
    assert np.array_equal(np.isnan(picture.scalar), picture.surface_number == 0)
    assert picture.scalar_limits == pytest.approx((-1, 1.2))
    assert not picture.scalar.flags.writeable
    without = render(two_surfaces(), (32, 24))
    assert (without.scalar, without.scalar_values, without.scalar_limits) == (None, None, None)
    assert picture.intensity.tobytes() == without.intensity.tobytes()


@edits_by_kind
def test_an_edit_computes_what_it_changes_and_no_more(kind: str, edit: Any) -> None:
    before, after = edited(in_color(two_surfaces()), edit)
    old, new = before.picture, after.picture
    assert (new is old) == (kind in ("colors", "scalar colors"))
    assert (after.points is before.points) == (kind != "everything")
    assert (new.relative is old.relative) == (kind in ("colors", "scalar colors", "scalar"))
    assert (new.scalar_values is old.scalar_values) == (kind not in ("scalar", "everything"))
    for name, planes in new.light_planes.items():
        is_own = name in ("key", "lamp") if kind == "key light" else kind in ("exponent", "everything")
        is_reused = name in old.light_planes and planes.values is old.light_planes[name].values
        assert is_reused is not is_own


@pytest.mark.parametrize("at_once", [1 << 16, 37])
@edits_by_kind
def test_reuse_gives_the_same_picture_as_a_fresh_rendering(
    kind: str, edit: Any, at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.visibility.visible_points.PIXELS_AT_ONCE", at_once)
    scene = in_color(two_surfaces())
    _, after = edited(scene, edit)
    assert (len(after.points.chunks) > 3) == (at_once == 37)
    assert raw(after.picture) == raw(render(edit(scene), (32, 24)))


def test_a_scalar_that_comes_and_goes_leaves_the_light() -> None:
    before, colored = edited(two_surfaces(), in_color)
    assert colored.picture.relative is before.picture.relative
    gone = rendering(colored.scene.replace(scalar=None), 24, 32, colored)
    assert gone.picture.scalar is None
    assert gone.picture.relative is before.picture.relative


def test_a_coarse_picture_has_its_own_scalar() -> None:
    scene = in_color(two_surfaces())
    coarse = rendering(scene, 12, 16, rendering(scene, 24, 32)).picture
    assert coarse.scalar is not None
    assert coarse.scalar.tobytes() == rendering(scene, 12, 16).picture.scalar.tobytes()  # type: ignore[union-attr]


def test_the_mix_of_lights_that_stay_is_reused_while_a_light_is_dragged() -> None:
    first = rendering(two_surfaces(), 24, 32)
    dragged = [first]
    for step in (1, 2, 3):
        scene = first.scene.with_light("key", position=(4, -3, step))
        dragged.append(rendering(scene, 24, 32, dragged[-1]))
        assert dragged[-1].picture.intensity.tobytes() == render(scene, (32, 24)).intensity.tobytes()
    for light in first.scene.lights:
        mixed = [each.picture.light_planes[light.name].mixed for each in dragged]
        assert mixed[0] is None
        assert (mixed[1] is None) == (light.name == "key")
        assert mixed[1] is mixed[2] is mixed[3]


def test_a_light_off_and_on_again_is_neither_computed_nor_mixed_again() -> None:
    start = two_surfaces()
    first = rendering(start, 24, 32)
    moved = rendering(start.with_light("rim", position=(4, -3, 2)), 24, 32, first)
    dark = rendering(moved.scene.with_light("key", on=False), 24, 32, moved)
    lit = rendering(moved.scene, 24, 32, dark)
    kept = moved.picture.light_planes["key"]
    assert kept.mixed is not None
    assert dark.picture.light_planes["key"] is lit.picture.light_planes["key"] is kept
    assert list(lit.picture.light_planes) == [light.name for light in start.lights]


def test_an_exponent_computes_its_own_surface_again_and_no_other() -> None:
    before, after = edited(two_surfaces(), lambda scene: scene.with_surface("cube", exponent=3))
    assert after.points is before.points
    of_cube = np.zeros(len(after.points.pixels), np.bool_)
    for surface in after.points.slices:
        of_cube[surface.start : surface.stop] = surface.surface_number == 2
    changed = np.zeros_like(of_cube)
    for name, planes in after.picture.light_planes.items():
        changed |= (planes.values != before.picture.light_planes[name].values).any(axis=0)
    assert changed.any()
    assert not (changed & ~of_cube).any()


@given(scenes(), scenes())
def test_any_scene_after_any_other_gives_the_same_picture_as_a_fresh_one(one: Scene, other: Scene) -> None:
    mixed = other.replace(mesh=one.mesh, view=one.view)
    after = rendering(mixed, 9, 12, rendering(one, 9, 12))
    assert raw(after.picture) == raw(render(mixed, (12, 9)))


def test_a_light_that_was_off_is_computed_when_it_is_switched_on() -> None:
    dark = two_surfaces().with_light("key", on=False)
    before = rendering(dark, 24, 32)
    assert "key" not in before.picture.light_planes
    lit = rendering(dark.with_light("key", on=True), 24, 32, before)
    assert lit.picture.intensity.tobytes() == render(two_surfaces(), (32, 24)).intensity.tobytes()


@given(scenes(), st.tuples(st.integers(1, 12), st.integers(1, 12)))
def test_the_literal_watkins_gives_the_same_picture(scene: Scene, size: tuple[int, int]) -> None:
    batch, literal = (render(scene, size, algorithm=each) for each in ("batch", "watkins"))
    assert raw(batch) == raw(literal)


@pytest.mark.parametrize("size", [(1, 16384), (16384, 1), (1, 1)])
def test_a_raster_may_have_16384_lines_or_elements(size: tuple[int, int]) -> None:
    assert render(two_surfaces(), size).intensity.shape == size[::-1]


test_what_is_refused = refused(
    lambda options: render(wall_scene(), **options),
    [
        *(
            (
                {"size": size},
                f"a size must be (width, height), each from 1 to 16384, not {size!r}; write it as in"
                " (640, 480)",
            )
            for size in (480, "640x480", None, (640,), (9, 0), (2.5, 9), (16385, 9), (9, 16385))
        ),
        ({"smooth": 0}, "smooth must be a whole number from 1 to 64, not 0; give one such as 4"),
        (
            {"size": (4, 4097), "smooth": 4},
            "a size must be (width, height), each from 1 to 4096 where smooth is 4, not (4, 4097); write it"
            " as in (640, 480)",
        ),
        ({"algorithm": "watkin"}, "there is no algorithm 'watkin'; did you mean 'watkins'?"),
    ],
)


@pytest.mark.parametrize("scalar", [{"name": "x"}, {"name": "distance", "direction": (2, 0, 0)}])
def test_the_range_of_a_coordinate_leaves_out_the_stage_and_follows_it(scalar: dict[str, Any]) -> None:
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    parts = {"floor": {"stage": True}}
    scene = scene_of(Mesh.joined([cube(), floor]), parts=parts, scalar=scalar)  # type: ignore[arg-type]
    staged = rendering(scene, 12, 16)
    assert staged.picture.scalar_limits == (0, 1)
    whole = rendering(scene.with_part("floor", stage=False), 12, 16, staged)
    assert whole.picture.scalar_limits == (-50, 50)
    np.testing.assert_array_equal(whole.picture.scalar, staged.picture.scalar)
    assert rendering(scene, 12, 16, whole).picture.scalar_limits == (0, 1)


SECONDS = st.floats(0, 10)


@given(st.integers(1, 5000), st.integers(1, 5000))
def test_blocks_divide_the_raster(lines: int, elements: int) -> None:
    blocks = blocks_of(lines, elements)
    assert blocks[0] == 1
    assert all(lines % block == 0 and elements % block == 0 for block in blocks)


@given(st.sampled_from(BLOCKS), SECONDS)
def test_a_block_is_expected_to_be_fast_enough_or_is_the_largest(block: int, seconds: float) -> None:
    chosen = block_for(BLOCKS, block, seconds)
    assert seconds * block / chosen <= PICTURE_SECONDS or chosen == BLOCKS[-1]


@given(st.sampled_from(BLOCKS), SECONDS)
def test_a_block_that_is_fast_enough_gets_no_larger(block: int, seconds: float) -> None:
    if seconds <= PICTURE_SECONDS:
        assert block_for(BLOCKS, block, seconds) <= block


def test_the_block_rests_where_the_time_falls_with_the_lines() -> None:
    for whole in (0.001, 0.02, 0.03, 0.04, 0.06, 0.1, 0.13, 0.2, 1.0):
        block = block_for(BLOCKS, 1, whole)
        for _ in range(5):
            after = block_for(BLOCKS, block, whole / block)
            assert after == block
