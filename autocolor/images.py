"""A picture in the colors of a scene, without a studio: on a display, as an array, or in PNG files.

A picture contains intensities but no colors. The colors come from the words and entries of a display image,
which `display_image` makes.
"""

from __future__ import annotations

import dataclasses
import re
from io import BytesIO
from itertools import product
from os import PathLike
from typing import TYPE_CHECKING, Final

import numpy as np

from autocolor.arrays import Bytes, Words, chunks, light_of
from autocolor.checks import is_whole, shown
from autocolor.errors import UsageError
from autocolor.files.writing import check_suffix, refuse_output, write_atomically
from autocolor.lighting.picture import Picture, check_smooth, check_surfaces
from autocolor.mapping.display_image import DisplayImage, LevelImage
from autocolor.mapping.legend import legend
from autocolor.mapping.normal_words import NormalImage
from autocolor.mapping.ranges import FEWEST_LEVELS, WORDS
from autocolor.rendering import SIZE, checked_size, render
from autocolor.scene.scene import NORMALS, Scene, check_scene
from autocolor.sending import configuration_of, send_image, shown_colors
from ramtek_emu import HostPort

if TYPE_CHECKING:
    from PIL.PngImagePlugin import PngInfo


def display_image(
    scene: Scene, picture: Picture, before: DisplayImage | None = None, block: int = 1
) -> DisplayImage:
    """The display image of a scene and its picture, each pixel of which is shown as a block of words.

    Its words stand for levels or for normals, as the scene asks. The words of a picture without normals,
    such as a picture of a file, stand for levels in every scene. Words and entries that did not change are
    shared with the earlier image `before`. Raises InputError if an intensity is not finite.
    """
    kind = NormalImage if scene.words == NORMALS and picture.normals is not None else LevelImage
    return kind.of(scene, picture, before, block)


def send_picture(scene: Scene, picture: Picture, display: HostPort) -> None:
    """Reset a display and show a picture in the colors of a scene; nothing is rendered.

    A picture that is smaller than the display is shown at its upper left. A display cannot average: of each
    square of a smooth picture it shows the pixel in the middle. Raises InputError if the surfaces of the
    picture are not those of the scene, UsageError if it is larger than the display.
    """
    check_surfaces(scene, picture)
    sizes = configuration_of(display)
    width, height = picture.size
    if hasattr(display, "configuration") and (width > sizes.shown_elements or height > sizes.shown_lines):
        raise UsageError(
            f"a picture must be at most {sizes.shown_elements} x {sizes.shown_lines}, as large as the"
            f" display, not {width} x {height}; render it smaller, or take a larger configuration"
        )
    send_image(display, middles(display_image(scene, picture), picture.smooth))


def image(
    scene: Scene,
    picture: Picture | None = None,
    *,
    size: tuple[int, int] | None = None,
    smooth: int | None = None,
) -> Bytes:
    """The picture in the colors of a scene, (lines, elements, 3) uint8: red, green, blue.

    The colors are the same as on a display, without the legend of a scalar. `picture`, `size` and `smooth`
    are as in `save_image`. Raises InputError if an intensity is not finite, or if the surfaces of the picture
    are not those of the scene; UsageError as `save_image`.
    """
    _check(scene, picture)
    picture, smooth = _picture_of(scene, picture, size, smooth)
    shown_image = display_image(scene, picture)
    return averaged(shown_image.entries, shown_image.words, smooth)


def save_image(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture | None = None,
    *,
    size: tuple[int, int] | None = None,
    smooth: int | None = None,
    overwrite: bool = False,
    level: int | None = None,
    sync: bool = True,
) -> None:
    """Write the picture of a scene to a PNG file, atomically, with the legend of a scalar.

        autocolor.save_image("coupe.png", scene)
        autocolor.save_image("large.png", scene, size=(1280, 960), smooth=4)

    Without a legend the file has the colors of `image`. Each of its pixels is the mean of a square of
    `smooth` pixels of the picture a side, so that edges are smooth; with 1 it is the picture of a display.

    Without a `picture` the scene is rendered. `size` is the width and height of the file, by default
    (640, 480), and `smooth` by default 2, and 1 for more than 10 million pixels. A picture has a size of its
    own, and `smooth` is by default the picture's.

    `level` is the compression: from 0, fastest, to 9, smallest, by default `ramtek_emu.png.LEVEL`. With
    `sync=False` the file is not synced to the disk, for programs that write many images: a killed program
    still leaves whole files, but after a power failure a new file may be empty.

    Raises UsageError for wrong arguments, InputError as `render` and if the picture is not the scene's, and
    OutputError or WriteError if the file cannot be written.
    """
    from ramtek_emu.png import png_bytes

    _check(scene, picture)
    check_suffix(path, ".png", "an image")
    check_png_level(level)
    refuse_output(path, overwrite=overwrite)
    picture, smooth = _picture_of(scene, picture, size, smooth)
    data = png_bytes(smoothed(display_image(scene, picture), smooth), level)
    write_atomically(path, data, overwrite=overwrite, sync=sync)


