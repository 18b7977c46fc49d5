"""The scalar screen: which scalar colors the surfaces, its color scale, its bands and its limits.

Paper: "Introduction": scalar variables such as stress on the surface of an object, in color. Everything is
set by pointing, and only another scalar computes values again; another color scale sends entries alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar, bar_within
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Button, Choice, Gap, Switch, Widget

NO_SCALAR: Final = "none"
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
        scene, scalar = self.session.scene, self.session.scene.scalar
        choice = Choice(
            "scalar",
            "The scalar that colors the surfaces: a scalar of the mesh, or a computed scalar.",
            names=(NO_SCALAR, *scene.scalar_names),
            present=NO_SCALAR if scalar is None else scalar.name,
            choose=self._choose,
        )
        if scalar is None:
            return [choice]
        is_computed = scalar.name not in {each.name for each in scene.mesh.scalars}
        unused = (key for key, names in COMPUTED_WITH.items() if not (is_computed and scalar.name in names))
        return [
            choice,
            Gap("scale gap"),
            *self._scale_rows(scalar),
            Gap("limits gap"),
            *limit_rows(self.session, scalar, lambda limits: self._put({"limits": limits})),
            *self._color_rows(scalar),
            Gap("bands gap"),
            *rows_of(scalar, self._put, self.session.world, leave_out=(*WITH_ROWS, *unused)),
            self._place_row(scalar),
            Gap("surfaces gap"),
            *self._surface_rows(),
        ]

    def _place_row(self, scalar: Scalar) -> Widget:
        """Whether the legend has a place of its own."""
        is_placed = scalar.legend_place is not None
        return Switch(
            "legend placed",
            "The legend stays where it was dragged in the picture; else it stands where it hides least.",
            "" if is_placed or scalar.legend else "the scalar shows no legend; switch it on first",
            is_on=is_placed,
            flip=lambda: self._put({"legend_place": None if is_placed else CORNERS[0]}),
        )

    def _scale_rows(self, scalar: Scalar) -> list[Widget]:
        """The color scale, and whether it is reversed."""
        is_named = isinstance(scalar.scale, str)
        name = scalar.scale if isinstance(scalar.scale, str) else OWN_COLORS
        base = name.removesuffix(REVERSED)
        end = name.removeprefix(base)
        return [
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
                "" if is_named else "the scale is a list of colors; choose one with a name first",
                is_on=bool(end),
                flip=lambda: self._put({"scale": base if end else base + REVERSED}) if is_named else None,
            ),
        ]

    def _color_rows(self, scalar: Scalar) -> list[Widget]:
        """The colors beyond the limits, and the color of missing values."""
        help = "The color of values {} the limits; none: the color of the {} band."
        return [
            color_choice(
                "below",
                help.format("below", "first"),
                scalar.below,
                lambda color: self._put({"below": color}),
                has_none=True,
            ),
            color_choice(
                "above",
                help.format("above", "last"),
                scalar.above,
                lambda color: self._put({"above": color}),
                has_none=True,
            ),
            color_choice(
                "missing",
                "The color where there is no value.",
                scalar.missing,
                lambda color: self._put({"missing": color}),
                has_none=False,
            ),
        ]

    def _surface_rows(self) -> list[Widget]:
        """The chosen surface, and whether the scalar colors it."""
        session = self.session
        colored, name = colored_surfaces(session.scene), session.surface_name

        def flip() -> None:
            wanted = {*colored} ^ {name}
            self._put({"surfaces": [each.name for each in session.scene.surfaces if each.name in wanted]})

        return [
            surface_row(session, "A surface, for the switch below; a click in the picture chooses, too."),
            Switch(
                "colored",
                f"Whether the scalar colors {name}; else it has its own colors.",
                "" if name else "the scene has no surface in use",
                is_on=name in colored,
                flip=flip,
            ),
        ]

    def _choose(self, name: str) -> None:
        """Show another scalar in its own range, or none. Zebra stripes bring and take their own colors."""
        scene = self.session.scene
        if name == NO_SCALAR:
            self.session.edit(scene.without_scalar())
            return
        colors: dict[str, Any] = {}
        if ZEBRA in (name, scene.scalar.name if scene.scalar is not None else ""):
            own = Scalar(name)
            colors = (
                {"scale": ZEBRA, "bands": 2} if name == ZEBRA else {"scale": own.scale, "bands": own.bands}
            )
        self.session.edit(scene.with_scalar(name=name, limits=None, **colors))

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.with_scalar(**changes))


LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of the limits, as a share of the scalar's own range."""

PutLimits = Callable[[tuple[float, float] | None], object]


def limit_rows(session: Session, scalar: Scalar, put: PutLimits) -> list[Widget]:
    """A switch for the scalar's own range, the two limits, and limits that are symmetric around zero."""
    own_low, own_high = own_limits(session.studio.picture)
    # The range is of float32: a scene file should say 0.1, and not 0.10000000149011612.
    own = float(str(np.float32(own_low))), float(str(np.float32(own_high)))
    low, high = scalar.limits or own
    usual = bar_within(*own)
    least = LEAST_SHARE * (own[1] - own[0])
    far = max(abs(low), abs(high))
    return [
        Switch(
            "own range",
            f"Let the bands run from the least value, {own[0]:.5g}, to the largest, {own[1]:.5g}.",
            is_on=scalar.limits is None,
            flip=lambda: put(own if scalar.limits is None else None),
        ),
        Bar(
            "low limit",
            "Where the first band begins.",
            value=low,
            **usual._asdict(),
            put=lambda value: put((min(value, high - least), high)),
        ),
        Bar(
            "high limit",
            "Where the last band ends.",
            value=high,
            **usual._asdict(),
            put=lambda value: put((low, max(value, low + least))),
        ),
        Button(
            "around zero",
            "Limits as far below zero as above, as a scale with a light middle needs.",
            run=lambda: put((-far, far)),
        ),
    ]


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

NO_COLOR: Final = "none"


def color_choice(
    label: str, help: str, color: Color | None, put: Callable[[Color | None], object], has_none: bool
) -> Choice:
    """A row that chooses a color of `NAMED`, or no color if `has_none`. Other colors are shown in digits."""
    names = (*([NO_COLOR] if has_none else []), *NAMED)
    name_of = {each: name for name, each in NAMED.items()}
    present = NO_COLOR if color is None else name_of.get(color, in_digits(color))
    return Choice(label, help, names=names, present=present, choose=lambda name: put(NAMED.get(name)))
