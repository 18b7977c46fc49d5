"""Colors without a display: the image of a picture in the colors of a scene.

A picture knows intensities and no color; here its words look up the entries that a display would hold.
"""

from __future__ import annotations

from os import PathLike

from autocolor.arrays import Bytes
from autocolor.files.writing import write_atomically
from autocolor.lighting.picture import Picture
from autocolor.mapping.display_image import display_image
from autocolor.scene.scene import Scene


def image(scene: Scene, picture: Picture) -> Bytes:
    """The colors of a picture of the scene, (lines, elements, 3) uint8: red, green, blue.

    They are those of a display's field. Raises InputError for intensities that are not finite.
    """
    shown = display_image(scene, picture)
    colors: Bytes = shown.entries[shown.words]
    return colors


def save_image(path: str | PathLike[str], scene: Scene, picture: Picture, *, overwrite: bool = False) -> None:
    """Write the image of a picture to a PNG file, wholly or not at all.

    Raises OutputError where the file exists and may not be overwritten or where none can be, WriteError where
    writing failed.
    """
    from ramtek_emu.png import png_bytes

    write_atomically(path, png_bytes(image(scene, picture)), overwrite=overwrite)
