from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor import (
    InputError,
    Light,
    OutputError,
    Scene,
    UsageError,
    Variant,
    animate,
    batch,
    frames,
    image,
    render,
)
from autocolor.arrays import Bytes
from autocolor.files.settings import scene_with
from autocolor.images import send_picture
from autocolor.rendering import ALGORITHMS
from autocolor.scene.columns import Tier
from ramtek_emu import Ramtek9300
from ramtek_emu.instruction_set.decoder import Decoder
from tests.ramtek_emu.film_reader import decoded
from tests.small import cube, wall_scene

SIZE = (40, 30)
SCENE = wall_scene(cube(), lights=[Light("key", (0.5, -4, 3), aim=(0.5, 0.5, 0.5))]).with_view(
    eye=(2.5, -3, 2), target=(0.5, 0.5, 0.5)
)
COLOR, POSITION = f"surfaces.{SCENE.parts[0].surface}.object_color", "lights.key.position"
FADE = frames(SCENE, [{COLOR: "red"}, {COLOR: "blue"}, {COLOR: "red"}], 6)
SWEEP = frames(SCENE, [{POSITION: [-4, -4, 3]}, {POSITION: [4, -4, 3]}], 5)
AROUND = frames(SCENE, [], 4, turn=360)
SMOOTH = render(SCENE, SIZE, smooth=2)


def rendered(scene: Scene, made: tuple[Variant, ...]) -> list[Bytes]:
    """The colors of frames, each rendered by itself."""
    scenes = [scene_with(scene, frame.settings) for frame in made]
    return [image(each, size=SIZE) for each in scenes]


