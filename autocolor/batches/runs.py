"""The order of variants, and making the pictures of a run of them, in this process or in a worker.

Each variant of a run reuses whatever its edit leaves of the variant before it. So variants that see the same
points are made one after the other, among them those with the same light, and so on down to recolorings: a
grid of views, lights and paints renders each view once and lights each view once for all paints. If a batch
only recolors, its picture travels with each run; otherwise the scene travels. Each worker keeps its last
rendering until it works at another batch.
"""

from __future__ import annotations

import dataclasses
import pickle
import secrets
import time
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from itertools import groupby
from threading import get_ident
from typing import Final, NamedTuple

from autocolor.arrays import Bytes
from autocolor.batches.outputs import ARRAY, marked
from autocolor.batches.sheet import Box, thumbnail
from autocolor.batches.table import Variant
from autocolor.budget import allowing
from autocolor.errors import AutocolorError, UsageError
from autocolor.files.settings import field_of, place_of, scene_with
from autocolor.images import display_image, smoothed
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import DisplayImage
from autocolor.rendering import Rendering, rendering
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene, cost_of_edit, costs_at_least


class Drawing(NamedTuple):
    """How the pictures of a batch are drawn: `smooth` times the lines and elements are rendered."""

    lines: int
    elements: int
    smooth: int
    form: str
    level: int | None
    thumbnail: Box | None
    """The size of thumbnails, for a sheet."""
    limit: float

    @property
    def raster(self) -> tuple[int, int]:
        """The lines and elements to render."""
        return self.smooth * self.lines, self.smooth * self.elements

    @property
    def bytes_of_picture(self) -> int:
        """The most bytes of a picture."""
        return 3 * self.lines * self.elements

    @property
    def numbers(self) -> tuple[object, ...]:
        """The values that determine the bytes of a file, besides the scene."""
        return self.lines, self.elements, self.smooth, self.form, self.level


class VariantTask(NamedTuple):
    """A variant to make: its number, its settings and the mark of its file."""

    number: int
    settings: Mapping[str, object]
    mark: str


class Made(NamedTuple):
    """The picture of a variant, or the problem, with the thumbnail for a sheet."""

    number: int
    image: Bytes | bytes | None
    problem: str
    seconds: float
    tier: Tier | None
    thumbnail: Bytes | None


class Latest(NamedTuple):
    """The variant that was made last: its scene, its rendering, and its image."""

    scene: Scene
    rendering: Rendering | None
    image: DisplayImage


class Start:
    """The start of all variants: a scene, perhaps its picture, and the latest variant of each thread.

    It travels with each run. A process unpickles the first copy, and uses it for all runs of the batch.
    """

    def __init__(self, scene: Scene, picture: Picture | None, token: str = "") -> None:
        self.scene, self.picture, self.token = scene, picture, token or secrets.token_hex(16)
        self._latest: dict[int, Latest] = {}

    def __reduce__(self) -> tuple[Callable[[str, bytes], Start], tuple[str, bytes]]:
        return _arrived, (self.token, self._pickled)

    @cached_property
    def _pickled(self) -> bytes:
        # No variant needs the planes of the lights: a variant with other light is rendered.
        picture = None if self.picture is None else dataclasses.replace(self.picture, light_planes={})
        return pickle.dumps((self.scene, picture), protocol=5)

    def image_of(self, settings: Mapping[str, object], drawing: Drawing) -> tuple[DisplayImage, Tier | None]:
        """The image of a variant, and the cost of the edit from the variant before it. Raises InputError."""
        scene = scene_with(self.scene, settings)
        # A thread begins with what another thread rendered.
        latest = self._latest.get(get_ident()) or next(iter(list(self._latest.values())), None)
        rendered = None if latest is None else latest.rendering
        if self.picture is not None and _is_shown_by(self.scene, scene):
            picture = self.picture
            tier = cost_of_edit(self.scene if latest is None else latest.scene, scene)
        else:
            tier = Tier.FRAME if latest is None or rendered is None else cost_of_edit(latest.scene, scene)
            rendered = rendering(scene, *drawing.raster, rendered)
            picture = rendered.picture
        image = display_image(scene, picture, None if latest is None else latest.image)
        self._latest[get_ident()] = Latest(scene, rendered, image)
        return image, tier


