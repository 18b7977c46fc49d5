"""The scalar screen: which scalar colors the surfaces, its color scale, its bands and its limits.

Paper: "Introduction": scalar variables such as stress on the surface of an object, in color. Everything is
set by pointing, and only another scalar computes values again; another color scale sends entries alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from autocolor.checks import Color
from autocolor.mapping.bands import colored_surfaces, own_limits
from autocolor.mapping.legend import CORNERS
from autocolor.scene.color_scales import COLOR_SCALES, REVERSED
from autocolor.scene.kinds import in_digits
from autocolor.scene.scalar import Scalar
from autocolor.screens.picture.over_picture import OverPicture, surface_row
from autocolor.screens.screen import Content, Surroundings
from autocolor.widgets.bars import Bar, bar_within
from autocolor.widgets.rows import NONE, rows_of
from autocolor.widgets.widget import Button, Choice, Gap, Switch, Widget

ZEBRA: Final = "zebra"
"""The name of a computed scalar, and of the scale that it is for."""

OWN_COLORS: Final = "own colors"
COMPUTED_WITH: Final[Mapping[str, Sequence[str]]] = {
    "direction": ("distance", "slope", "draft angle", "zebra"),
    "stripes": ("zebra",),
}
"""The columns that only some computed scalars use, and the names of these scalars."""

WITH_ROWS: Final = ("name", "limits", "scale", "below", "above", "missing", "surfaces")
"""The columns that have rows of their own here."""


class ScalarScreen(OverPicture):
    """The scalar of the scene, over the picture."""

    name = "scalar"
    title = "scalar"
    word = "scalar"
    help = "Surfaces in the colors of a scalar; click in the picture: its value there"

    def build(self, around: Surroundings) -> Content:
        return replace(super().build(around), rows=self._rows)

    def _rows(self) -> Sequence[Widget]:
        scene, scalar, session = self.session.scene, self.session.scene.scalar, self.session
        choice = Choice(
            "scalar",
            "The scalar that colors the surfaces: a scalar of the mesh, or a computed scalar.",
            names=(NONE, *scene.scalar_names),
            present=NONE if scalar is None else scalar.name,
            choose=self._choose,
        )
        if scalar is None:
            return [choice]
        is_computed = scalar.name not in {each.name for each in scene.mesh.scalars}
        unused = [key for key, names in COMPUTED_WITH.items() if not (is_computed and scalar.name in names)]
        is_placed = scalar.legend_place is not None
        scale = scalar.scale if isinstance(scalar.scale, str) else OWN_COLORS
        base = scale.removesuffix(REVERSED)
        end = scale.removeprefix(base)
        name, colored = session.surface_name, colored_surfaces(scene)
        wanted = [row.name for row in scene.surfaces if row.name in {*colored} ^ {name}]
        beyond = "The color of values {} the limits; none: the color of the {} band."
        return [
            choice,
            Gap("scale gap"),
            Choice(
                "scale",
                "The colors of the bands; only entries are sent.",
                names=tuple(each for each in COLOR_SCALES if not each.endswith(REVERSED)),
                present=base,
                choose=lambda chosen: self._put({"scale": chosen + end}),
            ),
            Switch(
                "reversed",
                "Let the scale run from its last color to its first.",
                "" if scale != OWN_COLORS else "the scale is a list of colors; choose one with a name first",
                is_on=bool(end),
                flip=lambda: self._put({"scale": base if end else base + REVERSED}),
            ),
            Gap("limits gap"),
            *self._limit_rows(scalar),
            self._color_row("below", beyond.format("below", "first"), scalar.below, (NONE, *NAMED)),
            self._color_row("above", beyond.format("above", "last"), scalar.above, (NONE, *NAMED)),
            self._color_row("missing", "The color where there is no value.", scalar.missing, tuple(NAMED)),
            Gap("bands gap"),
            *rows_of(scalar, self._put, session.world, leave_out=(*WITH_ROWS, *unused)),
            Switch(
                "legend placed",
                "The legend stays where it was dragged in the picture; else it stands where it hides least.",
                "" if is_placed or scalar.legend else "the scalar shows no legend; switch it on first",
                is_on=is_placed,
                flip=lambda: self._put({"legend_place": None if is_placed else CORNERS[0]}),
            ),
            Gap("surfaces gap"),
            surface_row(session, "A surface, for the switch below; a click in the picture chooses, too."),
            Switch(
                "colored",
                f"Whether the scalar colors {name}; else it has its own colors.",
                "" if name else "the scene has no surface in use",
                is_on=name in colored,
                flip=lambda: self._put({"surfaces": wanted}),
            ),
        ]

    def _limit_rows(self, scalar: Scalar) -> list[Widget]:
        """A switch for the scalar's own range, its limits if it has some, and limits around zero."""
        own_low, own_high = own_limits(self.session.studio.picture)
        # The range is of float32: a scene file should say 0.1, and not 0.10000000149011612.
        own = float(str(np.float32(own_low))), float(str(np.float32(own_high)))
        low, high = scalar.limits or own
        usual, least, far = bar_within(*own), LEAST_SHARE * (own[1] - own[0]), max(abs(low), abs(high))

        def put(*limits: float) -> None:
            self._put({"limits": limits or None})

        bars = [
            Bar(
                "low limit",
                "Where the first band begins.",
                value=low,
                **usual._asdict(),
                put=lambda value: put(min(value, high - least), high),
            ),
            Bar(
                "high limit",
                "Where the last band ends.",
                value=high,
                **usual._asdict(),
                put=lambda value: put(low, max(value, low + least)),
            ),
        ]
        return [
            Switch(
                "own range",
                f"Let the bands run from the least value, {own[0]:.5g}, to the largest, {own[1]:.5g}.",
                is_on=scalar.limits is None,
                flip=lambda: put(*(own if scalar.limits is None else ())),
            ),
            *(bars if scalar.limits else ()),
            Button(
                "around zero",
                "Limits as far below zero as above, as a scale with a light middle needs.",
                run=lambda: put(-far, far),
            ),
        ]

    def _color_row(self, column: str, help: str, color: Color | None, names: Sequence[str]) -> Choice:
        """A row that chooses a color by its name, or none. Other colors are shown in digits."""
        name_of = {each: name for name, each in NAMED.items()}
        return Choice(
            column,
            help,
            names=names,
            present=NONE if color is None else name_of.get(color, in_digits(color)),
            choose=lambda name: self._put({column: NAMED.get(name)}),
        )

    def _choose(self, name: str) -> None:
        """Show another scalar in its own range, or none. Zebra stripes bring and take their own colors."""
        scene = self.session.scene
        if name == NONE:
            self.session.edit(scene.without_scalar())
            return
        colors: dict[str, Any] = {}
        if name == ZEBRA:
            colors = {"scale": ZEBRA, "bands": 2}
        elif scene.scalar is not None and scene.scalar.name == ZEBRA:
            colors = {key: vars(Scalar(name))[key] for key in ("scale", "bands")}
        self.session.edit(scene.with_scalar(name=name, limits=None, **colors))

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.with_scalar(**changes))


LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of the limits, as a share of the scalar's own range."""

NAMED: Final[Mapping[str, Color]] = {
    "black": (0, 0, 0),
    "gray": (128, 128, 128),
    "white": (255, 255, 255),
    "magenta": (255, 0, 255),
    "red": (255, 0, 0),
    "yellow": (255, 255, 0),
    "green": (0, 160, 0),
    "cyan": (0, 255, 255),
    "blue": (0, 0, 255),
}
"""Assumed: colors enough to differ from any color scale."""
