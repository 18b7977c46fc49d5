from __future__ import annotations

import itertools
import pickle
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Picture, Scene, Variant, View, grid, image, render, scene_of
from autocolor.batches import runs
from autocolor.batches.outputs import FORMS, marked
from autocolor.batches.runs import Drawing, Start, VariantTask, make, make_run, runs_of, tier_of
from autocolor.batches.sheet import Box
from autocolor.batches.table import variants_of
from autocolor.files.settings import scene_with
from autocolor.rendering import Rendering, rendering
from autocolor.scene.columns import Tier
from autocolor.scene.scene import cost_of_edit
from tests.small import cube, wall_scene

SETTINGS = st.fixed_dictionaries(
    {},
    optional={
        "surfaces.wall.object_color": st.sampled_from(["red", "navy", [1, 2, 3]]),
        "background": st.sampled_from(["white", "black"]),
        "mapping": st.sampled_from(["linear", "gamma"]),
        "words": st.sampled_from(["levels", "normals"]),
        "ambient": st.sampled_from([0.0, 0.5]),
        "lights.key.position": st.sampled_from([[0, -3, 1], [1, -3, 0]]),
        "view.angle": st.sampled_from([0, 20]),
    },
)
SMALL = Drawing(12, 16, 1, "array", None, None, 1.0)


def alone(scene: Scene, drawing: Drawing = SMALL) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """The colors of a scene that is rendered by itself."""
    return image(scene, size=(drawing.elements, drawing.lines), smooth=drawing.smooth)


@given(st.lists(SETTINGS, min_size=1, max_size=5), st.sampled_from([1, 2]), st.booleans())
def test_each_picture_of_a_run_is_that_of_its_scene_rendered_alone(
    variants: list[dict[str, object]], smooth: int, has_picture: bool
) -> None:
    drawing = SMALL._replace(smooth=smooth)
    scene = wall_scene()
    picture = render(scene, (16, 12), smooth=smooth) if has_picture else None
    tasks = [VariantTask(number, settings, "") for number, settings in enumerate(variants)]
    results = make_run(Start(scene, picture), drawing, tasks)
    assert [made.number for made in results] == list(range(len(variants)))
    scenes = [scene_with(scene, settings) for settings in variants]
    for made, edited in zip(results, scenes, strict=True):
        assert made.problem == ""
        assert np.array_equal(made.image, alone(edited, drawing))  # type: ignore[arg-type]
    if not has_picture:
        tiers = [made.tier for made in results]
        assert tiers == [Tier.FRAME, *(cost_of_edit(one, other) for one, other in pairwise(scenes))]