@pytest.fixture
def visible(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """A list that gets the view of each computation of visible surfaces."""
    views: list[object] = []
    compute = ALGORITHMS["batch"]

    def counted(mesh: Any, view: Any, *arguments: Any) -> Any:
        views.append(view)
        return compute(mesh, view, *arguments)

    monkeypatch.setitem(ALGORITHMS, "batch", counted)
    return views


@pytest.mark.parametrize("made", [FADE, SWEEP, AROUND], ids=["fade", "sweep", "around"])
def test_a_film_is_decoded_to_exactly_its_frames(made: tuple[Variant, ...], tmp_path: Path) -> None:
    film = animate(SCENE, made, tmp_path / "film.webp", size=SIZE)
    assert film == (str(tmp_path / "film.webp"), len(made))
    assert np.array_equal(decoded(tmp_path / "film.webp"), rendered(SCENE, made))


def test_frames_are_made_between_variants(tmp_path: Path) -> None:
    colors = [{COLOR: "red"}, {COLOR: "blue"}, {COLOR: "red"}]
    # A film that does not begin again shows the last variant, too.
    for count, loop in ((6, True), (5, False)):
        path = tmp_path / f"{count}.webp"
        assert animate((SCENE, SMOOTH), colors, path, frames=count, loop=loop).frames == count
        assert np.array_equal(decoded(path), rendered(SCENE, frames(SCENE, colors, count, loop=loop)))


def test_frames_keep_their_order_where_another_would_cost_less(tmp_path: Path) -> None:
    back_and_forth = tuple(SWEEP[number] for number in (0, 4, 0, 4))
    animate(SCENE, [frame.settings for frame in back_and_forth], tmp_path / "film.webp", size=SIZE)
    assert np.array_equal(decoded(tmp_path / "film.webp"), rendered(SCENE, back_and_forth))


@pytest.mark.parametrize(
    ("made", "renderings", "tier"),
    [(FADE, 1, Tier.ENTRIES), (SWEEP, 1, Tier.LIGHT), (AROUND, 4, Tier.FRAME)],
    ids=["fade", "sweep", "around"],
)
def test_a_frame_costs_its_edit_from_the_frame_before(
    made: tuple[Variant, ...], renderings: int, tier: Tier, visible: list[object], tmp_path: Path
) -> None:
    tiers: list[Tier | None] = []
    animate(SCENE, made, tmp_path / "film.webp", size=SIZE, progress=lambda result: tiers.append(result.tier))
    assert len(visible) == renderings
    assert tiers == [Tier.FRAME] + [tier] * (len(made) - 1)


def test_a_picture_alone_is_animated_without_rendering(visible: list[object], tmp_path: Path) -> None:
    picture = render(SCENE, (2 * SIZE[0], 2 * SIZE[1]), smooth=1)
    visible.clear()
    animate((SCENE, picture), FADE, tmp_path / "film.webp")
    assert visible == []
    assert np.array_equal(
        decoded(tmp_path / "film.webp")[0], image(scene_with(SCENE, FADE[0].settings), picture)
    )


def test_numbered_pictures_are_those_of_a_batch(tmp_path: Path) -> None:
    assert animate(SCENE, SWEEP, tmp_path / "{number:04}.png", size=SIZE).frames == 5
    assert sorted(os.listdir(tmp_path)) == [f"000{number}.png" for number in range(1, 6)]
    batch(SCENE, SWEEP, tmp_path / "batch" / "{number:04}.png", size=SIZE, ordered=True)
    for path in tmp_path.glob("*.png"):
        assert path.read_bytes() == (tmp_path / "batch" / path.name).read_bytes()


def test_any_executor_gives_the_same_film(tmp_path: Path) -> None:
    animate(SCENE, SWEEP, tmp_path / "one.webp", size=SIZE)
    with ThreadPoolExecutor(2) as executor:
        animate(SCENE, SWEEP, tmp_path / "two.webp", size=SIZE, executor=executor)
    assert (tmp_path / "one.webp").read_bytes() == (tmp_path / "two.webp").read_bytes()


def played(path: Path) -> Iterator[Bytes]:
    """The fields of a display after each load of its table by a stream."""
    display = Ramtek9300()
    for words in Decoder().split(np.fromfile(path, "<u2").astype(np.uint16)):
        display.send(words)
        if words[0] == 0x0300:
            yield display.field()


def full_size(scene: Scene, made: tuple[Variant, ...]) -> Iterator[Bytes]:
    """What a display shows of frames, each rendered by itself."""
    for frame in made:
        each, display = scene_with(scene, frame.settings), Ramtek9300()
        send_picture(each, render(each), display)
        yield display.field()


CYCLES: dict[str, tuple[Scene, list[dict[str, object]]]] = {
    "paint": (SCENE, [{COLOR: "red"}, {COLOR: "blue"}]),
    # The second frame changes nothing, and has a load of its own.
    "pause": (SCENE, [{COLOR: "red"}, {COLOR: "red"}, {COLOR: "blue"}, {"background": "green"}]),
    "scalar": (
        SCENE.with_scalar(name="z", scale=["black", "red"]),
        [{}, {"scalar.scale": ["blue", "white"]}],
    ),
    "light over normals": (SCENE.replace(words="normals"), [{POSITION: [-4, -4, 3]}, {POSITION: [4, -4, 3]}]),
}


@pytest.mark.parametrize("cycle", CYCLES)
def test_after_each_load_of_a_stream_the_display_shows_its_frame(cycle: str, tmp_path: Path) -> None:
    scene, variants = CYCLES[cycle]
    made = frames(scene, variants, 4, loop=False)
    animate(scene, made, tmp_path / "cycle.ramtek")
    fields = list(played(tmp_path / "cycle.ramtek"))
    assert len(fields) == 4
    for field, expected in zip(fields, full_size(scene, made), strict=True):
        assert np.array_equal(field, expected)
    # The words of a picture take 640 x 480 words, and each load at most a table.
    words = os.path.getsize(tmp_path / "cycle.ramtek") // 2
    assert words < 640 * 480 + 5000 + 4 * 2100


NO_CYCLES: list[tuple[str, object, str]] = [
    (POSITION, [4, -4, 3], "an edit of lights.key.position changes words"),
    ("lights.key.intensity", 0.1, "write a film such as .webp, or let words stand for normals"),
    ("view.eye", [4, -4, 3], "an edit of view.eye changes words; write a film such as .webp"),
    ("mapping", "gamma", "an edit of mapping changes words"),
    ("scalar", {"name": "z"}, "an edit of scalar changes words"),
]


@pytest.mark.parametrize(("key", "value", "sentence"), NO_CYCLES)
def test_a_frame_of_a_stream_that_changes_more_than_entries_is_refused(
    key: str, value: object, sentence: str, tmp_path: Path
) -> None:
    rows: list[dict[str, object]] = [{COLOR: "red"}, {COLOR: "blue", key: value}]
    with pytest.raises(InputError) as refusal:
        animate(SCENE, rows, tmp_path / "cycle.ramtek")
    assert str(refusal.value).startswith("frame 2: a frame of a stream must change entries")
    assert sentence in str(refusal.value)
    # What is the same in all frames may be anything.
    animate(SCENE, [{COLOR: "red", key: value}, {COLOR: "blue", key: value}], tmp_path / "cycle.ramtek")


def test_a_legend_that_goes_is_refused_in_a_stream(tmp_path: Path) -> None:
    scene = SCENE.with_scalar(name="z")
    with pytest.raises(InputError, match="frame 2: it must have the legend of the first frame"):
        animate(scene, [{}, {"scalar.legend": False}], tmp_path / "cycle.ramtek")
    assert os.listdir(tmp_path) == []


def test_a_frame_that_cannot_be_made_is_named_and_nothing_is_written(tmp_path: Path) -> None:
    # The light passes through the point that it is aimed at.
    through = frames(SCENE, [{POSITION: [0.5, 0.5, -0.5]}, {POSITION: [0.5, 0.5, 1.5]}], 3)
    with pytest.raises(InputError, match=r"frame 2: .*the aim must differ from the position"):
        animate(SCENE, through, tmp_path / "film.webp", size=SIZE)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("bad", "sentence"),
    [
        ({COLOR: "no"}, "frame 2: surface 'cube': object_color"),
        ({"ambient": None}, "frame 2: ambient: it must be a finite number"),
    ],
)
def test_a_frame_of_a_stream_that_cannot_be_made_is_named(
    bad: dict[str, object], sentence: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError) as refusal:
        animate(SCENE, [{COLOR: "red"}, bad], tmp_path / "cycle.ramtek")
    assert str(refusal.value).startswith(sentence)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("name", ["film.webp", "cycle.ramtek", "{number}.png"])
