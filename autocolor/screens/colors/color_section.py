"""A section of the color mixing screen: one of the two colors of the chosen surface, with its ramp and bars.

Paper: Figure 13, the light source color above, the object color below.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, NamedTuple

from autocolor.arrays import Words
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.mapping.tints import FULL, white_of, with_white
from autocolor.scene.changes import PaintChanges
from autocolor.scene.columns.color_kinds import in_digits
from autocolor.scene.surfaces import Paint
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import BLUE, GREEN, RED, WHITE
from autocolor.widgets.component_bars import ComponentBar
from autocolor.widgets.items import Item
from autocolor.widgets.level_bars import level_strip
from autocolor.widgets.widget import ROW_LINES, Button, Entry, Widget

LEFT: Final = 8
LEFT_END: Final = 167
"""The column of the ramps."""

RIGHT: Final = 176
RIGHT_END: Final = 495
"""The column of the bars."""

BAR_LINES: Final = 24
"""The height of each of the four bars."""

COMPONENTS: Final = (("red", RED), ("green", GREEN), ("blue", BLUE))

OBJECT: Final = "object"
LIGHT_SOURCE: Final = "light source"
"""What the two colors are called for users."""


class Raised(NamedTuple):
    """What the white bar made last: the color of a surface that it began with, and the one that it gave."""

    surface: str
    start: Color
    to: Color


class ColorSection:
    """One color of a paint, by its title, and where it stands from a line on.

    `give` gives the chosen surface another color, `choose` makes this the one that swatches are for.
    """

    def __init__(
        self,
        session: Session,
        title: str,
        top: int,
        give: Callable[[ColorSection, Sequence[int] | str], object],
        choose: Callable[[ColorSection], object],
    ) -> None:
        self.session, self.title = session, title
        self._give, self._choose = partial(give, self), partial(choose, self)
        self._raised = Raised("", (0, 0, 0), (0, 0, 0))
        self._heading = Area(LEFT, top, LEFT_END, top + ROW_LINES - 1)
        self.ramp = Area(LEFT, top + ROW_LINES, LEFT_END, top + ROW_LINES + 4 * BAR_LINES - 1)

    def color_of(self, paint: Paint) -> Color:
        """The color in a paint."""
        return paint.object_color if self.title == OBJECT else paint.light_color

    def change(self, color: Sequence[int] | str) -> PaintChanges:
        """The change of a paint that puts the color into it."""
        return {"object_color": color} if self.title == OBJECT else {"light_color": color}

    def items(self, ramp: Words) -> list[Item]:
        """The ramp in its words, from the lowest intensity at the left."""
        return [level_strip(ramp.tobytes(), self.ramp)]

    def widgets(self, paint: Paint, is_chosen: bool) -> list[Widget]:
        """The heading, and the bars."""
        color = self.color_of(paint)
        told = f"The {self.title} color: click to pick swatches for it."
        heading = SectionHeading(
            self.title, told, run=self._choose, value=in_digits(color), is_chosen=is_chosen
        )
        bars = [
            ComponentBar(
                f"{self.title}, {name}",
                f"{name.capitalize()} of the {self.title} color, 0 to {FULL}.",
                value=color[number],
                put=partial(self._put_component, number),
                word=word,
                letter=name[0].upper(),
            )
            for number, (name, word) in enumerate(COMPONENTS)
        ]
        white = ComponentBar(
            f"{self.title}, white",
            "Tints and shades: adds the same to red, green and blue; each stops at its ends.",
            value=white_of(color),
            put=self._put_white,
            word=WHITE,
            letter="W",
        )
        return [
            heading.at(self._heading),
            *(bar.at(self._bar_area(number)) for number, bar in enumerate([*bars, white])),
        ]

    def row(self, paint: Paint) -> Entry:
        """The row of a menu in which the color is typed, by its name or number."""
        told = f"The {self.title} color by its name or number, such as teal or #b01020."
        return Entry(self.title.split()[0], told, value=in_digits(self.color_of(paint)), take=self._give)

    def _bar_area(self, number: int) -> Area:
        top = self.ramp.top + number * BAR_LINES
        return Area(RIGHT, top, RIGHT_END, top + BAR_LINES - 1)

    def _put_component(self, number: int, value: float) -> None:
        component, color = whole(COMPONENTS[number][0], value), self._present
        self._give((*color[:number], component, *color[number + 1 :]))

    def _put_white(self, value: float) -> None:
        """Raise or lower the color; one that was raised or lowered before, from what it was before that.

        Assumed: so the bar comes back to a color whose components were at their ends meanwhile.
        """
        surface, color = self.session.surface_name, self._present
        if (surface, color) != (self._raised.surface, self._raised.to):
            self._raised = Raised(surface, color, color)
        to = with_white(self._raised.start, whole("white", value))
        self._raised = self._raised._replace(to=to)
        self._give(to)

    @property
    def _present(self) -> Color:
        """The color that the chosen surface has now."""
        return self.color_of(self.session.scene.surface(self.session.surface_name).paint)


@dataclass(frozen=True)
class SectionHeading(Button):
    """The heading of a section, whose label may be that of a row of the menu, too."""

    @property
    def key(self) -> str:
        return f"{self.label} heading"


def whole(name: str, value: float) -> int:
    """The value of a component. Raises UsageError if it is not a whole number from 0 to 255."""
    if not 0 <= value <= FULL or value != int(value):
        raise UsageError(f"{name} must be a whole number from 0 to {FULL}, not {value:g}; type another")
    return int(value)
