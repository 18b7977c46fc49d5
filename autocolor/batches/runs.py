"""Making the pictures of variants, in runs whose variants share what their edits do not change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Executor
from os import PathLike
from typing import NamedTuple

from autocolor.arrays import Bytes
from autocolor.batches.table import Rows
from autocolor.files.picture_file import SavedPicture
from autocolor.lighting.picture import Picture
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene

Source = Scene | Picture | SavedPicture | tuple[Scene, Picture] | str | PathLike[str]
"""What variants are made of: a scene, a scene with its picture, a picture file that was read, or a path."""


class Result(NamedTuple):
    """What became of a variant.

    `path` is its file, if any. `image` is its colors, (lines, elements, 3) uint8, or the bytes of a file, if
    it has no path. `problem` says why there is no picture; it is empty if there is one. `seconds` is the time
    of its processor, `tier` the cost of the edit from the variant made before it, None for no edit.
    `was_made` is false for a picture that was there already.
    """

    name: str
    settings: Mapping[str, object]
    path: str | None = None
    image: Bytes | bytes | None = None
    problem: str = ""
    seconds: float = 0.0
    tier: Tier | None = None
    was_made: bool = True


def batch_results(
    source: Source,
    variants: Rows,
    output: str | PathLike[str] | None = None,
    *,
    executor: Executor | None = None,
    runs: int = 16,
    size: tuple[int, int] = (640, 480),
    smooth: int | None = None,
    form: str | None = None,
    level: int | None = None,
    sync: bool = True,
    overwrite: bool = False,
    resume: bool = False,
    ordered: bool = False,
) -> Iterator[Result]:
    """The results of variants as their pictures are made, in bounded memory.

    With `ordered`, they come in the order of the variants, each made after the one before it.
    """
    raise NotImplementedError
