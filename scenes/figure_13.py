"""Figure 13: the color mixing screen, with the two colors of the body and the blend bar between them."""

from __future__ import annotations

from scenes.figures import Sheet, click, open_viewer


def main() -> None:
    """Mix a blue paint on the bars of the object color, and let the white of the light source begin lower."""
    sheet = Sheet("13")
    with open_viewer("coupe", "mixing") as (viewer, display):
        for component, share in (("red", 0.18), ("green", 0.30), ("blue", 0.62)):
            click(viewer, f"object, {component}", share)
        click(viewer, "blend bar", 0.45)
        sheet.add(display.field(), "Color Mixing")


if __name__ == "__main__":
    main()