def test_an_existing_file_is_refused_before_anything_is_rendered_unless_it_may_be_overwritten(
    name: str, visible: list[object], tmp_path: Path
) -> None:
    path = tmp_path / name.replace("{number}", "3")
    path.write_bytes(b"mine")
    with pytest.raises(OutputError, match="exists"):
        animate(SCENE, FADE, tmp_path / name, size=None if "ramtek" in name else SIZE)
    assert visible == []
    assert (os.listdir(tmp_path), path.read_bytes()) == ([path.name], b"mine")
    animate(SCENE, FADE, tmp_path / name, size=None if "ramtek" in name else SIZE, overwrite=True)
    assert path.read_bytes() != b"mine"


REFUSED: list[tuple[str, dict[str, Any], str]] = [
    ("film.png", {}, "an animation must be written to .webp, .ramtek, or numbered pictures"),
    ("film.gif", {}, "an animation must be written to .webp, .ramtek, or numbered pictures"),
    ("film.webp", {"fps": "24"}, "per second must be a number from 0.1 to 100, not '24'"),
    ("film.ramtek", {"smooth": 2}, "a stream must have smooth=1, because a display cannot average"),
]


@pytest.mark.parametrize(("name", "options", "sentence"), REFUSED)
def test_a_wrong_name_or_rate_is_refused_before_anything_is_rendered(
    name: str, options: dict[str, Any], sentence: str, visible: list[object], tmp_path: Path
) -> None:
    with pytest.raises(UsageError) as refusal:
        animate(SCENE, FADE, tmp_path / name, **options)
    assert sentence in str(refusal.value)
    assert visible == []
    with pytest.raises(UsageError, match="a stream must have smooth=1"):
        animate((SCENE, SMOOTH), FADE, tmp_path / "film.ramtek")
    with pytest.raises(UsageError, match="an animation must have at least one frame, not none"):
        animate(SCENE, [], tmp_path / "film.webp")
