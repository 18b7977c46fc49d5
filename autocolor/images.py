"""A picture in the colors of a scene, without a studio: on a display, as an array, or as a PNG file.

A picture contains intensities but no colors. The colors come from the words and entries of a display image,
which `display_image` makes.
"""

from __future__ import annotations

from os import PathLike

from autocolor.arrays import Bytes
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.writing import check_suffix, write_atomically
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import DisplayImage, LevelImage
from autocolor.mapping.normal_words import NormalImage
from autocolor.scene.scene import NORMALS, Scene, check_scene
from autocolor.sending import configuration_of, send_image, shown_colors
from ramtek_emu import HostPort


def display_image(
    scene: Scene, picture: Picture, before: DisplayImage | None = None, block: int = 1
) -> DisplayImage:
    """The display image of a scene and its picture, each pixel of which is shown as a block of words.

    Its words stand for levels or for normals, as the scene asks. The words of a picture without normals,
    such as a picture of a file, stand for levels in every scene. Whatever did not change is shared with the
    earlier image `before`. Raises InputError if an intensity is not finite.
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


def save_image(path: str | PathLike[str], scene: Scene, picture: Picture, *, overwrite: bool = False) -> None:
    """Write the picture as a display shows it to a PNG file, atomically, with the legend of a scalar.

    Without a legend it has the colors of `image`.

    Raises UsageError for a name that ends as another kind of file does; OutputError if the file exists and
    `overwrite` is false, or if it cannot be created; WriteError if writing fails.
    """
    from ramtek_emu.png import png_bytes

    check_suffix(path, ".png", "an image")
    check_surfaces(scene, picture)
    write_atomically(path, png_bytes(shown_colors(display_image(scene, picture))), overwrite=overwrite)


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
