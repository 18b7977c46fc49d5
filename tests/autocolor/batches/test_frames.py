from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, Scene, UsageError, Variant, View, frames
from autocolor.batches.frames import frames_of_tracks, in_step
from autocolor.batches.table import Rows, varied
from autocolor.files.settings import scene_with
from tests.small import wall_scene

SCENE = wall_scene(lights=[Light("key", (0, -4, 2), aim=(0, 0, 0))])
RED: dict[str, object] = {"surfaces.wall.object_color": "red"}
BLUE: dict[str, object] = {"surfaces.wall.object_color": "blue"}


def values(made: tuple[Variant, ...], key: str) -> list[object]:
    """The values of a key in frames."""
    return [frame.settings.get(key) for frame in made]


def test_frames_are_evenly_spaced_between_variants() -> None:
    made = frames(SCENE, [{"ambient": 0.0}, {"ambient": 1.0}, {"ambient": 0.5}], 5)
    assert values(made, "ambient") == [0.0, 0.5, 1.0, 0.75, 0.5]
    assert [frame.name for frame in made] == [f"frame-000{number}" for number in range(1, 6)]
    assert [frame.time for frame in made] == [0, 0.5, 1, 1.5, 2]


def test_variants_have_the_times_that_they_are_given() -> None:
    rows = [{"ambient": 0.0, "time": 10}, {"ambient": 1.0, "time": 11}, {"ambient": 0.0, "time": 14}]
    made = frames(SCENE, rows, 5, loop=False)
    assert [frame.time for frame in made] == [10, 11, 12, 13, 14]
    assert values(made, "ambient") == pytest.approx([0, 1, 2 / 3, 1 / 3, 0])


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=6, unique=True), st.integers(1, 9))
def test_a_frame_at_the_time_of_a_variant_has_exactly_its_settings(times: list[float], between: int) -> None:
    times = sorted(times)
    rows = [{"ambient": number * 0.1, "dither": "ordered", "time": t} for number, t in enumerate(times)]
    made = frames(SCENE, rows, 2, loop=False)
    assert [dict(frame.settings) for frame in made] == [
        {"ambient": rows[place]["ambient"], "dither": "ordered"} for place in (0, -1)
    ]
    evenly = [{"ambient": number * 0.1} for number in range(len(times))]
    steps = between * (len(times) - 1)
    made = frames(SCENE, evenly, steps + 1, loop=False)
    assert [dict(frame.settings) for frame in made[::between]] == evenly


def test_a_name_holds_until_the_next_variant() -> None:
    made = frames(SCENE, [{"dither": "off"}, {"dither": "ordered"}], 4)
    assert values(made, "dither") == ["off", "off", "off", "ordered"]


def test_a_field_that_a_variant_leaves_out_has_the_scenes_own_value() -> None:
    made = frames(SCENE.replace(ambient=0.5), [{"ambient": 0.1, **RED}, BLUE], 3)
    assert values(made, "ambient") == [0.1, pytest.approx(0.3), None]
    assert values(made, "surfaces.wall.object_color") == ["red", "#800080", "blue"]


def test_a_loop_leaves_out_the_frame_that_would_repeat_the_first() -> None:
    assert values(frames(SCENE, [RED, BLUE, RED], 4), "surfaces.wall.object_color") == [
        "red",
        "#800080",
        "blue",
        "#800080",
    ]
    # The same color in other words is the same, too.
    assert frames(SCENE, [RED, BLUE, {"surfaces.wall.object_color": "#f00"}], 4)[2].settings == BLUE
    assert frames(SCENE, [RED, BLUE, RED], 3, loop=False)[2].settings == RED
    assert frames(SCENE, [RED, BLUE], 2)[1].settings == BLUE
    assert frames(SCENE, [RED, BLUE], 2, loop=True)[1].settings == {"surfaces.wall.object_color": "#800080"}


def test_an_angle_turns_the_short_way_from_each_variant_to_the_next() -> None:
    for angles, middles in (
        ((350, 20), [365]),
        ((20, 350), [5]),
        ((0, 180, 0), [90, 270]),
        ((-170, 170), [-180]),
    ):
        made = frames(SCENE, [{"view.angle": a} for a in angles], 2 * len(angles) - 1, loop=False)
        assert values(made, "view.angle")[1::2] == middles


