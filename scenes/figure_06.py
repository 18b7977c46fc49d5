"""Figure 6: the coupe under its four studio lights."""

from __future__ import annotations

from scenes.figures import Sheet, open_scene


def main() -> None:
    """Render once."""
    studio = open_scene("coupe")
    sheet = Sheet("06")
    names = ", ".join(light.name for light in studio.scene.lights)
    sheet.add(studio, f"Four Lights: {names}")


if __name__ == "__main__":
    main()
