"""Figure 5: the light and view screen, where the lights and the view of Figure 6 are set."""

from __future__ import annotations

from autocolor.screens.light_and_view.orthographic_views import PICTURE_AREA
from scenes.figures import Sheet, click_at, open_viewer, point_at


def main() -> None:
    """Display the view as a mesh beside the views of the object."""
    sheet = Sheet("05")
    with open_viewer("coupe", "light and view") as (viewer, display):
        click_at(viewer, PICTURE_AREA.right, PICTURE_AREA.bottom)
        # The message line tells the place of the first light.
        name = viewer.studio.scene.lights[0].name
        light = next(each for each in viewer.board.content.handles if each.label.startswith(f"{name}: x"))
        point_at(viewer, light.element, light.line)
        sheet.add(display.field(), "Light and View Selection")


if __name__ == "__main__":
    main()
