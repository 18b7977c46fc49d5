"""The small switches of the chosen light's flaps, at the end of their lines in the three views."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, Final

from autocolor.scene.lights.light import Light
from autocolor.screens.light_and_view.light_marks import flap_marks
from autocolor.screens.light_and_view.orthographic_views import AXES, SIDES, OrthographicViews
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import NIGHT, WHITE, YELLOW
from autocolor.widgets.items import Item
from autocolor.widgets.widget import Place, Switch, box_items

BOX: Final = 7
"""Elements and lines of a switch."""


class FlapSwitch(Switch):
    """The small box of a flap's switch."""

    def items(self, lit: bool) -> list[Item]:
        return box_items(self.area, self.is_on, WHITE if lit else YELLOW, NIGHT)

    def pick(self, place: Place) -> object:
        return self.flip()


def flap_switches(
    views: OrthographicViews, light: Light, put: Callable[[Mapping[str, Any]], object]
) -> Iterator[FlapSwitch]:
    """The switches of a light; `put` is called with what is changed.

    Each stands within its view: above the right end of a level line, to the right of the lower end of an
    upright one, or to the left where there is no room.
    """
    for side in SIDES:
        for mark in flap_marks(views, side, light):
            axis, on = AXES[mark.axis], mark.on
            right, bottom = (round(each) for each in mark.stroke[0, 2:])
            left = right + 2
            if left + BOX - 1 > side.area.right:
                left = right - BOX - 1
            top = max(bottom - BOX - 1, side.area.top)
            yield FlapSwitch(
                f"{light.name}: flap {axis}, {mark.end}, {side.name}",
                f"Switch flap {axis} of {light.name} {'off' if on else 'on'}.",
                area=Area(left, top, left + BOX - 1, top + BOX - 1),
                is_on=on,
                flip=partial(put, {"flaps": {axis: {"on": not on}}}),
            )