def eyes(scene: Scene, made: tuple[Variant, ...]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The eyes of frames, (n, 3)."""
    return np.array([scene_with(scene, frame.settings).view.eye for frame in made])


def test_a_turn_goes_around_the_target_at_the_same_height() -> None:
    scene = SCENE.with_view(eye=(3, 7, 5), target=(1, 7, 1))
    expected = [(3, 7, 5), (1, 9, 5), (-1, 7, 5), (1, 5, 5)]
    assert eyes(scene, frames(scene, [], 4, turn=360)) == pytest.approx(np.array(expected))
    assert eyes(scene, frames(scene, [], 4, turn=-360)) == pytest.approx(np.array(expected)[[0, 3, 2, 1]])
    # A turn that is not whole does not come back to its first frame, so it has both ends.
    assert eyes(scene, frames(scene, [], 3, turn=180)) == pytest.approx(np.array(expected)[:3])
    assert all(set(frame.settings) == {"view.eye"} for frame in frames(scene, [], 4, turn=360))


def test_a_view_with_a_direction_turns_around_the_object_on_its_line_of_sight() -> None:
    scene = SCENE.with_view(eye=(0.5, -4, 1), direction=(-0.2, 2, -0.5))
    point = np.array(scene.view.orbit_target(*scene.object_bounds))
    for frame in frames(scene, [], 5, turn=360):
        view = scene_with(scene, frame.settings).view
        away = point - view.eye
        assert view.target is None
        assert np.linalg.norm(away) == pytest.approx(np.linalg.norm(point - scene.view.eye))
        assert view.axes @ away == pytest.approx((0, 0, np.linalg.norm(away)))


def test_a_turn_and_variants_go_together() -> None:
    made = frames(SCENE, [{"view.eye": [4, 0, 0]}, {"view.eye": [2, 0, 0]}], 3, turn=180)
    assert eyes(SCENE, made) == pytest.approx(np.array([(4, 0, 0), (0, 3, 0), (-2, 0, 0)]))


def test_the_eye_of_a_table_turns_around_the_target() -> None:
    scene = SCENE.with_view(target=(1, 2, 0))
    made = frames(scene, [{"view.eye": [5, 2, 0]}, {"view.eye": [1, 6, 0]}], 3)
    assert eyes(scene, made)[1] == pytest.approx((1 + math.sqrt(8), 2 + math.sqrt(8), 0))


def test_between_a_target_and_a_direction_there_are_directions() -> None:
    directed = SCENE.replace(view=View((0, -4, 0), direction=(1, 0, 0)))
    for scene, variants in (
        (SCENE, [{"view.target": [0, 0, 0]}, {"view.direction": [1, 0, 0]}]),
        (directed, [{"view.target": [0, 0, 0]}, {}]),
    ):
        view = scene_with(scene, frames(scene, variants, 3)[1].settings).view
        assert view.direction == pytest.approx((math.sqrt(0.5), math.sqrt(0.5), 0))


def test_a_reflection_model_keeps_its_parameters_until_the_next_variant() -> None:
    scene = SCENE.with_surface("wall", exponent=30)
    rows = [{"surfaces.wall.model": "cook-torrance", "surfaces.wall.roughness": 0.3}, {}]
    middle = scene_with(scene, frames(scene, rows, 3)[1].settings)
    assert middle.equals(scene_with(scene, rows[0]))
    middle = scene_with(scene, frames(scene, rows[::-1], 3)[1].settings)
    assert middle.equals(scene)


def test_a_ramp_and_two_colors_hold_until_the_next_variant() -> None:
    ramp: dict[str, object] = {"surfaces.wall.ramp": ["black", "red", "white"]}
    for scene in (SCENE, SCENE.with_paint("wall", blend=0.2), SCENE.with_paint("wall", ramp=["red", "blue"])):
        for first, last in ((RED, ramp), (ramp, RED), ({}, ramp), (ramp, {})):
            middle = scene_with(scene, frames(scene, [first, last], 3)[1].settings)
            assert middle.equals(scene_with(scene, first))


def test_tables_run_together_each_over_the_whole_duration() -> None:
    tracks = [varied("ambient=0,1,0,1"), varied("lights.key.intensity=0,1")]
    made = frames_of_tracks(SCENE, tracks, 7)
    assert [scene_with(SCENE, frame.settings).ambient for frame in made] == pytest.approx(
        [0, 0.5, 1, 0.5, 0, 0.5, 1]
    )
    assert [scene_with(SCENE, frame.settings).lights["key"].intensity for frame in made] == pytest.approx(
        [0, 1 / 6, 1 / 3, 1 / 2, 2 / 3, 5 / 6, 1]
    )


def test_lists_of_the_same_length_become_one_table() -> None:
    eye, target, ambient = (varied(text) for text in ("view.eye=a,b", "view.target=c,d", "ambient=1,2,3"))
    assert [[dict(row.settings) for row in table] for table in in_step([eye, target, ambient])] == [
        [{"view.eye": "a", "view.target": "c"}, {"view.eye": "b", "view.target": "d"}],
        [{"ambient": "1"}, {"ambient": "2"}, {"ambient": "3"}],
    ]


ABOVE = SCENE.with_view(eye=(0, 0, 4))
REFUSED: list[tuple[Scene, Rows, Any, dict[str, Any], type[Exception], str]] = [
    (SCENE, [RED], 3, {}, UsageError, "an animation must have at least two variants, or a turn"),
    (SCENE, [], 3, {}, UsageError, "an animation must have at least two variants, or a turn"),
    (SCENE, [RED, BLUE], 0, {}, UsageError, "frames must be a whole number from 1 to 100,000, not 0"),
    (SCENE, [RED, BLUE], True, {}, UsageError, "frames must be a whole number from 1 to 100,000, not true"),
    (SCENE, [RED, BLUE], 2.0, {}, UsageError, "frames must be a whole number from 1 to 100,000, not 2.0"),
    (SCENE, [], 3, {"turn": math.nan}, UsageError, "a number of degrees up to 360,000, not nan"),
    (SCENE, [], 3, {"turn": "90"}, UsageError, "a number of degrees up to 360,000, not '90'"),
    (ABOVE, [], 3, {"turn": 90}, UsageError, "must be from the side, not from (0.0, 0.0, 4.0), vertically"),
    (SCENE, [{**RED, "time": 1}, BLUE], 3, {}, UsageError, "must have times, or none, not all but 'blue'"),
    (
        SCENE, [{**RED, "time": 1}, {**BLUE, "time": 1}], 3, {}, UsageError,
        "the time of 'blue' must be later than the time of 'red', 1, not 1; sort the variants by time",
    ),
    (SCENE, [RED, {"ambient": -1, "name": "dim"}], 3, {}, InputError, "variant dim: ambient must be a"),
    (SCENE, [RED, {"ambiend": 1, "name": "dim"}], 3, {}, UsageError, "variant dim: ambiend: there is"),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "variants", "count", "options", "error", "sentence"), REFUSED)
def test_what_makes_no_frames_is_refused_in_words(
    scene: Scene, variants: Rows, count: Any, options: dict[str, Any], error: type[Exception], sentence: str
) -> None:
    with pytest.raises(error) as refusal:
        frames(scene, variants, count, **options)
    assert sentence in str(refusal.value)


def test_numbers_of_numpy_are_numbers() -> None:
    assert frames(SCENE, [], np.int64(3), turn=np.int64(360)) == frames(SCENE, [], 3, turn=360)  # type: ignore[arg-type]


def test_a_key_in_two_tables_is_refused() -> None:
    for lists in (["ambient=0,1", "ambient=1,2"], ["ambient=0,1", "ambient=1,2,3"]):
        with pytest.raises(UsageError, match="a key must be in one table or list, not 'ambient' in two"):
            frames_of_tracks(SCENE, in_step([varied(text) for text in lists]), 5)
