from __future__ import annotations

import dataclasses
import math
import struct
from pathlib import Path
from typing import Any, Literal

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
from autocolor.images import LARGEST, MOST_INDEXED, averaged, display_image, size_of, smoothed
from autocolor.layers import save_layers
from autocolor.mapping.legend import legend
from autocolor.mapping.ranges import SCREENS
from autocolor.sending import shown_colors
from autocolor.testing import scenes
from ramtek_emu import GMR_9300, Configuration, ConfigurationError, Ramtek9300
from ramtek_emu.arrays import Colors
from ramtek_emu.testing import entries, rasters
from tests.small import SMALL, STRETCHED, car, cube, held, opened, wall_scene


@given(scenes())
def test_the_colors_are_those_of_the_field_of_a_display_without_a_legend(scene: Scene) -> None:
    if scene.scalar is not None:
        scene = scene.with_scalar(legend=False)
    display = Ramtek9300()
    studio = Studio(scene, display)
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


@pytest.mark.parametrize("level", range(10))
def test_an_image_has_the_same_pixels_at_every_level_of_compression(tmp_path: Path, level: int) -> None:
    scene = scene_of(cube())
    picture = render(scene, 48, 64)
    save_image(tmp_path / "cube.png", scene, picture, level=level, sync=False)
    assert (np.asarray(Image.open(tmp_path / "cube.png")) == image(scene, picture)).all()
    # Byte 1 of the compressed data names the class of the level.
    data = (tmp_path / "cube.png").read_bytes()
    assert data[data.index(b"IDAT") + 5] >> 6 == (0, 0, 1, 1, 1, 1, 2, 3, 3, 3)[level]


@pytest.mark.parametrize("level", [-1, 10, 4.0, True, "best"])
def test_a_wrong_level_of_compression_is_refused(tmp_path: Path, level: Any) -> None:
    scene = scene_of(cube())
    with pytest.raises(UsageError, match=r"^level must be a whole number from 0 to 9, not .*; leave it out"):
        save_image(tmp_path / "cube.png", scene, render(scene, 24, 32), level=level)
    assert list(tmp_path.iterdir()) == []


def test_a_picture_is_colored_by_any_scene_that_has_its_surfaces() -> None:
    scene = scene_of(cube(), surfaces="parts", **STRETCHED)
    picture = render(scene, 48, 64)
    blue = scene.with_surface("cube", object_color="#0000ff", light_color="#0000ff")
    assert image(scene, picture).shape == (48, 64, 3)
    colors = image(blue, picture)
    assert not colors[..., :2].any()
    assert colors[..., 2].max() == 255
    assert (colors[picture.surface_number == 0] == scene.background).all()


def test_an_image_is_written_as_a_png_and_never_over_a_file_unasked(tmp_path: Path) -> None:
    scene = scene_of(cube())
    picture = render(scene, 48, 64)
    path = tmp_path / "cube.png"
    save_image(path, scene, picture)
    assert (np.asarray(Image.open(path)) == image(scene, picture)).all()
    with pytest.raises(OutputError, match="exists"):
        save_image(path, scene, picture)
    save_image(path, scene, picture, overwrite=True)


def test_an_image_under_the_name_of_another_kind_is_refused(tmp_path: Path) -> None:
    scene = scene_of(cube())
    path = tmp_path / "cube.jpg"
    with pytest.raises(UsageError) as refusal:
        save_image(path, scene, render(scene, 48, 64))
    assert (
        str(refusal.value)
        == f"an image must be written to a file that ends in .png, not to {path}; rename it"
    )
    assert not path.exists()


def test_a_scene_and_a_picture_in_the_wrong_order_are_refused_in_words(tmp_path: Path) -> None:
    scene = scene_of(cube())
    picture: Any = render(scene, 24, 32)
    swapped: Any = scene
    for swap in (
        lambda: image(picture, swapped),
        lambda: send_picture(picture, swapped, Ramtek9300(SMALL)),
        lambda: save_image(tmp_path / "cube.png", picture, swapped),
        lambda: save_words(tmp_path / "cube.png", picture, swapped),
        lambda: save_layers(tmp_path / "cube.exr", picture, swapped),
        lambda: write_picture(tmp_path / "cube.npz", picture, swapped),
    ):
        with pytest.raises(UsageError, match=r"^the scene must come before the picture, not after it; swap"):
            swap()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(
        UsageError, match=r"a scene must be a Scene, not Picture\(.*; read a scene from files"
    ):
        image(picture, picture)
    with pytest.raises(UsageError, match=r"a picture must be a Picture, not Scene\(.*; `render` makes one"):
        image(scene, scene)  # type: ignore[arg-type]
    name: Any = tmp_path / "cube"
    for save in (save_image, save_words, save_layers, write_picture):
        with pytest.raises(UsageError, match=r"^a picture must be a Picture, not "):
            save(picture, scene, name)


