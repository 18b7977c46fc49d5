"""Figure 7: the coupe under a single point source light located at the eye."""

from __future__ import annotations

import autocolor
from scenes.figures import Sheet, open_studio, read_scene


def coupe() -> autocolor.Scene:
    """The coupe with one light in the place of four."""
    scene = read_scene("coupe")
    return scene.replace(lights=(autocolor.Light("eye", scene.view.eye),), mapping="gamma")


def main() -> None:
    """Render once."""
    Sheet("07").add(open_studio(coupe()), "Light at Eye")


if __name__ == "__main__":
    main()
