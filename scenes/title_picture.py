"""The pictures of the README: `python -m scenes.title_picture` writes docs/coupe.png and docs/bracket.png."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from ramtek_emu import Ramtek9300
from ramtek_emu.png import save_png
from scenes.figure_part import COLORS, EXPOSURE, STRESS
from scenes.figures import open_studio, read_scene

FOLDER: Final = Path(__file__).parents[1] / "docs"


def main() -> None:
    """Write two pictures, each of a scene that is rendered once and shown in two ways, side by side."""
    FOLDER.mkdir(exist_ok=True)
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
