"""Figure 7: the coupe under a single point source light located at the eye."""

from __future__ import annotations

import autocolor
from scenes.figures import Sheet, open_scene


def main() -> None:
    """Render once, with one light in the place of four."""
    studio, display = open_scene("coupe")
    at_eye = autocolor.Light("eye", studio.scene.view.eye)
    studio.edit(studio.scene.replace(lights=(at_eye,)))
    sheet = Sheet("07")
    sheet.add(display.field(), "Light at Eye")


if __name__ == "__main__":
    main()