class Counted:
    """Counts the renderings, and the renderings that found visible surfaces."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.renderings = self.frames = 0
        monkeypatch.setattr(runs, "rendering", self)

    def __call__(self, scene: Scene, lines: int, elements: int, before: Rendering | None) -> Rendering:
        rendered = rendering(scene, lines, elements, before)
        self.renderings += 1
        self.frames += before is None or rendered.points is not before.points
        return rendered


def test_light_moves_see_the_points_once_and_recolorings_of_a_picture_render_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    counted = Counted(monkeypatch)
    scene = wall_scene()
    moves = [VariantTask(n, {"lights.key.position": [n, -3, 1]}, "") for n in range(5)]
    make_run(Start(scene, None), SMALL, moves)
    assert (counted.renderings, counted.frames) == (5, 1)
    paints = [
        VariantTask(n, {"surfaces.wall.object_color": [n, n, n], "mapping": "gamma"}, "") for n in range(5)
    ]
    make_run(Start(scene, render(scene, (16, 12))), SMALL, paints)
    assert (counted.renderings, counted.frames) == (5, 1)


def test_a_picture_is_rendered_again_only_where_a_variant_changes_the_light(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    counted = Counted(monkeypatch)
    scene = wall_scene()
    start = Start(scene, render(scene, (16, 12)))
    settings: list[dict[str, object]] = [{}, {"ambient": 0.5}, {"ambient": 0.6}, {"background": "red"}]
    made = [make(start, SMALL, VariantTask(n, each, "")) for n, each in enumerate(settings)]
    assert (counted.renderings, counted.frames) == (2, 1)
    assert [each.tier for each in made] == [None, Tier.FRAME, Tier.MIX, Tier.MIX]


def test_words_that_stand_for_normals_need_a_rendering_of_a_picture() -> None:
    scene = scene_of(cube(), view=View((3.0, -4.0, 2.0), target=(0.5, 0.5, 0.5)))
    settings = {"words": "normals", "lights.key.position": [2, -3, 4]}
    picture = render(scene_with(scene, {**settings, "words": "levels"}), (16, 12))
    start = Start(scene_with(scene, {**settings, "words": "levels"}), picture)
    made = make(start, SMALL, VariantTask(0, {"words": "normals"}, ""))
    assert np.array_equal(made.image, alone(scene_with(scene, settings)))  # type: ignore[arg-type]
    assert made.tier is Tier.FRAME


def test_a_wrong_variant_has_its_problem_and_loses_no_other() -> None:
    tasks = [
        VariantTask(0, {"ambient": -1}, ""),
        VariantTask(1, {"lights.kye.on": False}, ""),
        VariantTask(2, {"background": "red"}, ""),
        VariantTask(3, {"lights.key.intensity": 1e38, "surfaces.wall.diffuse": 1e38}, ""),
        VariantTask(4, {"ambient": None}, ""),
    ]
    made = make_run(Start(wall_scene(), None), SMALL, tasks)
    assert [each.image is None for each in made] == [True, True, False, True, True]
    assert [each.problem.partition(",")[0] for each in made] == [
        "ambient must be a finite number of at least 0",
        "lights.kye.on: there is no light 'kye'; did you mean 'key'?",
        "",
        made[3].problem.partition(",")[0],
        "ambient: it must be a finite number of at least 0",
    ]
    assert "intensity" in made[3].problem


def test_a_variant_that_exceeds_the_memory_budget_has_a_problem() -> None:
    made = make(Start(wall_scene(), None), SMALL._replace(limit=1e-9), VariantTask(0, {}, ""))
    assert made.image is None
    assert made.problem.startswith("a picture of 16 x 12 pixels must take at most")


def test_the_forms_and_thumbnails_are_those_of_the_colors() -> None:
    scene = wall_scene()
    for form in FORMS:
        drawing = SMALL._replace(form=form, level=9, thumbnail=Box(8, 6))
        made = make(Start(scene, None), drawing, VariantTask(0, {}, "0" * 64))
        assert made.image == marked(form, alone(scene), 9, "0" * 64)
        assert made.thumbnail is not None
        assert made.thumbnail.shape == (6, 8, 3)


def test_a_start_travels_once_to_a_process_without_light_planes() -> None:
    scene = wall_scene()
    start = Start(scene, render(scene, (16, 12)))
    arrived = pickle.loads(pickle.dumps(start))
    assert arrived is not start
    assert pickle.loads(pickle.dumps(start)) is arrived
    assert isinstance(arrived.picture, Picture)
    assert not arrived.picture.light_planes
    task = VariantTask(0, {"background": "red"}, "")
    as_png = SMALL._replace(form="png")
    assert make(arrived, as_png, task).image == make(start, as_png, task).image
    other = pickle.loads(pickle.dumps(Start(scene, None)))
    assert other is not arrived


AXES: dict[str, list[object]] = {
    "surfaces.wall.object_color": ["red", "navy", "gold"],
    "lights.key.intensity": [0.5, 1.5],
    "view.eye": [[0, -4, 0], [1, -4, 0]],
    "mapping": ["linear", "gamma"],
    "lights.fill.position": [[3, -3, 3], [3, -3, 4]],
}


@given(st.permutations(list(grid(AXES))), st.integers(1, 50))
def test_each_variant_is_in_a_run_and_dear_edits_are_as_rare_as_they_can_be(
    variants: list[Variant], most: int
) -> None:
    scene = wall_scene()
    runs = runs_of(scene, variants, most)
    order = [number for run in runs for number in run]
    assert sorted(order) == list(range(len(variants)))
    assert all(1 <= len(run) <= most for run in runs)
    scenes = [scene_with(scene, variants[number].settings) for number in order]
    tiers = [cost_of_edit(one, other) for one, other in itertools.pairwise(scenes)]
    # A grid of 2 views, 2 places of a light, 2 intensities, 2 mappings and 3 colors, the dearest outermost.
    assert [tiers.count(tier) for tier in (Tier.FRAME, Tier.LIGHT, Tier.MIX, Tier.LEVELS)] == [1, 2, 4, 8]
    assert tiers.count(Tier.ENTRIES) == 32


@given(st.lists(st.integers(0, 5), max_size=40), st.integers(1, 12))
def test_a_run_mixes_frames_only_if_all_of_each_fit(eyes: list[int], most: int) -> None:
    variants = variants_of([{"view.eye": [eye, -4, 0], "ambient": n} for n, eye in enumerate(eyes)])
    of_frame: dict[int, list[int]] = {}
    for number, run in enumerate(runs_of(wall_scene(), variants, most)):
        for variant in run:
            of_frame.setdefault(eyes[variant], []).append(number)
    for eye, numbers in of_frame.items():
        assert len(set(numbers)) == -(-eyes.count(eye) // most)


def test_recolorings_stay_in_the_order_of_their_table() -> None:
    variants = variants_of([{"surfaces.wall.blend": blend} for blend in (0.5, 0.1, 0.9, 0.1)])
    assert runs_of(wall_scene(), variants, 3) == [[0, 1, 2], [3]]


def test_the_tier_of_a_key_is_that_of_its_column() -> None:
    scene = wall_scene()
    tiers = {
        "surfaces.wall.blend": Tier.ENTRIES,
        "dither": Tier.LEVELS,
        "surfaces.wall.diffuse": Tier.MIX,
        "lights.key.position": Tier.LIGHT,
        "lights.key.flaps.x.minimum": Tier.LIGHT,
        "view.eye": Tier.FRAME,
        "surfaces.wal.blend": Tier.NOTHING,
        "surfaces.wall.blnd": Tier.NOTHING,
    }
    assert {key: tier_of(scene, key) for key in tiers} == tiers
