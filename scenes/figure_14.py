"""Figure 14: the light blending screen, whose upright bar chooses the level where the blend begins."""

from __future__ import annotations

from scenes.figures import Sheet, click, open_viewer


def main() -> None:
    """Pick a level in the lower half of the bar: the words of the picture stay."""
    sheet = Sheet("14")
    with open_viewer("coupe", "blending") as (viewer, display):
        click(viewer, "blend level", 0.3)
        sheet.add(display.field(), "Blended Image")


if __name__ == "__main__":
    main()
