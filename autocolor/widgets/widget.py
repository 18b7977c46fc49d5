"""Widgets: the things that a user can point at on a screen, in a menu or beside it, as values.

A widget knows its area, how it looks, and what a pick or a drag on it does. A widget holds no state of its
own: screens make their widgets from the scene, once for an event.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final, NamedTuple, Self

from autocolor.widgets.items import (
    BLACK,
    CHARACTER,
    CHARACTER_LINES,
    GRAY,
    LEFT,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    WHITE,
    Area,
    Item,
    filled,
    fitted,
    outline,
    pointer,
    text,
)

ROW_LINES: Final = 16
"""The height of a row of a menu."""

MARGIN: Final = 8
"""Elements between the edge of a row and its text."""

TEXT_DOWN: Final = 3
"""Lines between the top of a row and its text."""

BOX: Final = 8
"""Elements and lines of the box of a switch."""

MOST_IN_TURN: Final = 3
"""Assumed: names that picks take one after the other; more names are shown in a list."""

NOWHERE: Final = Area(0, 0, -1, -1)

ROW_CHARACTERS: Final = 17
"""The characters between the margins of a row of a menu."""


class Place(NamedTuple):
    """An element and a line of the screen."""

    element: int
    line: int


@dataclass(frozen=True)
class Widget:
    """Something to point at. With a reason in `why_not` it is dim and cannot be used."""

    label: str
    help: str = ""
    why_not: str = ""
    area: Area = NOWHERE
    within: str = ""
    """The list or row that it belongs to, where several have widgets of the same label."""

    @property
    def key(self) -> str:
        """The name by which the widget is recognized on its screen when it is made again."""
        return f"{self.within}.{self.label}" if self.within else self.label

    def hint_at(self, place: Place) -> str:
        """The text of the message line while the pointer is at a place over it."""
        return self.why_not or self.help or self.label

    @property
    def row_lines(self) -> int:
        """Its height in a menu."""
        return ROW_LINES

    def has(self, element: int, line: int) -> bool:
        """Whether a place belongs to the widget."""
        return self.area.has(element, line)

    def at(self, area: Area) -> Self:
        """The same widget at an area."""
        # All widgets are placed for each event; `replace` would take most of that time.
        placed = object.__new__(type(self))
        vars(placed).update(vars(self), area=area)
        return placed

    def items(self, lit: bool) -> list[Item]:
        """The items of the widget. With `lit`, the pointer is over it."""
        raise NotImplementedError

    def pick(self, place: Place) -> object:
        """Handle a click or ENTER."""

    def drag(self, start: Place, last: Place, place: Place) -> object:
        """Follow the pointer from `last` to `place`, in a drag that began at `start`."""

    def nudge(self, steps: float) -> object:
        """Take steps up or down, by a key or the wheel."""

    @property
    def ink(self) -> int:
        """The word of its text."""
        return GRAY if self.why_not else WHITE

    @property
    def characters(self) -> int:
        """The characters that fit between the margins of its row."""
        left, _, right, _ = self.area
        return (right - left + 1 - 2 * MARGIN) // CHARACTER

    def row(self, lit: bool, label: str, value: str = "", chosen: bool = False) -> list[Item]:
        """The items of a row with a label at the left and a value at the right, or below in a higher row.

        The value is whole if there is room. A label that does not fit beside it is shortened.
        """
        left, top, right, _ = self.area
        background = WHITE if chosen else SLATE if lit else NIGHT
        ink = BLACK if chosen else self.ink
        room = self.characters
        value = fitted(value, room)
        items = [filled(self.area, background)]
        if value:
            start = right + 1 - MARGIN - CHARACTER * len(value)
            below = self.area.height - ROW_LINES
            items.append(text(value, start, top + TEXT_DOWN + below, ink, background))
            room -= 0 if below else len(value) + 1
        label = short_label(label, room)
        if label:
            quiet = LIGHT_GRAY if value and ink == WHITE else ink
            items.append(text(label, left + MARGIN, top + TEXT_DOWN, quiet, background))
        return items


def lines_of_row(label: str, value: str) -> int:
    """The height of a row of a menu: a long value stands on a line of its own, below the label."""
    is_long = value and len(label) + 1 + len(value) > ROW_CHARACTERS
    return 2 * ROW_LINES if is_long else ROW_LINES


@dataclass(frozen=True)
class Gap(Widget):
    """Some empty lines between rows."""

    row_lines: ClassVar[int] = ROW_LINES // 2

    def items(self, lit: bool) -> list[Item]:
        return [filled(self.area, NIGHT)]


@dataclass(frozen=True)
class Panel(Widget):
    """A ground with an outline over the screen, with lines of text and their colors; a pick calls `run`."""

    lines: Sequence[tuple[str, int]] = ()
    run: Callable[[], object] = lambda: None

    def items(self, lit: bool) -> list[Item]:
        left, top = self.area.left + MARGIN, self.area.top + 4
        texts = [text(line, left, top + 12 * row, word) for row, (line, word) in enumerate(self.lines)]
        return [filled(self.area, NIGHT), outline(self.area, SLATE), *texts]

    def pick(self, place: Place) -> object:
        return self.run()


@dataclass(frozen=True)
class Button(Widget):
    """A row that calls `run` when it is picked; `value` stands at its right."""

    run: Callable[[], object] = lambda: None
    value: str = ""
    is_chosen: bool = False

    @property
    def row_lines(self) -> int:
        return lines_of_row(self.label, self.value)

    def items(self, lit: bool) -> list[Item]:
        return self.row(lit, self.label, self.value, self.is_chosen)

    def pick(self, place: Place) -> object:
        return self.run()


@dataclass(frozen=True)
class PanelButton(Button):
    """A button of a panel over the screen, with its label in the middle."""

    def items(self, lit: bool) -> list[Item]:
        left = self.area.left + (self.area.width - CHARACTER * len(self.label)) // 2
        top = self.area.top + (self.area.height - CHARACTER_LINES + 1) // 2
        ground = WHITE if self.is_chosen else SLATE if lit else NIGHT
        ink = BLACK if self.is_chosen else WHITE
        return [filled(self.area, ground), text(self.label, left, top, ink, ground)]


@dataclass(frozen=True)
class Switch(Widget):
    """A box that is full while `is_on`. Beside the box, a pick calls `choose`, if given."""

    is_on: bool = False
    flip: Callable[[], object] = lambda: None
    choose: Callable[[], object] | None = None
    is_chosen: bool = False

    def items(self, lit: bool) -> list[Item]:
        background = WHITE if self.is_chosen else SLATE if lit else NIGHT
        items = self.row(lit, self.label, " ", self.is_chosen)
        return [*items, *box_items(self._box, self.is_on, BLACK if self.is_chosen else self.ink, background)]

    @property
    def _box(self) -> Area:
        left = self.area.right + 1 - MARGIN - BOX
        top = self.area.top + (ROW_LINES - BOX) // 2
        return Area(left, top, left + BOX - 1, top + BOX - 1)

    def pick(self, place: Place) -> object:
        if self.choose is not None and place.element < self._box.left - MARGIN:
            return self.choose()
        return self.flip()

    def nudge(self, steps: float) -> object:
        return self.flip() if self.is_on != (steps > 0) else None


def box_items(area: Area, is_on: bool, word: int, background: int) -> list[Item]:
    """A box, full or empty."""
    items = [filled(area, word), filled(area.inset(1), background)]
    return [*items, filled(area.inset(2), word)] if is_on else items


@dataclass(frozen=True)
class Steps(Widget):
    """Two signs, one at each end of a row: a pick takes one step, a drag along the row many small ones."""

    step: Callable[[float], object] = lambda _: None
    signs: tuple[str, str] = ("-", "+")

    def items(self, lit: bool) -> list[Item]:
        low, high = self.signs
        return self.row(lit, f"{low} {self.label}", high)

    def pick(self, place: Place) -> object:
        return self.step(1 if place.element > (self.area.left + self.area.right) / 2 else -1)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.step((place.element - last.element) / 16)

    def nudge(self, steps: float) -> object:
        return self.step(steps)


@dataclass(frozen=True)
class Choice(Widget):
    """One of several names. A pick goes to the next name; at the left end of the row, to the name before.

    In a menu, a pick on a choice that `has_list` opens a list instead. A drag along the row runs through all
    names, from the first at the left end to the last.
    """

    names: Sequence[str] = ()
    present: str = ""
    choose: Callable[[str], object] = lambda _: None
    turns_pages: bool = False
    """Whether the names are pages, which are turned one after the other."""
    rename: Callable[[str], object] | None = None
    """Called with the present name if it is picked from the list."""

    @property
    def has_list(self) -> bool:
        """Whether a menu shows its names in a list."""
        return len(self.names) > MOST_IN_TURN and not self.turns_pages

    def hint_at(self, place: Place) -> str:
        hint = super().hint_at(place)
        if self.why_not or not self.has_list:
            return hint
        return f"{hint.removesuffix('.')}; a click lists all {len(self.names)}."

    @property
    def row_lines(self) -> int:
        return lines_of_row(self.label, self.present)

    def items(self, lit: bool) -> list[Item]:
        items = self.row(lit, self.label, self.present)
        if self.has_list:
            left, top, *_ = self.area
            ground = SLATE if lit else NIGHT
            items.append(pointer(left + 1, top + ROW_LINES // 2 - 1, LEFT, LIGHT_GRAY, ground))
        return items

    def pick(self, place: Place) -> object:
        return self.nudge(-1 if place.element < self.area.left + 3 * MARGIN else 1)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        names = self.names or [self.present]
        number = (place.element - self.area.left) * len(names) // self.area.width
        name = names[min(max(number, 0), len(names) - 1)]
        return None if name == self.present else self.choose(name)

    def nudge(self, steps: float) -> object:
        names, step = list(self.names or [self.present]), 1 if steps > 0 else -1
        before = names.index(self.present) if self.present in names else min(-step, 0)
        return self.choose(names[(before + step) % len(names)])


def page_choice(
    help: str, page: int, pages: int, turn: Callable[[int], object], label: str = "page", within: str = ""
) -> Choice:
    """A row that turns pages, counted from 0; `turn` is called with the number of another page."""
    names = [f"{number} of {pages}" for number in range(1, pages + 1)]
    return Choice(
        label,
        help,
        within=within,
        names=names,
        present=names[page],
        choose=lambda name: turn(names.index(name)),
        turns_pages=True,
    )


@dataclass(frozen=True)
class Entry(Button):
    """A text that can be typed over; `take` is called with the new text.

    If it `is_proposed`, Return takes the text even if it was not changed, and a pick elsewhere gives it up.
    """

    take: Callable[[str], Any] = lambda _: None
    is_proposed: bool = False


class Cell(NamedTuple):
    """A button of a row with several: its text, and whether a pick on it does anything; else it is dim."""

    text: str
    run: Callable[[], object]
    is_on: bool = True
    is_chosen: bool = False


@dataclass(frozen=True)
class Pair(Widget):
    """Two buttons in one row: `label` names the left one, `other` the right one. Keys pick them by steps.

    A row of more buttons has them in `buttons`.
    """

    run: Callable[[], object] = lambda: None
    other: str = ""
    run_other: Callable[[], object] = lambda: None
    is_chosen: bool = False
    """Whether the left button is chosen."""
    buttons: Sequence[Cell] = ()

    @property
    def cells(self) -> Sequence[Cell]:
        """The buttons, from the left."""
        is_on = not self.why_not
        return self.buttons or (
            Cell(self.label, self.run, is_on, self.is_chosen),
            Cell(self.other, self.run_other, is_on),
        )

    @property
    def _edges(self) -> list[int]:
        """Where each button begins: at equal distances, or after the text before if that is longer."""
        edges, cells = [self.area.left], self.cells
        for number, before in enumerate(cells[:-1], start=1):
            least = edges[-1] + MARGIN + CHARACTER * len(before.text) + MARGIN - 2
            edges.append(max(least, self.area.left + number * (self.area.width - MARGIN) // len(cells)))
        return edges

    def items(self, lit: bool) -> list[Item]:
        ground, edges = SLATE if lit else NIGHT, self._edges
        items = [filled(self.area, ground)]
        for cell, left, end in zip(self.cells, edges, [*edges[1:], self.area.right + 1], strict=True):
            area = Area(left, self.area.top, end - 1, self.area.bottom)
            line = Area(left, area.top + TEXT_DOWN, left, area.top + TEXT_DOWN + CHARACTER_LINES - 1)
            if cell.is_chosen:
                items.append(filled(area, WHITE))
            elif left > self.area.left:
                items.append(filled(line, GRAY if lit else SLATE))
            ink = BLACK if cell.is_chosen else WHITE if cell.is_on else GRAY
            back = WHITE if cell.is_chosen else ground
            items.append(text(cell.text, left + MARGIN, line.top, ink, back))
        return items

    def pick(self, place: Place) -> object:
        number = sum(place.element >= edge for edge in self._edges[1:])
        return self.cells[number].run()

    def nudge(self, steps: float) -> object:
        return self.cells[-1 if steps > 0 else 0].run()


STEM_LETTERS: Final = 3
"""The fewest letters of a shortened word before its period."""


def short_label(label: str, most: int) -> str:
    """A label of at most `most` characters. If it is longer, its longest word is shortened to a consonant.

    >>> short_label("normal reflectance", 12), short_label("x minimum", 7), short_label("concentration", 9)
    ('normal refl.', 'x min.', 'concentr.')
    """
    excess = len(label) - most
    if excess <= 0:
        return label
    word = max(label.split(" "), key=len)
    stem = word[: max(STEM_LETTERS, len(word) - excess - 1)].rstrip("aeiou")
    return fitted(label.replace(word, f"{stem}.", 1), most)


def titled(noun: str, name: str) -> str:
    """A name after its noun; the name alone if it begins with the noun.

    >>> titled("light", "key"), titled("light", "light 2")
    ('light key', 'light 2')
    """
    return name if name.startswith(noun) else f"{noun} {name}"
