"""Figure 4: light direction and concentration, on a pyramid that stands on a plane."""

from __future__ import annotations

from typing import Any, Final

from scenes.figures import Sheet, open_studio, read_scene

SIDE = (0.5, 0.0, 0.9)
"""A point of the pyramid's lit side."""

SHOWN: Final[dict[str, Any]] = {"ambient": 0.2, "contrast": "floor", "mapping": "gamma"}
"""The sides and the plane can be seen where only the ambient light reaches."""


def main() -> None:
    """Render once, then aim the one light and concentrate it."""
    studio = open_studio(read_scene("pyramid").replace(**SHOWN))
    sheet = Sheet("04")
    sheet.add(studio, "A. Point Source", "a")
    studio.light("lamp", aim=SIDE, concentration=1)
    sheet.add(studio, "B. Directed Flood, C = 1", "b")
    studio.light("lamp", concentration=40)
    sheet.add(studio, "C. Directed Spot, C = 40", "c")
    sheet.write(across=3)


if __name__ == "__main__":
    main()
