"""The moving picture of the README, docs/recolor.webp: `python -m scenes.title_picture` writes it.

It has the coupe in several paints, above the lookup table. The picture is rendered once: between two
frames, only entries of the table differ.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

import autocolor
from autocolor.arrays import Bytes
from autocolor.files.settings import scene_with
from autocolor.images import averaged, display_image
from autocolor.mapping.ranges import WORDS
from ramtek_emu.films import write_film

PATH: Final = Path(__file__).parents[1] / "docs" / "recolor.webp"

COLORS_OF_FILM: Final = ("#e8142a", "#1c46d0", "#c8ccd4", "#0c7040", "#e8142a")
FRAMES: Final = 14
RATE: Final = 5.0
"""The object colors of the body, one after the other; frames, and frames a second."""

LINES: Final = 480
ELEMENTS: Final = 640
STRIP: Final = 20
"""Lines of the strip with the table, below the picture."""


def recolored() -> list[Bytes]:
    """The frames of the moving picture: the coupe in several paints, above the lookup table."""
    scene = autocolor.demo()
    picture = autocolor.render(scene, (ELEMENTS, LINES), smooth=2)
    paints = [{"surfaces.body.object_color": color} for color in COLORS_OF_FILM]
    shown = np.arange(ELEMENTS) * WORDS // ELEMENTS
    image, frames = display_image(scene, picture), []
    for frame in autocolor.frames(scene, paints, FRAMES):
        image = display_image(scene_with(scene, frame.settings), picture, image)
        colors = averaged(image.entries, image.words, picture.smooth)
        strip = np.broadcast_to(image.entries[shown], (STRIP, ELEMENTS, 3))
        frames.append(np.vstack([colors, strip]))
    return frames


def main() -> None:
    """Write the moving picture."""
    frames = recolored()
    write_film(PATH, frames, fields_per_second=RATE, overwrite=True)


if __name__ == "__main__":
    main()