def check_png_level(level: int | None) -> None:
    """Raise UsageError unless the compression of a PNG file is a whole number from 0 to 9, or None."""
    if level is not None and not is_whole(level, 0, 9):
        raise UsageError(
            f"level must be a whole number from 0 to 9, not {shown(level)}; leave it out for the default"
        )


MOST_INDEXED: Final = 256
"""The colors of the palette of a PNG file."""


def save_words(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture,
    *,
    indexed: bool = False,
    overwrite: bool = False,
) -> None:
    """Write the words of a picture, and the entries of a scene's colors, to a PNG file, atomically.

    The file has the lines and elements of the picture: words cannot be averaged, so a smooth picture has
    `smooth` times the lines and elements of its image. The legend of a scalar is left out. The pixels are
    16-bit grays, equal to the words, 0 to 1023; `entry_chunks` says where the 1024 entries are in the file.

    If `indexed`, the pixels are indices of a palette instead. The words in use are numbered from 0, in their
    order, and their entries are the palette. The colors equal `image` with `smooth=1`.

    Raises UsageError for a name that does not end in .png, and if `indexed` and more than 256 words are in
    use; other errors as `save_image`.
    """
    from PIL import Image

    check_surfaces(scene, picture)
    check_suffix(path, ".png", "words")
    shown_image = display_image(scene, picture)
    if indexed:
        is_used = np.bincount(shown_image.words.ravel(), minlength=WORDS) > 0
        if (count := np.count_nonzero(is_used)) > MOST_INDEXED:
            levels = max(FEWEST_LEVELS, (MOST_INDEXED - 1) // len(shown_image.ranges))
            fewer = "" if scene.scalar is None else ", choose fewer bands or shades of the scalar"
            raise UsageError(
                f"an indexed PNG must have at most {MOST_INDEXED} words in use, not {count:,}; set `levels`"
                f" of each surface to {levels}{fewer}, or write the words themselves"
            )
        index_of_word = (np.cumsum(is_used) - 1).astype(np.uint8)
        file, info = Image.fromarray(index_of_word[shown_image.words]), None
        file.putpalette(shown_image.entries[is_used].tobytes())
    else:
        file, info = Image.fromarray(shown_image.words), entry_chunks(shown_image.entries)
    buffer = BytesIO()
    file.save(buffer, "PNG", pnginfo=info)
    write_atomically(path, buffer.getvalue(), overwrite=overwrite)


TABLE: Final = "lookup table"
"""The name of the suggested palette, and the keyword of the text, with the entries of a PNG file of words."""


def entry_chunks(entries: Bytes) -> PngInfo:
    """The chunks of a PNG file of words with all entries, (n, 3) uint8.

    The entries are in the file twice, in the order of their words: as a suggested palette, the chunk `sPLT`,
    which libpng and Java read; and as a text of six hexadecimal digits an entry, the chunk `zTXt`, because
    Pillow skips suggested palettes. Both are named `TABLE`.

    Assumed: a suggested palette must be sorted by falling frequency. All frequencies are 0 here, so the order
    of the words is allowed.
    """
    from PIL.PngImagePlugin import PngInfo

    rows = np.zeros(len(entries), [("color", "u1", 3), ("alpha", "u1"), ("frequency", ">u2")])
    rows["color"], rows["alpha"] = entries, 255
    info = PngInfo()
    info.add(b"sPLT", TABLE.encode("ascii") + b"\0\x08" + rows.tobytes())
    info.add_text(TABLE, entries.tobytes().hex(), zip=True)
    return info


SMOOTHNESSES: Final = (1, 2, 3, 4)
"""What commands and screens offer as `smooth`."""

SMOOTHNESS: Final = 2
"""Assumed: the `smooth` of an image of a scene, unless the user chooses another.

Compared on the coupe, the bracket and the teapot: with 2, the stairs at edges are gone and the dots of thin
lines faint, for three times the time. With 3, the shut lines of the coupe are even, for six times the time,
but 3840 x 2160 pixels exceed the memory budget. With 4, no difference is seen at a glance. The default
of `render` is 1: a picture has the lines and elements that its user asks for.
"""

MOST_SMOOTH_PIXELS: Final = 10_000_000
"""Limit: the pixels of an image that is smooth by default. Four times as many fit in the memory budget."""

PIXELS_AT_ONCE: Final = 1 << 14


def default_smooth(size: tuple[int, int]) -> int:
    """SMOOTHNESS, or 1 for an image of more than MOST_SMOOTH_PIXELS. Raises UsageError for a wrong size."""
    width, height = checked_size(size)
    return SMOOTHNESS if width * height <= MOST_SMOOTH_PIXELS else 1


def _check(scene: Scene, picture: Picture | None) -> None:
    """Raise UsageError unless the scene is a scene; `check_surfaces` also checks a given picture."""
    if picture is None:
        check_scene(scene)
    else:
        check_surfaces(scene, picture)


def _picture_of(
    scene: Scene, picture: Picture | None, size: tuple[int, int] | None, smooth: int | None
) -> tuple[Picture, int]:
    """The picture of a scene and its `smooth`, from the arguments of `save_image`. Raises its errors."""
    if picture is None:
        size = SIZE if size is None else size
        picture = render(scene, size, smooth=default_smooth(size) if smooth is None else smooth)
        return picture, picture.smooth
    if size is not None:
        raise UsageError(
            f"a size must be for a scene without its picture, not for a picture of {picture.elements} x"
            f" {picture.lines} pixels; leave one of them out"
        )
    if smooth is None:
        return picture, picture.smooth
    check_smooth(smooth)
    if picture.lines % smooth or picture.elements % smooth:
        raise UsageError(
            f"the lines and elements of a picture must be multiples of smooth, {smooth}, not {picture.lines}"
            f" and {picture.elements}; render with smooth={smooth}"
        )
    return picture, smooth


def averaged(entries: Bytes, words: Words | Bytes, smooth: int) -> Bytes:
    """The colors of words, averaged as light over squares of `smooth` pixels a side.

    `entries` is the lookup table, (1024, 3) uint8, and `words` (lines, elements) with multiples of `smooth`.
    The colors are (lines // smooth, elements // smooth, 3) uint8, rounded half up.

    Measured: 14 ms for 1280 x 960 words and 28 ms for 2560 x 1920; in one piece they took twice as long.
    Measured and rejected: float32 is no faster, and rounds a thousandth of the components differently.
    """
    if smooth == 1:
        return entries.take(words, axis=0)
    light = light_of(entries.astype(np.float64))
    # The nearest color of each mean is found by the light between two neighbors.
    between = light_of(np.linspace(0.5, 254.5, 255))
    lines, elements = words.shape[0] // smooth, words.shape[1] // smooth
    colors = np.empty((lines, elements, 3), np.uint8)
    for chunk in chunks(lines, max(1, PIXELS_AT_ONCE // elements)):
        squares = words[smooth * chunk.start : smooth * chunk.stop]
        total = np.zeros((chunk.stop - chunk.start, elements, 3))
        for down, across in product(range(smooth), repeat=2):
            total += light.take(squares[down::smooth, across::smooth], axis=0)
        colors[chunk] = np.searchsorted(between, total / smooth**2, side="right")
    return colors


def smoothed(image: DisplayImage, smooth: int) -> Bytes:
    """The colors of a display image, averaged as light over squares of `smooth` pixels a side, uint8.

    The legend of a scalar is drawn at the size of the result.
    """
    if smooth == 1:
        return shown_colors(image)
    colors = averaged(image.entries, image.words, smooth)
    small = middles(image, smooth)
    key = legend(small)
    if key is not None:
        left, top, right, bottom, _ = key.swatches[0]
        area = slice(top, bottom + 1), slice(left, right + 1)
        colors[area] = shown_colors(small)[area]
    return colors


def middles(image: DisplayImage, smooth: int) -> DisplayImage:
    """The image with the word in the middle of each square of `smooth` pixels a side."""
    if smooth == 1:
        return image
    first = smooth // 2
    return dataclasses.replace(image, words=image.words[first::smooth, first::smooth])


LARGEST: Final = 4096
"""The largest width and height that commands and screens take: the size of the largest display memory.

`render` goes up to `LARGEST_RASTER`.
"""


def size_of(text: str) -> tuple[int, int]:
    """The width and the height in the text of a size. Raises UsageError.

    >>> size_of("1280x960")
    (1280, 960)
    """
    match = re.fullmatch(r"([0-9]{1,5})[xX]([0-9]{1,5})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= count <= LARGEST for count in size):
        raise UsageError(
            f"a size must be WIDTHxHEIGHT, each from 1 to {LARGEST}, not {text[:60]!r}; write it as in"
            " 1280x960"
        )
    return size
