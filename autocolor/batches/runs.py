"""Making the pictures of a run of variants, in this process or in a worker.

Each variant of a run reuses whatever its edit leaves of the variant before it. If a batch only recolors, its
picture travels with each run; otherwise the scene travels. Each worker keeps its last rendering until it
works at another batch.
"""

from __future__ import annotations

import dataclasses
import pickle
import secrets
import time
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from threading import get_ident
from typing import Final, NamedTuple

from autocolor.arrays import Bytes
from autocolor.batches.outputs import ARRAY, FORMS
from autocolor.batches.sheet import Box, thumbnail
from autocolor.budget import allowing
from autocolor.errors import AutocolorError
from autocolor.files.settings import scene_with
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


def forget(start: Start) -> None:
    """Forget the start of a batch that ended: threads of this process may have unpickled a copy."""
    _ARRIVED.pop(start.token, None)


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
        encoder = None if drawing.form == ARRAY else FORMS[drawing.form].encoded
        image = colors if encoder is None else encoder(colors, drawing.level, task.mark)
    except AutocolorError as error:
        problem = str(error)
    except MemoryError:
        problem = "a picture must fit in memory, and this one does not; make it smaller"
    return Made(task.number, image, problem, time.thread_time() - begun, tier, small)
