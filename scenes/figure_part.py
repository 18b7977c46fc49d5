"""A machined part, and the stress in it: the other use of the paper's program, which has no figure there.

Paper: "Introduction": automotive parts, to see complex shapes; color coded scalar values such as stress.
"""

from __future__ import annotations

from typing import Any, Final

from scenes.figures import Sheet, fine_display, open_studio, read_scene

COLORS: Final = ("#3d6fb4", "#4aa5c9", "#7cc9a2", "#cfe07a", "#f3cd58", "#ec8a3a", "#cc3526")
"""From no stress to the most: all light enough for the shading to be seen in each."""

STRESS: Final[dict[str, Any]] = {"name": "stress", "limits": (0.0, 150.0), "bands": 15}
"""In MPa. At the bolt holes and the top of the rib 52 nodes have up to 188, and are in the last band."""

EXPOSURE: Final = {"cast": (0.4, 1.25), "machined": (0.3, 1.3), "floor": (0.0, 0.6)}
"""Brighter than for gray metal: the shades of a color end with that color, and not with a highlight."""


def main() -> None:
    """Render once; the scalar is found in the picture, and then only levels and entries are made anew."""
    display = fine_display()
    studio = open_studio(read_scene("bracket"), display)
    sheet = Sheet("part")
    sheet.add(studio, "A. A Machined Part", "a")
    studio.edit(studio.scene.replace(exposure=EXPOSURE))
    studio.scalar(**STRESS, scale=COLORS, shades=20)
    sheet.add(studio, "B. Stress in MPa, 15 Bands of 20 Shades", "b")
    words_written = display.frame_buffer.written
    studio.scalar(scale="viridis")
    assert display.frame_buffer.written == words_written
    sheet.add(studio, "C. Another Color Scale, No Word Written", "c")
    studio.scalar(scale=COLORS, shades=1)
    sheet.add(studio, "D. Flat Color Codes", "d")
    sheet.write(across=2)


if __name__ == "__main__":
    main()
