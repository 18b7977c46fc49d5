"""Small pictures of files, and many of them in one palette."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from autocolor import render, write_picture, write_scene
from autocolor.files.opening import kind_of
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.gallery import MOST_POLYGONS, Gallery, Small, Tile, small_picture_of_file
from autocolor.widgets.items import Area
from ramtek_emu import Ramtek9300
from tests.autocolor.widgets.drawing import draw_items
from tests.small import wall, wall_scene

SIDE = round(MOST_POLYGONS**0.5) + 1

AREA = Area(100, 50, 217, 152)


@pytest.mark.parametrize(
    ("name", "size", "note"),
    [
        ("wide.npz", (6, 224), "700x20"),
        ("tall.npz", (168, 42), "100x400"),
        ("small.npz", (48, 96), "96x48"),
        ("scene", (168, 224), "1 polygons"),
        ("mesh.obj", (168, 224), "1 polygons"),
        ("large", None, "too large"),
        ("damaged.npz", None, "no picture"),
        ("broken.obj", None, "no picture"),
        ("foreign.3mf", None, "no picture"),
        ("gone.obj", None, "no picture"),
    ],
)
def test_a_file_has_a_small_picture_or_says_why_not(
    tmp_path: Path, name: str, size: tuple[int, int] | None, note: str
) -> None:
    path, scene = tmp_path / name, wall_scene()
    match path.suffix:
        case ".npz" if size:
            width, height = map(int, note.split("x"))
            write_picture(path, scene, render(scene, (width, height)))
        case "":
            write_scene(path, wall_scene(wall(SIDE, SIDE)) if name == "large" else scene)
        case ".obj" if size:
            path.write_text("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n")
        case _ if name != "gone.obj":
            path.write_text("damaged")
    small = small_picture_of_file(path, kind_of(path), "z", times=2)
    assert small.note == note
    assert (None if small.colors is None else small.colors.shape[:2]) == size


def test_the_pictures_of_a_gallery_come_in_turn_in_one_palette() -> None:
    colors = {number: np.full((4, 6, 3), 40 * number, np.uint8) for number in range(3)}
    wanted = {number: partial(Small, each) for number, each in colors.items()}
    wanted[3] = partial(Small, None, "no picture")
    gallery = Gallery()

    def tile(number: int) -> Tile:
        return gallery.framed(number, Tile("name").at(AREA))

    for count in range(4):
        assert sum(tile(number).picture is not None for number in wanted) == count
        assert gallery.advance(wanted)
    assert not gallery.advance(wanted)
    assert tile(3).note == "no picture"
    ((first, palette),) = gallery.loads
    assert 0 < first < first + len(palette) <= SCREENS.first
    for number, each in colors.items():
        picture, display = tile(number).picture, Ramtek9300()
        assert picture is not None
        draw_items(display, [picture])
        left, top, right, bottom = picture.area
        words = display.words[top : bottom + 1, left : right + 1]
        assert np.array_equal(palette[words - first], each)
        assert tile(number).frame.covers(picture.area)
    gallery.keep([0])
    assert [tile(number).picture is not None for number in wanted] == [True, False, False, False]
    # A picture that is wanted no more is shown no more.
    assert gallery.advance({1: partial(Small, colors[1])})
    assert [tile(number).picture is not None for number in wanted] == [False, True, False, False]
