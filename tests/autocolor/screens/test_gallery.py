"""Small pictures of files, and many of them in one palette."""

from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import render, write_picture, write_scene
from autocolor.files.opening import kind_of
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.gallery import MOST_POLYGONS, Gallery, Tile, small_picture_of_file
from autocolor.widgets.items import Area
from tests.small import wall, wall_scene

SIDE = round(MOST_POLYGONS**0.5) + 1

AREA = Area(100, 50, 349, 259)


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
    gallery = Gallery()
    wanted = {name: lambda: small_picture_of_file(path, kind_of(path), "z", times=2)}
    assert [gallery.advance(wanted), gallery.advance(wanted)] == [True, False]
    tile = gallery.framed(name, Tile("name").at(AREA))
    assert tile.note == note
    assert (None if tile.picture is None else (tile.picture.area.height, tile.picture.area.width)) == size
    assert tile.picture is None or tile.frame.covers(tile.picture.area)
    assert all(0 < first < first + len(palette) <= SCREENS.first for first, palette in gallery.loads)