def _is_shown_by(rendered: Scene, scene: Scene) -> bool:
    """Whether the picture of one scene is the picture of another."""
    return rendered.words == scene.words and not costs_at_least(rendered, scene, Tier.MIX)


_ARRIVED: Final[dict[str, Start]] = {}
"""The start of the batch that this process works at for another, by its token."""


def _arrived(token: str, pickled: bytes) -> Start:
    """The start of a batch in the process of a worker."""
    start = _ARRIVED.get(token)
    if start is None:
        _ARRIVED.clear()
        scene, picture = pickle.loads(pickled)
        start = _ARRIVED[token] = Start(scene, picture, token)
    return start


def make_run(start: Start, drawing: Drawing, tasks: Sequence[VariantTask]) -> list[Made]:
    """The pictures of a run. A variant that cannot be made has a problem, and the others are made."""
    return [make(start, drawing, task) for task in tasks]


def make(start: Start, drawing: Drawing, task: VariantTask) -> Made:
    """The picture of a variant."""
    begun = time.thread_time()
    image: Bytes | bytes | None = None
    tier, small, problem = None, None, ""
    try:
        with allowing(drawing.limit):
            shown_image, tier = start.image_of(task.settings, drawing)
            colors = smoothed(shown_image, drawing.smooth)
        small = None if drawing.thumbnail is None else thumbnail(colors, drawing.thumbnail)
        is_array = drawing.form == ARRAY
        image = colors if is_array else marked(drawing.form, colors, drawing.level, task.mark)
    except AutocolorError as error:
        problem = str(error)
    except MemoryError:
        problem = "a picture must fit in memory, and this one does not; make it smaller"
    return Made(task.number, image, problem, time.thread_time() - begun, tier, small)


# The order of variants: each costs only the edit from the variant before it.


def runs_of(scene: Scene, variants: Sequence[Variant], most: int) -> list[list[int]]:
    """The numbers of all variants, from 0, in runs of at most `most`, in the order to make them.

    Variants of one frame share as few runs as possible, and several small frames share a run.
    """
    keys = dict.fromkeys(key for variant in variants for key in variant.settings)
    tiers = {key: tier_of(scene, key) for key in keys}
    dear = sorted((key for key in tiers if tiers[key] > Tier.ENTRIES), key=tiers.__getitem__, reverse=True)
    frames = [key for key in dear if tiers[key] is Tier.FRAME]

    def values(number: int, some: Sequence[str]) -> list[str]:
        return [repr(variants[number].settings.get(key)) for key in some]

    # Sorting is stable: recolorings stay in the order of their table.
    numbers = sorted(range(len(variants)), key=lambda number: values(number, dear))
    runs: list[list[int]] = [[]]
    for _, members in groupby(numbers, key=lambda number: values(number, frames)):
        frame = list(members)
        if len(runs[-1]) + len(frame) > most and runs[-1]:
            runs.append([])
        pieces = cut(frame, most)
        runs[-1].extend(pieces[0])
        runs.extend(pieces[1:])
    return [run for run in runs if run]


def cut(numbers: Sequence[int], most: int) -> list[list[int]]:
    """Consecutive runs of at most `most` numbers.

    >>> cut([0, 1, 2, 3, 4], 4)
    [[0, 1, 2, 3], [4]]
    """
    return [list(numbers[start : start + most]) for start in range(0, len(numbers), most)]


def tier_of(scene: Scene, key: str) -> Tier:
    """What an edit of a key's field costs at most; NOTHING for a key that no variant can set."""
    try:
        field = field_of(place_of(scene, key))
    except UsageError:
        return Tier.NOTHING
    return Tier.NOTHING if field is None else field.tier
