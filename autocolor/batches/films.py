"""Animations as files: films, numbered pictures, and streams of instructions that cycle colors.

docs/guides/paint.md shows each. `ramtek_emu.films` writes the films.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import closing
from io import BytesIO
from numbers import Real
from os import PathLike, fspath
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.batches.frames import frames_of_tracks
from autocolor.batches.making import (
    Batch,
    Drawn,
    Source,
    batch_results,
    checked_batch,
    scene_and_picture,
    tier_of,
)
from autocolor.batches.table import Result, Rows, Variant, variants_of
from autocolor.checks import brief, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.settings import scene_with
from autocolor.files.writing import refusals_of_this_package, refuse_output, write_atomically
from autocolor.mapping.display_image import DisplayImage
from autocolor.rendering import sees_the_same
from autocolor.scene.columns import Tier
from autocolor.scene.scene import NORMALS, Scene, costs_at_least
from autocolor.sending import send_cycle
from ramtek_emu import Recorder

FRAMES_PER_SECOND: Final = 24.0
"""Assumed: the rate of motion pictures."""

STREAM: Final = ".ramtek"
FILM: Final = ".webp"

Progress = Callable[[Result], object]
"""A function that is called with the result of each frame."""


class Film(NamedTuple):
    """An animation that was written: its path, or the pattern of its paths, and the number of frames."""

    path: str
    frames: int


def animate(
    source: Source,
    variants: Rows,
    path: str | PathLike[str],
    *,
    frames: int | None = None,
    fps: float = FRAMES_PER_SECOND,
    loop: bool = True,
    size: tuple[int, int] | None = None,
    smooth: int | None = None,
    executor: Executor | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Film:
    """Write variants as the frames of an animation to a file; its suffix gives the format.

        paints = [{"surfaces.body.object_color": color} for color in ("red", "navy", "red")]
        autocolor.animate(scene, paints, "paints.webp", frames=48)
        autocolor.animate(scene, autocolor.frames(scene, [], 72, turn=360), "around.webp")

    Without `frames`, each variant is a frame; otherwise there are so many frames from the first variant to
    the last, as the function `frames` makes them. `fps`, the frames per second, is 0.1 to 100.

    A frame costs its edit from the frame before. Memory is bounded, because frames are written as they are
    made; only a stream is in memory until its end. With `loop`, a film begins again at its end. `source`,
    `size`, `smooth`, `executor` and `overwrite` are those of `batch`; `progress` is called with the result of
    each frame.

    `path` may be a pattern of numbered pictures, such as "frame-{number:04}.png". A file that ends in .ramtek
    has the words of the first frame and then a load of the lookup table for each frame; it is never smooth.

    Raises UsageError for an unknown suffix or a wrong rate, InputError with the frame that cannot be made,
    and OutputError or WriteError if the file cannot be written. Without a whole film nothing is written, but
    numbered pictures that were finished stay.
    """
    from ramtek_emu.films import write_film

    rows = variants_of(variants)
    name = fspath(path)
    kind = kind_of(name)
    if not rows:
        raise UsageError("an animation must have at least one frame, not none; make some with `frames`")
    check_rate(fps)
    if frames is not None:
        scene, picture = scene_and_picture(source)
        source = scene if picture is None else (scene, picture)
        rows = frames_of_tracks(scene, [rows], frames, loop=None if loop else False)
    tell = progress or (lambda result: None)
    if kind == STREAM:
        return _stream(source, rows, name, size, smooth, overwrite, tell)
    output = name if kind == ".png" else None
    if output is None:
        refuse_output(name, overwrite=overwrite)
    results = batch_results(
        source,
        rows,
        output,
        executor=executor,
        size=size,
        smooth=smooth,
        overwrite=overwrite,
        ordered=True,
    )
    with closing(results):
        if output is not None:
            for _ in _made(results, tell):
                pass
            return Film(name, len(rows))
        with refusals_of_this_package(name):
            write_film(
                name,
                (result.image for result in _made(results, tell) if isinstance(result.image, np.ndarray)),
                fields_per_second=fps,
                loop=loop,
                overwrite=overwrite,
            )
    return Film(name, len(rows))


def kind_of(path: str) -> str:
    """The suffix of an animation's file. Raises UsageError for a name of another kind."""
    suffix = Path(path).suffix.lower()
    if suffix not in (FILM, STREAM) and not (suffix == ".png" and "{" in path):
        raise UsageError(
            "an animation must be written to .webp, .ramtek, or numbered pictures such as"
            f" frame-{{number:04}}.png, not to {shown(path)}; rename it"
        )
    return suffix


