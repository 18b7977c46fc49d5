"""Pictures in colors without a studio: on displays, as arrays, in PNG files, smooth or not."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from autocolor import (
    InputError,
    OutputError,
    Picture,
    Scalar,
    Scene,
    Studio,
    Surface,
    UsageError,
    image,
    images,
    render,
    save_image,
    save_words,
    scene_of,
    send_picture,
    write_picture,
)
from autocolor.images import averaged, default_smooth, display_image, size_of
from autocolor.layers import save_layers
from autocolor.mapping.legend import legend
from autocolor.sending import shown_colors
from autocolor.testing import scenes
from ramtek_emu import GMR_9300, Ramtek9300
from ramtek_emu.arrays import Colors
from ramtek_emu.png import chunks
from ramtek_emu.testing import entries, rasters
from tests.small import SMALL, car, cube, held, opened, sphere, wall_scene
from tests.tables import call, first, refused

WALL = wall_scene()
WALL_PICTURE = render(WALL, (8, 6))
CUBE = scene_of(cube(), background="#203040")
NOWHERE = Path("no such folder")


@given(scenes())
def test_the_colors_are_those_of_the_field_of_a_display_without_a_legend(scene: Scene) -> None:
    if scene.scalar is not None:
        scene = scene.with_scalar(legend=False)
    studio, display = opened(scene)
    assert (image(scene, studio.picture) == display.field()).all()


def test_a_saved_image_has_the_legend_as_a_display_shows_it(tmp_path: Path) -> None:
    scene = scene_of(cube(), scalar={"name": "z"})
    display = Ramtek9300()
    studio = Studio(scene, display)
    path = tmp_path / "cube.png"
    save_image(path, scene, studio.picture)
    assert (np.asarray(Image.open(path)) == display.field()).all()
    assert (display.field() != image(scene, studio.picture)).any()
    assert studio._repr_png_() == display._repr_png_()


def test_the_image_of_a_studio_is_smooth_and_has_the_size_and_the_legend_of_its_display(
    tmp_path: Path,
) -> None:
    display = Ramtek9300(dataclasses.replace(GMR_9300, elements=320, lines=240))
    studio, path = Studio(scene_of(cube(), scalar={"name": "z"}), display), tmp_path / "cube.png"
    studio.scalar(bands=4)
    studio.save_image(path)
    save_image(tmp_path / "smooth.png", studio.scene, render(studio.scene, (320, 240), smooth=2))
    assert path.read_bytes() == (tmp_path / "smooth.png").read_bytes()
    with pytest.raises(OutputError):
        studio.save_image(path)
    studio.save_image(path, smooth=1, overwrite=True)
    assert (np.asarray(Image.open(path)) == display.field()).all()


@pytest.mark.parametrize("level", range(10))
def test_an_image_has_the_same_pixels_at_every_level_of_compression(tmp_path: Path, level: int) -> None:
    path = tmp_path / "wall.png"
    save_image(path, WALL, WALL_PICTURE, level=level, sync=False)
    assert (np.asarray(Image.open(path)) == image(WALL, WALL_PICTURE)).all()
    # Byte 1 of the compressed data names the class of the level.
    data = path.read_bytes()
    assert data[data.index(b"IDAT") + 5] >> 6 == (0, 0, 1, 1, 1, 1, 2, 3, 3, 3)[level]


@pytest.mark.parametrize("save", [save_image, save_words])
def test_a_file_is_never_written_over_unasked(tmp_path: Path, save: Any) -> None:
    path = tmp_path / "wall.PNG"
    path.write_text("old")
    with pytest.raises(OutputError, match="exists"):
        save(path, WALL, WALL_PICTURE)
    assert path.read_text() == "old"
    save(path, WALL, WALL_PICTURE, overwrite=True)
    with Image.open(path) as file:
        assert file.size == (8, 6)


def words_in_use(levels: int) -> tuple[Scene, Picture]:
    """A wall with as many intensities as levels, evenly spaced, and a picture of it."""
    seen = render(WALL, (64, 48)).surface_number
    relative = np.zeros(seen.shape, np.float32)
    relative[seen > 0] = np.arange(np.count_nonzero(seen)) % levels
    scene = WALL.with_surface("wall", levels=levels)
    return scene, Picture.from_rasters(relative, seen, ("wall",), 1.0)


SCALAR = scene_of(sphere(16, 10), scalar={"name": "z", "bands": 100, "shades": 8})
OTHER = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
test_what_is_refused = refused(
    call,
    [
        *(
            (
                lambda text=text: size_of(text),
                f"a size must be WIDTHxHEIGHT, each from 1 to 4096, not {text!r}; write it as in 1280x960",
            )
            for text in (
                "",
                "640",
                "640x",
                "x480",
                "0x5",
                "5x0",
                "4097x1",
                "-1x5",
                "1.5x2",
                "\uff11x1",
                "1x1\n",
            )
        ),
        *(
            (
                lambda level=level: save_image(NOWHERE / "wall.png", WALL, WALL_PICTURE, level=level),
                f"level must be a whole number from 0 to 9, not {text}; leave it out for the default",
            )
            for level, text in ((-1, "-1"), (10, "10"), (4.0, "4.0"), (True, "true"), ("best", "'best'"))
        ),
        (
            lambda: image(WALL, WALL_PICTURE, smooth=65),
            "smooth must be a whole number from 1 to 64, not 65; give one such as 4",
        ),
        (
            lambda: image(WALL, WALL_PICTURE, smooth=4),
            "the lines and elements of a picture must be multiples of smooth, 4, not 6 and 8; render with"
            " smooth=4",
        ),
        (
            lambda: image(WALL, WALL_PICTURE, size=(8, 6)),
            "a size must be for a scene without its picture, not for a picture of 8 x 6 pixels; leave one of"
            " them out",
        ),
        (
            lambda: save_image(NOWHERE / "cube.jpg", WALL, WALL_PICTURE),
            "an image must be written to a file that ends in .png, not to no such folder/cube.jpg; rename it",
        ),
        (
            lambda: save_words(NOWHERE / "cube.gif", WALL, WALL_PICTURE),
            "words must be written to a file that ends in .png, not to no such folder/cube.gif; rename it",
        ),
        (
            lambda: save_words(NOWHERE / "wall.png", *words_in_use(256), indexed=True),
            "an indexed PNG must have at most 256 words in use, not 257; set `levels` of each surface to 255,"
            " or write the words themselves",
        ),
        (
            lambda: save_words(NOWHERE / "z.png", SCALAR, render(SCALAR, (128, 96)), indexed=True),
            "an indexed PNG must have at most 256 words in use, not 320; set `levels` of each surface to 255,"
            " choose fewer bands or shades of the scalar, or write the words themselves",
        ),
        (
            lambda: image(OTHER, WALL_PICTURE),
            "the surfaces of a picture must be those of the scene, ['paint'], not ['wall']; render this"
            " scene, or use the scene that was rendered",
        ),
        *(
            (
                lambda size=size: send_picture(WALL, render(WALL, size), Ramtek9300(SMALL)),
                f"a picture must be at most 32 x 24, as large as the display, not {size[0]} x {size[1]};"
                " render it smaller, or take a larger configuration",
            )
            for size in ((33, 24), (32, 25))
        ),
    ],
)


@pytest.mark.parametrize(
    "use",
    [
        image,
        lambda scene, picture: send_picture(scene, picture, Ramtek9300(SMALL)),
        *(
            lambda scene, picture, save=save: save(NOWHERE / "cube", scene, picture)
            for save in (save_image, save_words, save_layers, write_picture)
        ),
    ],
)
def test_a_scene_and_a_picture_in_the_wrong_order_are_refused_in_words(use: Any) -> None:
    with pytest.raises(UsageError, match=r"^the scene must come before the picture, not after it; swap"):
        use(WALL_PICTURE, WALL)
    with pytest.raises(UsageError, match=r"^a scene must be a Scene, not Picture\(.*; read a scene from"):
        use(WALL_PICTURE, WALL_PICTURE)
    with pytest.raises(UsageError, match=r"^a picture must be a Picture, not Scene\(.*; `render` makes one"):
        use(WALL, WALL)


def test_a_saved_picture_is_sent_without_rendering() -> None:
    studio, display = opened()
    other = Ramtek9300(SMALL)
    send_picture(studio.scene, studio.picture, other)
    assert held(other) == held(display)
    with pytest.raises(InputError, match="surfaces of a picture must be those of the scene"):
        send_picture(OTHER, studio.picture, display)
    assert held(other) == held(display)


def test_a_picture_smaller_than_the_display_is_shown_at_its_upper_left() -> None:
    display = Ramtek9300(SMALL)
    small = render(WALL, (16, 12))
    send_picture(WALL, small, display)
    shown = display.words != 0
    assert (shown[:12, :16] == (small.surface_number != 0)).all()
    assert shown.sum() == (small.surface_number != 0).sum() > 0


@pytest.mark.parametrize(
    ("text", "size"), [("640x480", (640, 480)), ("1X1", (1, 1)), ("4096x4096", (4096, 4096))]
)
def test_a_size_is_its_width_and_its_height(text: str, size: tuple[int, int]) -> None:
    assert size_of(text) == size


def light_of(component: float) -> float:
    """The light of a component of sRGB, IEC 61966-2-1."""
    share = component / 255
    return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4


def component_of(light: float) -> int:
    """The nearest component for some light, halves up."""
    share = 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055
    return math.floor(255 * share + 0.5)


def saved(path: Path, scene: Scene, lines: int, elements: int, smooth: int) -> Colors:
    """The colors of a saved image."""
    picture = render(scene, (smooth * elements, smooth * lines))
    save_image(path, scene, picture, overwrite=True, smooth=smooth)
    return np.asarray(Image.open(path))


@pytest.mark.parametrize("words", ["levels", "normals"])
@pytest.mark.parametrize("smooth", [1, 2, 3])
def test_a_smooth_image_has_the_mean_light_of_the_squares_of_a_larger_image(
    tmp_path: Path, smooth: int, words: Any
) -> None:
    scene = CUBE.replace(words=words)
    large = image(scene, render(scene, (smooth * 16, smooth * 12)))
    squares = np.vectorize(light_of)(large).reshape(12, smooth, 16, smooth, 3)
    expected = np.vectorize(component_of)(squares.mean(axis=(1, 3)))
    colors = saved(tmp_path / "cube.png", scene, 12, 16, smooth)
    assert colors.tolist() == expected.tolist()
    assert (colors[0, 0] == scene.background).all()


def test_the_legend_of_a_smooth_image_is_as_sharp_as_on_a_display_of_its_size(tmp_path: Path) -> None:
    scene = scene_of(cube(), scalar={"name": "z", "legend_place": (1.0, 0.0)})
    lines, elements = 480, 640
    plain = saved(tmp_path / "plain.png", scene, lines, elements, 1)
    smooth = saved(tmp_path / "smooth.png", scene, lines, elements, 2)
    key = legend(display_image(scene, render(scene, (elements, lines))))
    assert key is not None
    left, top, right, bottom, _ = key.swatches[0]
    is_legend = np.zeros((lines, elements), np.bool_)
    is_legend[top : bottom + 1, left : right + 1] = True
    assert (smooth[is_legend] == plain[is_legend]).all()
    bare = scene.with_scalar(legend=False)
    assert (smooth[~is_legend] == saved(tmp_path / "bare.png", bare, lines, elements, 2)[~is_legend]).all()


@pytest.mark.parametrize("chunk", [1, 40, 1 << 14])
@given(entries(), st.integers(1, 4), st.data())
def test_averaging_takes_the_mean_light_of_each_square_whatever_is_done_at_once(
    chunk: int, entries: Colors, smooth: int, data: st.DataObject
) -> None:
    lines, elements = data.draw(st.tuples(st.integers(1, 5), st.integers(1, 5)))
    words = data.draw(rasters(smooth * lines, smooth * elements))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(images, "PIXELS_AT_ONCE", chunk)
        colors = averaged(entries, words, smooth)
    light, least, most = (np.vectorize(light_of)(each) for each in (entries, colors - 0.5, colors + 0.5))
    mean = light[words].reshape(lines, smooth, elements, smooth, 3).mean(axis=(1, 3))
    assert ((least - 1e-12 <= mean) & (mean <= most + 1e-12)).all()


def test_a_picture_has_its_smoothness_and_its_image_is_smooth_unless_another_is_asked_for() -> None:
    smooth, plain = render(CUBE, (16, 12), smooth=4), render(CUBE, (64, 48))
    assert (smooth.smooth, plain.smooth) == (4, 1)
    assert (smooth.intensity == plain.intensity).all()
    assert (image(CUBE, smooth) == image(CUBE, plain, smooth=4)).all()
    assert image(CUBE, smooth).shape == (12, 16, 3)
    assert (smooth.size, plain.size) == ((16, 12), (64, 48))
    assert (image(CUBE, smooth, smooth=1) == image(CUBE, plain)).all()


def test_an_image_of_a_scene_is_smooth_by_2_unless_it_is_large(tmp_path: Path) -> None:
    assert (image(CUBE) == image(CUBE, render(CUBE, (640, 480), smooth=2))).all()
    save_image(tmp_path / "cube.png", CUBE, size=(16, 12))
    assert (np.asarray(Image.open(tmp_path / "cube.png")) == image(CUBE, size=(16, 12), smooth=2)).all()
    assert (image(CUBE, size=(16, 12), smooth=1) == image(CUBE, render(CUBE, (16, 12)))).all()
    assert [default_smooth((width, 2500)) for width in (4000, 4001)] == [2, 1]


@pytest.mark.parametrize("smooth", [2, 3])
def test_a_display_shows_the_middle_of_each_square_of_a_smooth_picture(smooth: int) -> None:
    display = Ramtek9300(SMALL)
    picture = render(CUBE, (32, 24), smooth=smooth)
    send_picture(CUBE, picture, display)
    large = display_image(CUBE, picture).words
    assert (display.words == large[smooth // 2 :: smooth, smooth // 2 :: smooth]).all()


def test_a_display_shows_the_legend_of_a_smooth_picture_at_its_own_size() -> None:
    scene = scene_of(cube(), scalar={"name": "z"})
    picture, display = render(scene, (640, 480), smooth=2), Ramtek9300()
    send_picture(scene, picture, display)
    large = display_image(scene, picture)
    assert (display.field() == shown_colors(dataclasses.replace(large, words=large.words[1::2, 1::2]))).all()


def suggested_palette(data: bytes) -> bytes:
    """The content of the chunk sPLT of a PNG file."""
    return dict(chunks(data))[b"sPLT"]


KINDS = [{}, {"words": "normals"}, {"scalar": Scalar("stress", bands=8, shades=4)}, {"dither": "ordered"}]


@pytest.mark.parametrize("changes", first(3, KINDS))
def test_words_and_their_entries_are_read_back_from_a_png(tmp_path: Path, changes: dict[str, Any]) -> None:
    scene = car().replace(**changes)
    picture = render(scene, (32, 24), smooth=2)
    shown = display_image(scene, picture)
    path = tmp_path / "words.png"
    save_words(path, scene, picture)
    with Image.open(path) as file:
        assert file.mode == "I;16"
        words = np.asarray(file)
        entries = np.frombuffer(bytes.fromhex(file.info["lookup table"]), np.uint8).reshape(-1, 3)
    assert (words == shown.words).all()
    assert words.shape == (48, 64)
    assert (entries == shown.entries).all()
    assert (entries[words] == image(scene, picture, smooth=1)).all()
    name, _, palette = suggested_palette(path.read_bytes()).partition(b"\0")
    assert (name, palette[0], len(palette)) == (b"lookup table", 8, 1 + 1024 * 6)
    rows = np.frombuffer(palette[1:], np.uint8).reshape(-1, 6)
    assert (rows[:, :3] == shown.entries).all()
    assert (rows[:, 3:] == (255, 0, 0)).all()


@pytest.mark.parametrize("changes", first(3, KINDS))
def test_an_indexed_png_has_the_words_in_use_in_their_order(tmp_path: Path, changes: dict[str, Any]) -> None:
    scene = car().replace(**changes)
    for surface in scene.surfaces:
        scene = scene.with_surface(surface.name, levels=40)
    picture = render(scene, (32, 24), smooth=2)
    save_words(tmp_path / "words.png", scene, picture, indexed=True)
    words = display_image(scene, picture).words
    with Image.open(tmp_path / "words.png") as file:
        assert file.mode == "P"
        indices = np.asarray(file)
        colors = np.asarray(file.convert("RGB"))
    assert (colors == image(scene, picture, smooth=1)).all()
    assert (np.unique(words)[indices] == words).all()


def test_an_indexed_png_may_have_256_words(tmp_path: Path) -> None:
    scene, picture = words_in_use(255)
    assert len(np.unique(display_image(scene, picture).words)) == 256
    save_words(tmp_path / "wall.png", scene, picture, indexed=True)
    with Image.open(tmp_path / "wall.png") as file:
        assert (np.asarray(file.convert("RGB")) == image(scene, picture)).all()
