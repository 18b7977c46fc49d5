from __future__ import annotations

import itertools

from hypothesis import given
from hypothesis import strategies as st

from autocolor import Variant, grid
from autocolor.batches.order import cut, runs_of, tier_of
from autocolor.batches.table import variants_of
from autocolor.files.settings import scene_with
from autocolor.scene.columns import Tier
from autocolor.scene.scene import cost_of_edit
from tests.small import wall_scene

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
    for eye, runs in of_frame.items():
        assert len(set(runs)) == -(-eyes.count(eye) // most)


@given(st.integers(0, 60), st.integers(1, 20))
def test_a_list_is_cut_into_the_fewest_parts_of_nearly_one_length(count: int, most: int) -> None:
    parts = cut(range(count), most)
    assert [number for part in parts for number in part] == list(range(count))
    assert len(parts) == max(1, -(-count // most))
    assert max(map(len, parts)) - min(map(len, parts)) <= 1
    assert all(len(part) <= most for part in parts)


def test_recolorings_stay_in_the_order_of_their_table() -> None:
    variants = variants_of([{"surfaces.wall.blend": blend} for blend in (0.5, 0.1, 0.9, 0.1)])
    assert runs_of(wall_scene(), variants, 3) == [[0, 1], [2, 3]]


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
