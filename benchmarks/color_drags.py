"""From a movement of the pointer to its field, while a color or a blend of the coupe is dragged."""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np

import autocolor
from autocolor.screens.viewer import Viewer
from benchmarks.cases import Spread, spread
from benchmarks.points import COUPE
from ramtek_emu import Ramtek9300


class ColorDrag(NamedTuple):
    """A widget of a screen, and whether it is dragged along its elements or along its lines."""

    screen: str
    widget: str
    upright: bool = False


COLOR_BAR = ColorDrag("mixing", "object, red")
BLEND_BAR = ColorDrag("mixing", "blend bar")
UPRIGHT_BAR = ColorDrag("blending", "blend level", upright=True)


def color_drag_seconds(drag: ColorDrag, rounds: int = 100) -> Spread:
    """Seconds from each movement of a drag to the field that shows it."""
    display = Ramtek9300()
    viewer = Viewer(autocolor.read_scene(COUPE), display)
    viewer.session.turn_to(drag.screen)
    viewer.tell("")
    field = np.zeros((480, 640), np.uint32)
    area = next(each for each in viewer.board.widgets() if each.key == drag.widget).area
    element, line = (area.left + area.right) // 2, (area.top + area.bottom) // 2
    viewer.on_pointer(element, line, "press", 1)
    seconds = []
    for step in range(rounds):
        away = 4 + 3 * step % 97
        begin = time.perf_counter()
        viewer.on_pointer(element + away * (not drag.upright), line + away * drag.upright, "move")
        display.scan_out.scan_out_into(field)
        seconds.append(time.perf_counter() - begin)
    # The first ones begin the drag, and look for the lines that have the surface.
    return spread(seconds[rounds // 10 :])
