"""Color images of a picture without a display.

A picture contains intensities but no colors; the colors come from the lookup table that a display would hold.
"""

from __future__ import annotations

from os import PathLike

from autocolor.arrays import Bytes
from autocolor.files.writing import check_suffix, write_atomically
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import check_surfaces, display_image
from autocolor.scene.scene import Scene
from autocolor.sending import shown_colors


def image(scene: Scene, picture: Picture) -> Bytes:
    """The picture in the colors of a scene, (lines, elements, 3) uint8: red, green, blue.

    The colors are the same as on a display, without the legend of a scalar. Raises InputError if an intensity
    is not finite, or if the surfaces of the picture are not those of the scene.
    """
    check_surfaces(scene, picture)
    return display_image(scene, picture).colors


def save_image(path: str | PathLike[str], scene: Scene, picture: Picture, *, overwrite: bool = False) -> None:
    """Write what a display shows of the picture to a PNG file, atomically: with the legend of a scalar.

    Without a legend it is the same as `image`.

    Raises UsageError for a name that ends as another kind of file does; OutputError if the file exists and
    `overwrite` is false, or if it cannot be created; WriteError if writing fails.
    """
    from ramtek_emu.png import png_bytes

    check_suffix(path, ".png", "an image")
    check_surfaces(scene, picture)
    write_atomically(path, png_bytes(shown_colors(display_image(scene, picture))), overwrite=overwrite)
