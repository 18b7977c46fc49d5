"""The rows of a light's half-spaces: of each its switch, its edge width, who carries it, turn and remove."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from autocolor.scene.columns.column import fields_of
from autocolor.scene.lights.carried import set_down, taken_up
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.light import Light
from autocolor.screens.lights.plane_picking import POINTS, PlanePicking, turned
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Switch, Widget


@dataclass(frozen=True)
class VerbsOf(Pair):
    """Two buttons for a thing `of` which there may be others on the screen."""

    of: str = ""

    @property
    def key(self) -> str:
        return f"{self.label} {self.of}"


def half_space_rows(session: Session, light: Light, picking: PlanePicking) -> list[Widget]:
    """The rows of all half-spaces of a light, after the one that adds another."""
    rows: list[Widget] = [
        Button(
            "half spaces",
            "Pick no more points." if picking.is_on else "Pick three points of a plane that ends the light.",
            run=picking.end if picking.is_on else picking.begin,
            value=f"{picking.count}/{POINTS}" if picking.is_on else "add",
            is_chosen=picking.is_on,
        )
    ]
    for half_space in light.half_spaces:
        rows += _rows_of(session, light, half_space)
    return rows


def _rows_of(session: Session, light: Light, half_space: HalfSpace) -> list[Widget]:
    name = half_space.name
    helps = {key: field.column.help for key, field in fields_of(HalfSpace).items()}
    usual = session.world.range_of_lengths(is_zero_left_out=False)

    def put(**changes: object) -> None:
        session.change_light(light.name, half_spaces={name: changes})  # type: ignore[dict-item]

    return [
        Switch(name, helps["on"], is_on=half_space.on, flip=lambda: put(on=not half_space.on)),
        Bar(
            f"{name} width",
            helps["edge_width"],
            value=half_space.edge_width,
            low=usual.low,
            high=usual.high,
            step=usual.step,
            put=lambda width: put(edge_width=width),
        ),
        Switch(
            f"{name} carried",
            helps["carried"],
            is_on=half_space.carried,
            flip=partial(_carry, session, light, half_space),
        ),
        VerbsOf(
            "turn",
            f"The other side of {name} is lit; or take it away.",
            run=partial(_put_row, session, light, turned(half_space)),
            other="remove",
            run_other=partial(_remove, session, light, name),
            of=name,
        ),
    ]


def _carry(session: Session, light: Light, half_space: HalfSpace) -> None:
    """Let a light carry a half-space, or no more; its plane stays where it is."""
    there = session.scene.light_in_world(light.name)
    carry = set_down if half_space.carried else taken_up
    _put_row(session, light, carry(half_space, there))


def _put_row(session: Session, light: Light, half_space: HalfSpace) -> None:
    session.change_light(light.name, half_spaces={half_space.name: half_space})


def _remove(session: Session, light: Light, name: str) -> None:
    session.change_light(light.name, half_spaces={name: None})
    session.tell(f"half-space {name} removed; undo brings it back")