def check_rate(fps: float) -> None:
    """Raise UsageError unless a film can have this rate."""
    from ramtek_emu.films import LEAST_RATE, MOST_RATE

    is_number = isinstance(fps, Real) and not isinstance(fps, bool)
    if not is_number or not LEAST_RATE <= fps <= MOST_RATE:
        raise UsageError(
            f"the frames per second must be a number from {LEAST_RATE:g} to {MOST_RATE:g}, not"
            f" {shown(fps)}; choose another"
        )


def _made(results: Iterator[Result], tell: Progress) -> Iterator[Result]:
    """The results, which are passed to `tell`. Raises InputError for the first frame without a picture."""
    for number, result in enumerate(results, 1):
        if result.problem:
            raise InputError(f"frame {number}: {result.problem}")
        yield result
        tell(result)


# Color cycling: one load of the lookup table a frame.


def _stream(
    source: Source,
    variants: tuple[Variant, ...],
    path: str,
    size: tuple[int, int] | None,
    smooth: int | None,
    overwrite: bool,
    tell: Progress,
) -> Film:
    """Write the stream of an animation. Raises InputError if a frame changes more than entries."""
    refuse_output(path, overwrite=overwrite)
    scene, picture = scene_and_picture(source)
    if picture is None and smooth is None:
        smooth = 1
    source = scene if picture is None else (scene, picture)
    batch = checked_batch(source, variants, None, size=size, smooth=smooth, ordered=True)
    if batch.start.drawing.smooth > 1:
        raise UsageError(
            "a stream must have smooth=1, because a display cannot average; leave it out, or render the"
            " picture file with --smooth 1"
        )
    file = BytesIO()
    send_cycle(Recorder(file), _images(batch, tell))
    write_atomically(path, file.getvalue(), overwrite=overwrite)
    return Film(path, len(variants))


def _images(batch: Batch, tell: Progress) -> Iterator[DisplayImage]:
    """The display images of frames that change entries alone. Raises InputError, with the frame."""
    drawn: Drawn | None = None
    first: Scene | None = None
    for number, variant in enumerate(batch.variants, 1):
        try:
            scene = scene_with(batch.start.scene, variant.settings)
            first = first or scene
            # Where words stand for normals, an edit of a light changes entries alone.
            has_the_normals = first.words == scene.words == NORMALS and sees_the_same(first, scene)
            if costs_at_least(first, scene, Tier.LEVELS) and not has_the_normals:
                raise InputError(_other_words(first, batch.variants[0].settings, variant.settings))
            drawn = batch.start.drawn(variant.settings, drawn)
        except (InputError, UsageError) as error:
            raise InputError(f"frame {number}: {problem}" for problem in error.problems) from None
        yield drawn.image
        tell(Result(variant.name, variant.settings, tier=drawn.tier))


def _other_words(scene: Scene, one: Mapping[str, object], two: Mapping[str, object]) -> str:
    """What is wrong with a frame that changes words, with the dearest key in which the settings differ."""
    tier, key = max((tier_of(scene, key), key) for key in {*one, *two} if one.get(key) != two.get(key))
    is_light = tier in (Tier.MIX, Tier.LIGHT)
    by_normals = ", or let words stand for normals (--normals; words='normals' in Python)" if is_light else ""
    return (
        "a frame of a stream must change entries of the lookup table alone, and an edit of"
        f" {brief(key)} changes words; write a film such as .webp{by_normals}"
    )
