"""Galleries: small pictures in one palette, made one after the other while nothing moves.

The palette takes the words of all surfaces, so only a screen that shows no surface has a gallery.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.errors import AutocolorError
from autocolor.files.foreign.reader import FOREIGN
from autocolor.files.opening import MESH, PICTURE, read_scene
from autocolor.files.picture_file import read_picture
from autocolor.images import display_image
from autocolor.lighting.picture import Picture
from autocolor.mapping.palette import in_palette, thumbnail
from autocolor.mapping.ranges import BACKGROUND
from autocolor.rendering import rendering
from autocolor.scene.scene import Scene
from autocolor.widgets.items import (
    CHARACTER,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    filled,
    fitted,
    image,
    outline,
    text,
)
from autocolor.widgets.widget import Button

LINES: Final = 84
ELEMENTS: Final = 112
"""The largest size of the small picture on a tile."""

FRAME: Final = 3
NAME_LINES: Final = 13
TILE_LINES: Final = LINES + 2 * FRAME + NAME_LINES
TILE_ELEMENTS: Final = ELEMENTS + 2 * FRAME

FIRST_WORD: Final = BACKGROUND + 1
MOST_COLORS: Final = 500
"""Assumed: the most colors of all small pictures together; more take longer, and are not seen."""

MOST_POLYGONS: Final = 100_000
"""Assumed: a scene of more polygons has no small picture. It takes up to a quarter of a second."""

PART_OF_BUDGET: Final = 0.05
"""Limit: the part of the memory budget to read a file for its small picture."""

LEAST_NAME: Final = 12
"""The fewest letters of a name that is cut for the note beside it."""


class Small(NamedTuple):
    """A small picture: its colors, (lines, elements, 3), or None; and a note on it, or why there is none."""

    colors: Bytes | None
    note: str = ""


NO_PICTURE: Final = Small(None, "no picture")


class Gallery:
    """The small pictures of a screen, by their keys."""

    def __init__(self) -> None:
        self.loads: Sequence[tuple[int, Bytes]] = ()
        """The entries that the pictures borrow."""
        self._small: dict[Hashable, Small] = {}
        self._words: dict[Hashable, Words] = {}
        """The words of the pictures that are shown."""
        self._items: dict[tuple[Hashable, Area], Item] = {}

    def advance(self, wanted: Mapping[Any, Callable[[], Small]]) -> bool:
        """Make the next of the wanted pictures, and show those that are made; False if nothing is left.

        Where a picture raises an AutocolorError, the tile says "no picture".
        """
        missing = next((key for key in wanted if key not in self._small), None)
        if missing is not None:
            try:
                self._small[missing] = wanted[missing]()
            except AutocolorError:
                self._small[missing] = NO_PICTURE
        made = {key: self._small[key].colors for key in wanted if key in self._small}
        small = {key: colors for key, colors in made.items() if colors is not None}
        if small.keys() == self._words.keys():
            return missing is not None
        self._words, self._items, self.loads = {}, {}, ()
        if small:
            pixels = np.concatenate([each.reshape(-1, 3) for each in small.values()])
            places, colors = in_palette(pixels[None], MOST_COLORS)
            ends = np.cumsum([each.shape[0] * each.shape[1] for each in small.values()])
            for key, words in zip(small, np.split(places[0] + np.uint16(FIRST_WORD), ends[:-1]), strict=True):
                self._words[key] = words.reshape(small[key].shape[:2])
            self.loads = [(FIRST_WORD, colors)]
        return True

    def keep(self, keys: Collection[Hashable] = ()) -> None:
        """Forget all other pictures; they are made again when they are wanted."""
        self._items = {}
        for key in self._small.keys() - keys:
            del self._small[key]
            self._words.pop(key, None)

    def framed(self, key: Hashable, tile: Tile) -> Tile:
        """A tile with the picture of a key in the middle of its frame, and its note, if they are known."""
        words, frame = self._words.get(key), tile.frame
        if words is not None and (key, frame) not in self._items:
            lines, elements = words.shape
            left, top = frame.left + (frame.width - elements) // 2, frame.top + (frame.height - lines) // 2
            self._items[key, frame] = image(words, left, top)
        note = self._small.get(key, Small(None)).note
        return replace(tile, picture=self._items.get((key, frame)), note=note)


def small_picture(scene: Scene, picture: Picture, times: int = 1) -> Bytes:
    """The colors of a picture, shrunk to the size of a tile, or to `times` the size."""
    shrunk = max(picture.lines / (times * LINES), picture.elements / (times * ELEMENTS), 1)
    lines, elements = (max(1, round(size / shrunk)) for size in (picture.lines, picture.elements))
    return thumbnail(display_image(scene, picture), lines, elements)


def small_picture_of_file(path: Path, kind: str, up: str, times: int = 1) -> Small:
    """The small picture of a file of a kind (see `Openable`); meshes are read with this axis up.

    Raises AutocolorError.
    """
    if kind == PICTURE.name:
        scene, picture = read_picture(path, limit=PART_OF_BUDGET)
        return Small(small_picture(scene, picture, times), "{}x{}".format(*picture.size))
    if any(path.suffix.lower() in each.suffixes for each in FOREIGN):
        # Another process reads it, which takes seconds.
        return NO_PICTURE
    scene = read_scene(path, up=up if kind == MESH else "z", limit=PART_OF_BUDGET)
    count = len(scene.mesh.node_numbers)
    if count > MOST_POLYGONS:
        return Small(None, "too large")
    picture = rendering(scene, 2 * times * LINES, 2 * times * ELEMENTS).picture
    return Small(small_picture(scene, picture, times), f"{count:,} polygons")


@dataclass(frozen=True)
class Tile(Button):
    """A small picture in a frame, with its name below, and its note beside the name or in the empty frame."""

    picture: Item | None = None
    note: str = ""

    @property
    def frame(self) -> Area:
        """The area of the frame."""
        return self.area._replace(bottom=self.area.bottom - NAME_LINES)

    def items(self, lit: bool) -> list[Item]:
        left, top, right, bottom = self.frame
        word = YELLOW if self.is_chosen else LIGHT_GRAY if lit else SLATE
        room, note = (self.area.width - 2 * FRAME) // CHARACTER, self.note
        width = CHARACTER * len(note)
        items = [filled(self.area, NIGHT), outline(self.frame, word)]
        if self.picture is not None:
            items.append(self.picture)
            if room - len(note) - 2 >= min(len(self.label), LEAST_NAME):
                room -= len(note) + 2
                items.append(text(note, right + 1 - FRAME - width, bottom + 4, LIGHT_GRAY))
        else:
            items.append(text(note, (left + right + 1 - width) // 2, (top + bottom) // 2 - 4, LIGHT_GRAY))
        name = fitted(self.label, room)
        return [*items, text(name, left + FRAME, bottom + 4, YELLOW if self.is_chosen else WHITE)]
