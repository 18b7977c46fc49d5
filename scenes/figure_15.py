"""Figure 15: dynamic light blending. One picture, three tables, only the body's entries differ."""

from __future__ import annotations

from typing import Any, Final

from scenes.figures import Sheet, open_scene

COLORS: Final[dict[str, Any]] = {"object_color": "#960c1c", "light_color": "#ffdccc"}
"""The same two colors in all three: a deep red, and a lamp's warm white."""

PANELS = (
    ("a", 1.0, "A. Object Color Only"),
    ("b", 0.5, "B. Blend at Half the Range"),
    ("c", 0.0, "C. Blend at the Lowest Level"),
)


def main() -> None:
    """Render once; then every panel is one range of the lookup table, and no word is written."""
    studio, display = open_scene("coupe")
    words_written = display.frame_buffer.written
    sheet = Sheet("15")
    for panel, blend, caption in PANELS:
        studio.recolor("body", **COLORS, blend=blend)
        sheet.add(display.field(), caption, panel)
    assert display.frame_buffer.written == words_written
    sheet.write(across=3)


if __name__ == "__main__":
    main()
