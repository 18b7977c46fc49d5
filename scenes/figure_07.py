"""Figure 7: the coupe under a single point source light located at the eye."""

from __future__ import annotations

from typing import Any, Final

import autocolor
from scenes.figures import Sheet, open_studio, read_scene

SHOWN: Final[dict[str, Any]] = {
    "scaling": "object",
    "mapping": ((0.0, 0.0), (0.3, 0.42), (0.6, 0.7), (1.0, 1.0)),
}
"""How even light is shown: dark glass stays dark, and the sides that are turned away are not too dark."""


def coupe() -> autocolor.Scene:
    """The coupe with one light in the place of four."""
    scene = read_scene("coupe")
    return scene.replace(lights=(autocolor.Light("eye", scene.view.eye),), **SHOWN)


def main() -> None:
    """Render once."""
    Sheet("07").add(open_studio(coupe()), "Light at Eye")


if __name__ == "__main__":
    main()
