"""Words that stand for normals: a light that moves by loads of the table alone; the paper only names this.

Paper: reference 2, D. H. Bass, 1981, "Using the video lookup table for reflectivity calculations".

`python -m scenes.figure_normals FOLDER --stream` also records what a display is sent while the light circles
the car once: first the picture, then a load of the table for each step. To play it:
`ramtek play FOLDER/figure-normals.ramtek --loads-per-second 30`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

import autocolor
from autocolor.mapping.normal_words import NormalImage
from ramtek_emu import Ramtek9300, Recorder, instructions
from scenes.figures import Sheet, fine_display, open_studio, parser_of_figure, read_scene

STEPS: Final = 120
"""The loads of one round of the light."""

START: Final = 38.0
"""Where the light stands first, in degrees from +x around the car."""

SHOWN: Final[dict[str, Any]] = {"scaling": "surface", "ambient": 0.08}


def position(angle: float) -> tuple[float, float, float]:
    """A place of the light on its circle, in meters, so far away that the car is small beside that."""
    turn = math.radians(angle)
    return 300.0 * math.cos(turn), 300.0 * math.sin(turn), 120.0


def coupe() -> autocolor.Scene:
    """The coupe, seen from far away under a light that can circle it, and a fixed one.

    The eye and the lights are so far away because normals cannot tell that they are near.
    """
    scene = read_scene("coupe")
    lights = (
        autocolor.Light("circling", position(START), 1.0),
        autocolor.Light("front", (-300.0, -200.0, 200.0), 0.55),
    )
    view = scene.view.replace(eye=(-110.4, -83.6, 28.0), field_of_view=1.5)
    return scene.replace(lights=lights, view=view, **SHOWN).with_surface("stage", light_color="#5c6670")


def angles() -> Iterator[float]:
    """The angles of the light on its round, which ends where it begins."""
    return (START + 360.0 * step / STEPS for step in range(1, STEPS + 1))


def main() -> None:
    """Show pictures by levels and by normals, and the normals; then move the light by loads alone."""
    parser = parser_of_figure("normals")
    parser.add_argument("--stream", action="store_true", help="also record a round of the light as a stream")
    arguments = parser.parse_args()
    sheet = Sheet("normals", arguments)
    display = fine_display()
    studio = open_studio(coupe(), display)
    sheet.add(studio, "A. Words Stand for Levels", "a")
    studio.normals()
    sheet.add(studio, "B. Words Stand for Normals", "b")
    show_normals(studio, display)
    sheet.add(sheet.panel_of(display), "C. The Normals", "c")
    studio.send_everything()
    words_written = display.frame_buffer.written
    studio.light("circling", position=position(START - 84))
    sheet.add(studio, "D. The Light Moved by One Load", "d")
    assert display.frame_buffer.written == words_written
    studio = open_studio(read_scene("pyramid").replace(contrast="floor"))
    sheet.add(studio, "E. Flat Faces, Levels", "e")
    studio.normals()
    sheet.add(studio, "F. One Normal Each", "f")
    sheet.write(across=3)
    if arguments.stream:
        record(sheet.folder / "figure-normals.ramtek")


def show_normals(studio: autocolor.Studio, display: Ramtek9300) -> None:
    """Load each word's normal as its color: red to the right, green upward, blue to the eye."""
    image = studio.display_image
    assert isinstance(image, NormalImage)
    stand_for = image.normals
    right, down, forward = stand_for.normals
    colors = np.zeros((1024, 3), np.uint8)
    colors[stand_for.words] = np.stack([right, -down, -forward], axis=1) * 127 + 128
    display.send(instructions.load_entries(0, colors))


def record(path: Path) -> None:
    """Record one round of the light."""
    with path.open("wb") as file:
        studio = autocolor.Studio(coupe().replace(words="normals"), Recorder(file))
        for angle in angles():
            studio.light("circling", position=position(angle))
    print(path)


if __name__ == "__main__":
    main()