def test_a_picture_of_other_surfaces_is_refused() -> None:
    picture = render(scene_of(cube(), surfaces="parts"), 24, 32)
    other = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
    with pytest.raises(InputError, match=r"must be those of the scene, \['paint'\], not \['cube'\]"):
        image(other, picture)


def test_a_saved_picture_is_sent_without_rendering() -> None:
    studio, display = opened()
    other = Ramtek9300(SMALL)
    send_picture(studio.scene, studio.picture, other)
    assert held(other) == held(display)


def test_a_picture_of_other_surfaces_is_refused_and_leaves_the_display_as_it_was() -> None:
    studio, display = opened()
    before = held(display)
    other = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
    with pytest.raises(InputError, match="surfaces of a picture must be those of the scene"):
        send_picture(other, studio.picture, display)
    assert held(display) == before


def test_a_picture_larger_than_the_display_is_refused_and_a_smaller_one_is_shown_at_its_upper_left() -> None:
    scene = wall_scene()
    display = Ramtek9300(SMALL)
    lines, elements = SMALL.shown_lines, SMALL.shown_elements
    with pytest.raises(UsageError) as refusal:
        send_picture(scene, render(scene, lines, elements + 2), display)
    assert str(refusal.value) == (
        f"a picture must be at most {elements} x {lines}, as large as the display, not"
        f" {elements + 2} x {lines}; render it smaller, or take a larger configuration"
    )
    assert display.words_received == 0
    small = render(scene, lines // 2, elements // 2)
    send_picture(scene, small, display)
    shown = display.words != 0
    assert (shown[: lines // 2, : elements // 2] == (small.surface_number != 0)).all()
    assert shown.sum() == (small.surface_number != 0).sum()


@pytest.mark.parametrize(
    ("text", "size"), [("640x480", (640, 480)), ("1X1", (1, 1)), ("4096x4096", (4096, 4096))]
)
def test_a_size_is_its_elements_and_its_lines(text: str, size: tuple[int, int]) -> None:
    assert size_of(text) == size


@pytest.mark.parametrize(
    "text",
    ["", "640", "640x", "x480", "640,480", "0x5", "5x0", "4097x1", "-1x5", "1.5x2", "\uff11x1", "1x1\n"],
)
def test_what_is_no_size_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(UsageError) as refusal:
        size_of(text)
    assert str(refusal.value) == (
        f"a size must be ELEMENTSxLINES, each from 1 to 4096, not {text!r}; write it as in 1280x960"
    )


def test_the_largest_size_is_that_of_the_largest_display() -> None:
    def display(size: int) -> Configuration:
        return Configuration(name="large", elements=size, lines=size, planes=GMR_9300.planes)

    assert display(LARGEST).lines == LARGEST
    with pytest.raises(ConfigurationError):
        display(LARGEST + 1)


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
    picture = render(scene, smooth * lines, smooth * elements)
    save_image(path, scene, picture, overwrite=True, smooth=smooth)
    return np.asarray(Image.open(path))


@pytest.mark.parametrize("words", ["levels", "normals"])
@pytest.mark.parametrize("smooth", [1, 2, 3])
def test_a_smooth_image_has_the_mean_light_of_the_squares_of_a_larger_image(
    tmp_path: Path, smooth: int, words: Literal["levels", "normals"]
) -> None:
    scene = scene_of(cube(), background="#203040").replace(words=words)
    lines, elements = 12, 16
    large = image(scene, render(scene, smooth * lines, smooth * elements)).tolist()
    expected = [
        [
            [
                component_of(
                    sum(
                        light_of(large[smooth * line + down][smooth * element + across][component])
                        for down in range(smooth)
                        for across in range(smooth)
                    )
                    / smooth**2
                )
                for component in range(3)
            ]
            for element in range(elements)
        ]
        for line in range(lines)
    ]
    colors = saved(tmp_path / "cube.png", scene, lines, elements, smooth)
    assert colors.tolist() == expected
    assert (colors[0, 0] == scene.background).all()


@pytest.mark.parametrize("level", range(0, 256, 15))
def test_a_constant_picture_stays_constant(tmp_path: Path, level: int) -> None:
    scene = wall_scene().replace(background=(level, 255 - level, 7))
    scene = scene.with_view(eye=(0, -2, 50), target=(0, -2, 100))
    assert (saved(tmp_path / "empty.png", scene, 5, 4, 4) == scene.background).all()


def test_the_mean_of_black_and_white_is_half_of_the_light() -> None:
    scene = wall_scene().replace(background="white")
    shown_image = display_image(scene, render(scene, 2, 2))
    black = SCREENS.first
    words = np.array([[0, black], [black, 0]], np.uint16)
    # Half of the light of white; the mean of the components would be 128.
    assert (smoothed(dataclasses.replace(shown_image, words=words), 2) == 188).all()


def test_the_legend_of_a_smooth_image_is_as_sharp_as_on_a_display_of_its_size(tmp_path: Path) -> None:
    scene = scene_of(cube(), scalar={"name": "z", "legend_place": (1.0, 0.0)})
    lines, elements = 480, 640
    plain = saved(tmp_path / "plain.png", scene, lines, elements, 1)
    smooth = saved(tmp_path / "smooth.png", scene, lines, elements, 2)
    key = legend(display_image(scene, render(scene, lines, elements)))
    assert key is not None
    left, top, right, bottom, _ = key.swatches[0]
    inside = slice(top, bottom + 1), slice(left, right + 1)
    assert (smooth[inside] == plain[inside]).all()


@pytest.mark.parametrize("smooth", [0, -1, 65, 1.0, True, "4"])
def test_a_smoothness_that_is_no_whole_number_is_refused(tmp_path: Path, smooth: Any) -> None:
    scene = wall_scene()
    picture = render(scene, 4, 4)
    for refused in (
        lambda: save_image(tmp_path / "wall.png", scene, picture, smooth=smooth),
        lambda: image(scene, picture, smooth=smooth),
        lambda: render(scene, 4, 4, smooth=smooth),
    ):
        with pytest.raises(UsageError, match="smooth must be a whole number from 1 to 64, not"):
            refused()


def test_a_picture_beyond_the_largest_raster_is_refused_with_the_size_that_was_asked_for() -> None:
    with pytest.raises(UsageError) as refusal:
        render(wall_scene(), 4097, 4, smooth=4)
    assert str(refusal.value) == (
        "lines must be a whole number from 1 to 4096 where smooth is 4, not 4097; choose another"
    )


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
    squares = entries[words].reshape(lines, smooth, elements, smooth, 3).swapaxes(1, 2)
    for square, color in zip(squares.reshape(-1, smooth**2, 3), colors.reshape(-1, 3), strict=True):
        for components, component in zip(square.T.tolist(), color.tolist(), strict=True):
            mean = sum(map(light_of, components)) / smooth**2
            assert light_of(component - 0.5) - 1e-12 <= mean <= light_of(component + 0.5) + 1e-12


def test_a_picture_has_its_smoothness_and_its_image_is_smooth_unless_another_is_asked_for() -> None:
    scene = scene_of(cube(), background="#203040")
    smooth, plain = render(scene, 12, 16, smooth=4), render(scene, 48, 64)
    assert (smooth.smooth, plain.smooth) == (4, 1)
    assert (smooth.intensity == plain.intensity).all()
    assert (image(scene, smooth) == image(scene, plain, smooth=4)).all()
    assert image(scene, smooth).shape == (12, 16, 3)
    assert (image(scene, smooth, smooth=1) == image(scene, plain)).all()


@pytest.mark.parametrize("smooth", [2, 3])
def test_a_display_shows_the_middle_of_each_square_of_a_smooth_picture(smooth: int) -> None:
    scene = scene_of(cube(), scalar={"name": "z"})
    lines, elements = GMR_9300.shown_lines, GMR_9300.shown_elements
    picture = render(scene, lines, elements, smooth=smooth)
    display = Ramtek9300()
    send_picture(scene.with_scalar(legend=False), picture, display)
    large = display_image(scene, picture)
    assert (display.words == large.words[smooth // 2 :: smooth, smooth // 2 :: smooth]).all()
    send_picture(scene, picture, display)
    small = dataclasses.replace(large, words=large.words[smooth // 2 :: smooth, smooth // 2 :: smooth])
    assert (display.field() == shown_colors(small)).all()


@pytest.mark.parametrize(("lines", "elements"), [(6, 8), (8, 6), (2, 2)])
def test_a_picture_that_cannot_be_divided_into_squares_is_refused(
    tmp_path: Path, lines: int, elements: int
) -> None:
    scene = wall_scene()
    with pytest.raises(UsageError) as refusal:
        save_image(tmp_path / "wall.png", scene, render(scene, lines, elements), smooth=4)
    assert str(refusal.value) == (
        f"the lines and elements of a picture must be multiples of smooth, 4, not {lines} and {elements};"
        " render with smooth=4"
    )
    assert not (tmp_path / "wall.png").exists()


def suggested_palette(data: bytes) -> bytes:
    """The content of the chunk sPLT of a PNG file."""
    place, content = 8, b""
    while place < len(data):
        (length,) = struct.unpack(">I", data[place : place + 4])
        if data[place + 4 : place + 8] == b"sPLT":
            content = data[place + 8 : place + 8 + length]
        place += 12 + length
    return content


@pytest.mark.parametrize(
    "changes", [{}, {"words": "normals"}, {"scalar": Scalar("stress")}, {"dither": "ordered"}]
)
def test_words_and_their_entries_are_read_back_from_a_png(tmp_path: Path, changes: dict[str, Any]) -> None:
    scene = car().replace(**changes)
    picture = render(scene, 24, 32, smooth=2)
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


def test_another_reader_reads_the_same_words(tmp_path: Path) -> None:
    reader = pytest.importorskip("OpenImageIO")
    scene = car()
    picture = render(scene, 24, 32)
    save_words(tmp_path / "words.png", scene, picture)
    file = reader.ImageInput.open(str(tmp_path / "words.png"))
    assert (file.spec().nchannels, str(file.spec().format)) == (1, "uint16")
    assert (file.read_image("uint16")[..., 0] == display_image(scene, picture).words).all()
    file.close()


@pytest.mark.parametrize(
    "changes", [{}, {"words": "normals"}, {"scalar": Scalar("stress", bands=8, shades=4)}]
)
def test_an_indexed_png_has_the_words_in_use_in_their_order(tmp_path: Path, changes: dict[str, Any]) -> None:
    scene = car().replace(**changes)
    for surface in scene.surfaces:
        scene = scene.with_surface(surface.name, levels=40)
    picture = render(scene, 24, 32, smooth=2)
    save_words(tmp_path / "words.png", scene, picture, indexed=True)
    words = display_image(scene, picture).words
    with Image.open(tmp_path / "words.png") as file:
        assert file.mode == "P"
        indices = np.asarray(file)
        colors = np.asarray(file.convert("RGB"))
    assert (colors == image(scene, picture, smooth=1)).all()
    assert (np.unique(words)[indices] == words).all()


def test_an_indexed_png_has_256_words_and_no_more(tmp_path: Path) -> None:
    scene = wall_scene()
    lines, elements = 48, 64
    picture = render(scene, lines, elements)
    (surface,) = {scene.parts[0].surface}
    seen = np.flatnonzero(picture.surface_number)
    for levels in (255, 256):
        # As many intensities as levels, evenly spaced.
        relative = np.zeros(lines * elements, np.float32)
        relative[seen] = np.arange(len(seen)) % levels
        raster = relative.reshape(lines, elements)
        steps = Picture.from_rasters(raster, picture.surface_number, picture.surfaces, 1.0)
        stepped = scene.with_surface(surface, levels=levels)
        assert len(np.unique(display_image(stepped, steps).words)) == levels + 1
        path = tmp_path / f"{levels}.png"
        if levels < MOST_INDEXED:
            save_words(path, stepped, steps, indexed=True)
            with Image.open(path) as file:
                assert (np.asarray(file.convert("RGB")) == image(stepped, steps)).all()
            continue
        with pytest.raises(UsageError) as caught:
            save_words(path, stepped, steps, indexed=True)
        assert str(caught.value) == (
            "an indexed PNG must have at most 256 words in use, not 257; set `levels` of each surface to 255,"
            " or write the words themselves"
        )
        assert not path.exists()


def test_an_indexed_png_of_a_scalar_needs_fewer_bands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(images, "MOST_INDEXED", 9)
    scene = scene_of(cube(), scalar={"name": "z", "bands": 20, "shades": 8})
    with pytest.raises(UsageError, match="choose fewer bands or shades of the scalar, or write"):
        save_words(tmp_path / "z.png", scene, render(scene, 48, 64), indexed=True)
    banded = scene.with_scalar(bands=4, shades=2)
    save_words(tmp_path / "z.png", banded, render(banded, 48, 64), indexed=True)


def test_words_are_never_written_over_a_file_unasked_nor_under_another_suffix(tmp_path: Path) -> None:
    scene = scene_of(cube())
    picture = render(scene, 6, 8)
    save_words(tmp_path / "cube.png", scene, picture)
    with pytest.raises(OutputError, match="exists"):
        save_words(tmp_path / "cube.png", scene, picture)
    save_words(tmp_path / "cube.png", scene, picture, overwrite=True)
    with pytest.raises(UsageError, match=r"words must be written to a file that ends in \.png"):
        save_words(tmp_path / "cube.gif", scene, picture)
