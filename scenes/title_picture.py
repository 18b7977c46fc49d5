"""The pictures of the first pages: `python -m scenes.title_picture` writes three files of docs/.

recolor.webp, the moving picture of the README, has the coupe in several paints, above the lookup table. The
picture is rendered once: between two frames, only entries of the table differ. coupe.png and bracket.png show
one scene each in two ways.
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
from ramtek_emu import Ramtek9300
from ramtek_emu.films import write_film
from ramtek_emu.png import save_png
from scenes.figure_part import COLORS, EXPOSURE, STRESS
from scenes.figures import open_studio, read_scene

FOLDER: Final = Path(__file__).parents[1] / "docs"

COLORS_OF_FILM: Final = ("#b01020", "#2348c8", "#c9ced6", "#11603a", "#b01020")
FRAMES: Final = 24
RATE: Final = 8.0
"""The object colors of the body, one after the other; frames, and frames a second."""

LINES: Final = 300
ELEMENTS: Final = 400
STRIP: Final = 20
"""Lines of the strip with the table, below the picture."""


def recolored() -> list[Bytes]:
    """The frames of the moving picture: the coupe in several paints, above the lookup table."""
    scene = autocolor.demo()
    picture = autocolor.render(scene, lines=LINES, elements=ELEMENTS, smooth=2)
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
    """Write the moving picture, and two pictures of scenes that are shown in two ways, side by side."""
    FOLDER.mkdir(exist_ok=True)
    frames = recolored()
    write_film(FOLDER / "recolor.webp", frames, len(frames), fields_per_second=RATE, overwrite=True)
    display = Ramtek9300()
    coupe = open_studio(read_scene("coupe"), display)
    red = display.field()
    coupe.recolor("body", object_color="#2348c8", blend=0.6)
    save_png(np.hstack([red, display.field()]), FOLDER / "coupe.png")
    bracket = open_studio(read_scene("bracket"), display)
    metal = display.field()
    bracket.edit(bracket.scene.replace(exposure=EXPOSURE))
    bracket.scalar(**STRESS, scale=COLORS, shades=20)
    save_png(np.hstack([metal, display.field()]), FOLDER / "bracket.png")


if __name__ == "__main__":
    main()
