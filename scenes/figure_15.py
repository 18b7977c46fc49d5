"""Figure 15: dynamic light blending. One picture, three tables, only the body's entries differ."""

from __future__ import annotations

from typing import Any, Final

from scenes.figures import Sheet, fine_display, open_studio, read_scene

COLORS: Final[dict[str, Any]] = {"object_color": "#a80c24", "light_color": "#ff9480"}
"""The same two colors in all three: a deep red, and the copper of the flakes that catch the light."""

METALLIC: Final = ((0.0, 0.0), (0.25, 0.19), (0.5, 0.44), (0.75, 0.76), (1.0, 1.0))
"""Metallic paint is dark away from the highlight: a curve that lowers the middle of the range."""

PANELS = (
    ("a", 1.0, "A. Object Color Only"),
    ("b", 0.5, "B. Blend at Half the Range"),
    ("c", 0.0, "C. Blend at the Lowest Level"),
)


def main() -> None:
    """Render once; then every panel is one range of the lookup table, and no word is written."""
    display = fine_display()
    studio = open_studio(read_scene("coupe").replace(mapping=METALLIC), display)
    words_written = display.frame_buffer.written
    sheet = Sheet("15")
    for panel, blend, caption in PANELS:
        studio.recolor("body", **COLORS, blend=blend)
        sheet.add(studio, caption, panel)
    assert display.frame_buffer.written == words_written
    sheet.write(across=3)


if __name__ == "__main__":
    main()
