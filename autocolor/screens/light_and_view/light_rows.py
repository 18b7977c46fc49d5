"""The rows of the eye and the lights in the menu, and of what cannot be pointed at of the chosen light."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from autocolor.screens.lights.light_parameters import parameter_rows
from autocolor.screens.picture.picture_edits import PictureEdits
from autocolor.screens.session import Session
from autocolor.widgets.widget import Button, Gap, Switch, Widget

COLUMNS: Final = ("concentration", "cone_angle", "flaps")
"""The columns that have rows beside the kind; others are pointed at, or on the lights screen."""


def light_rows(
    session: Session, edits: PictureEdits, chosen: str, choose: Callable[[str], object]
) -> list[Widget]:
    """The rows of the eye and of all lights, with their numbers in the views, and those of a chosen light.

    `chosen` is the name of a light, or empty for the eye; `choose` is called with another one.
    """
    found: list[Widget] = [
        Button(
            "eye",
            "Choose the eye: its target can be taken hold of where the aim of a light is, too.",
            run=partial(choose, ""),
            is_chosen=not chosen,
        )
    ]
    for number, light in enumerate(session.scene.lights, start=1):
        found.append(
            Switch(
                f"{number} {light.name}",
                f"Switch light {light.name} on or off; beside the box: choose it.",
                is_on=light.on,
                flip=partial(edits.switch_light, number - 1),
                choose=partial(choose, light.name),
                is_chosen=light.name == chosen,
            )
        )
    if chosen:
        light = session.scene.light(chosen)
        others = [name for name in vars(light) if name not in COLUMNS]
        found += [Gap("light gap"), *parameter_rows(session, light, others)]
    return found
