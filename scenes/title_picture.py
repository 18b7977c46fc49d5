"""The picture at the head of the README: `python -m scenes.title_picture` writes `docs/coupe.png`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ramtek_emu.png import save_png
from scenes.figures import open_scene

PICTURE = Path(__file__).parents[1] / "docs" / "coupe.png"


def main() -> None:
    """Render once, and show the picture in two paints, side by side."""
    studio, display = open_scene("coupe")
    red = display.field()
    studio.recolor("body", object_color="#1f3f8f", blend=0.5)
    PICTURE.parent.mkdir(exist_ok=True)
    save_png(np.hstack([red, display.field()]), PICTURE)


if __name__ == "__main__":
    main()
