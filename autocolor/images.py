"""A picture in the colors of a scene, without a studio: on a display, as an array, or as a PNG file.

A picture contains intensities but no colors. The colors come from the words and entries of a display image,
which `display_image` makes.
"""

from __future__ import annotations

import dataclasses
import re
from itertools import product
from numbers import Integral
from os import PathLike
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Floats
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.writing import check_suffix, write_atomically
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import DisplayImage, LevelImage
from autocolor.mapping.legend import legend
from autocolor.mapping.normal_words import NormalImage
from autocolor.scene.scene import NORMALS, Scene, check_scene
from autocolor.sending import configuration_of, send_image, shown_colors
from ramtek_emu import HostPort


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

    A picture that is smaller than the display is shown at its upper left. Raises InputError if the surfaces
    of the picture are not those of the scene, UsageError if it is larger than the display.
    """
    check_surfaces(scene, picture)
    sizes = configuration_of(display)
    if hasattr(display, "configuration") and (
        picture.lines > sizes.shown_lines or picture.elements > sizes.shown_elements
    ):
        raise UsageError(
            f"a picture must be at most {sizes.shown_elements} x {sizes.shown_lines}, as large as the"
            f" display, not {picture.elements} x {picture.lines}; render it smaller, or take a larger"
            " configuration"
        )
    send_image(display, display_image(scene, picture))


def image(scene: Scene, picture: Picture) -> Bytes:
    """The picture in the colors of a scene, (lines, elements, 3) uint8: red, green, blue.

    The colors are the same as on a display, without the legend of a scalar. Raises InputError if an intensity
    is not finite, or if the surfaces of the picture are not those of the scene.
    """
    check_surfaces(scene, picture)
    return display_image(scene, picture).colors


def save_image(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture,
    *,
    overwrite: bool = False,
    smooth: int = 1,
) -> None:
    """Write the picture as a display shows it to a PNG file, atomically, with the legend of a scalar.

    Without a legend it has the colors of `image`. With `smooth`, each pixel of the file is the mean of a
    square of `smooth` pixels a side: render the picture with `smooth` times the lines and elements.

        picture = autocolor.render(scene, 4 * 480, 4 * 640)
        autocolor.save_image("coupe.png", scene, picture, smooth=4)   # 640 x 480 pixels

    Raises UsageError for a name that ends as another kind of file does, and if the lines or elements are no
    multiple of `smooth`; OutputError if the file exists and `overwrite` is false, or if it cannot be created;
    WriteError if writing fails.
    """
    from ramtek_emu.png import png_bytes

    check_suffix(path, ".png", "an image")
    check_surfaces(scene, picture)
    _check_smooth(smooth, picture)
    shown_image = display_image(scene, picture)
    colors = shown_colors(shown_image) if smooth == 1 else smoothed(shown_image, smooth)
    write_atomically(path, png_bytes(colors), overwrite=overwrite)


def _check_smooth(smooth: int, picture: Picture) -> None:
    if isinstance(smooth, bool) or not isinstance(smooth, Integral) or smooth < 1:
        raise UsageError(
            f"smooth must be a whole number of at least 1, not {shown(smooth)}; give one such as 4"
        )
    if picture.lines % smooth or picture.elements % smooth:
        raise UsageError(
            f"the lines and elements of a picture must be multiples of smooth, {smooth}, not {picture.lines}"
            f" and {picture.elements}; render {smooth} times as many"
        )


def decoded(codes: Floats) -> Floats:
    """The light of components of sRGB colors, from 0 to 255: 0 to 1.

    Assumed: monitors show colors as sRGB does, IEC 61966-2-1, so light is averaged by its formula. The mean
    of the components themselves would make the edges of bright surfaces too dark.
    """
    shares = codes / 255
    light: Floats = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return light


def smoothed(image: DisplayImage, smooth: int) -> Bytes:
    """The colors of a display image, averaged as light over squares of `smooth` pixels a side, uint8.

    The legend of a scalar is drawn at the size of the result.
    """
    light = decoded(image.entries.astype(np.float64))
    small = dataclasses.replace(image, words=image.words[::smooth, ::smooth])
    total = np.zeros((*small.words.shape, 3))
    for down, across in product(range(smooth), repeat=2):
        total += light[image.words[down::smooth, across::smooth]]
    # The nearest color of each mean is found by the light between two neighbors.
    between = decoded(np.linspace(0.5, 254.5, 255))
    colors = np.searchsorted(between, total / smooth**2, side="right").astype(np.uint8)
    key = legend(small)
    if key is not None:
        left, top, right, bottom, _ = key.swatches[0]
        area = slice(top, bottom + 1), slice(left, right + 1)
        colors[area] = shown_colors(small)[area]
    return colors


LARGEST: Final = 4096
"""The most elements and lines of an image: the size of the largest display memory.

`render` goes up to `LARGEST_RASTER`.
"""


def size_of(text: str) -> tuple[int, int]:
    """The elements and the lines in the text of a size. Raises UsageError.

    >>> size_of("1280x960")
    (1280, 960)
    """
    match = re.fullmatch(r"([0-9]{1,5})[xX]([0-9]{1,5})", text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= count <= LARGEST for count in size):
        raise UsageError(
            f"a size must be ELEMENTSxLINES, each from 1 to {LARGEST}, not {text[:60]!r}; write it as in"
            " 1280x960"
        )
    return size


def check_surfaces(scene: Scene, picture: Picture) -> None:
    """Raise InputError if the surfaces of a picture are not those of a scene, in the same order.

    Raises UsageError for anything else than a scene and a picture, such as the two in the wrong order.
    """
    check_scene(scene)
    if not isinstance(picture, Picture):
        raise UsageError(f"a picture must be a Picture, not {shown(picture)}; `render` makes one of a scene")
    names = [surface.name for surface in scene.surfaces]
    if list(picture.surfaces) != names:
        raise InputError(
            f"the surfaces of a picture must be those of the scene, {shown(names)}, not"
            f" {shown(list(picture.surfaces))}; render this scene, or use the scene that was rendered"
        )
