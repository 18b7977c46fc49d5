"""The rows of the lights in the menu: a switch for each, and what cannot be pointed at of the chosen one."""

from __future__ import annotations

from functools import partial
from typing import Final

from autocolor.screens.light_parameters import parameter_rows
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.session import Session
from autocolor.widgets.widget import Gap, Switch, Widget

COLUMNS: Final = ("concentration", "cone_angle", "flaps")
"""The columns that have rows beside the kind; others are pointed at, or on the lights screen."""


def light_rows(session: Session, edits: PictureEdits) -> list[Widget]:
    """The rows of all lights, with the numbers that stand in the views, and those of the chosen one."""
    light = session.chosen_light
    found: list[Widget] = [
        Switch(
            f"{number} {each.name}",
            f"Switch light {each.name} on or off; beside the box: choose it.",
            is_on=each.on,
            flip=partial(edits.switch_light, number - 1),
            choose=partial(session.choose_light, each.name),
            is_chosen=each is light,
        )
        for number, each in enumerate(session.scene.lights, start=1)
    ]
    if light is not None:
        others = [name for name in vars(light) if name not in COLUMNS]
        found += [Gap("light gap"), *parameter_rows(session, light, others)]
    return found
