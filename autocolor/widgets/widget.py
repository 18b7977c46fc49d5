"""Widgets: the things that a user can point at on a screen, in a menu or beside it, as values.

A widget knows its area, how it looks, and what a pick or a drag on it does. A widget holds no state of its
own: screens make their widgets from the scene, once for an event.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final, NamedTuple, TypeVar

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
    YELLOW,
    Area,
    Item,
    filled,
    fitted,
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

LABEL_LETTERS: Final = 4
"""The fewest characters of a label that is cut."""

MOST_IN_TURN: Final = 3
"""Assumed: names that picks take one after the other; more names are shown in a list."""

NOWHERE: Final = Area(0, 0, -1, -1)

SomeWidget = TypeVar("SomeWidget", bound="Widget")


class Place(NamedTuple):
    """An element and a line of the screen."""

    element: int
    line: int


class Typed(NamedTuple):
    """The text of a widget that can be typed over, and the function that takes the new text.

    If it `is_proposed`, Return takes the text even if it was not changed, and a pick elsewhere gives it up.
    """

    text: str
    take: Callable[[str], object]
    is_proposed: bool = False


@dataclass(frozen=True)
class Widget:
    """Something to point at. With a reason in `why_not` it is dim and cannot be used."""

    label: str
    help: str = ""
    why_not: str = ""
    area: Area = NOWHERE
    within: str = ""
    """The list or row that it belongs to, where several have widgets of the same label."""
    row_lines: ClassVar[int] = ROW_LINES
    """Its height in a menu."""

    @property
    def key(self) -> str:
        """The name by which the widget is recognized on its screen when it is made again."""
        return f"{self.within}.{self.label}" if self.within else self.label

    @property
    def hint(self) -> str:
        """The text of the message line while the pointer is over it."""
        return self.why_not or self.help or self.label

    def hint_at(self, place: Place) -> str:
        """The text of the message line while the pointer is at a place over it."""
        return self.hint

    @property
    def typed(self) -> Typed | None:
        """The text that can be typed over; None if there is none."""
        return None

    def has(self, element: int, line: int) -> bool:
        """Whether a place belongs to the widget."""
        left, top, right, bottom = self.area
        return left <= element <= right and top <= line <= bottom

    def at(self: SomeWidget, area: Area) -> SomeWidget:
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

    def row(self, lit: bool, label: str = "", value: str = "", chosen: bool = False) -> list[Item]:
        """The items of a row with a label at the left and a value at the right."""
        left, top, right, _ = self.area
        background = WHITE if chosen else SLATE if lit else NIGHT
        ink = BLACK if chosen else self.ink
        room = self.characters
        shown = short_name(value, room)
        items = [filled(self.area, background)]
        if shown:
            start = right + 1 - MARGIN - CHARACTER * len(shown)
            items.append(text(shown, start, top + TEXT_DOWN, ink, background))
        beside = room - len(shown) - bool(shown)
        # A value that fills the row is shown without its label: a letter or two of it would say nothing.
        label = short_name(label, beside) if beside >= min(len(label), LABEL_LETTERS) else ""
        if label:
            quiet = LIGHT_GRAY if value and ink == WHITE else ink
            items.append(text(label, left + MARGIN, top + TEXT_DOWN, quiet, background))
        return items

    def labeled_row(self, lit: bool, value: str) -> list[Item]:
        """The items of a row with the widget's own label, shortened where the value needs the room."""
        return self.row(lit, short_label(self.label, self.characters - len(value) - 1), value)


@dataclass(frozen=True)
class Heading(Widget):
    """A line of text over some rows."""

    def items(self, lit: bool) -> list[Item]:
        left, top, *_ = self.area
        room = (self.area.width - MARGIN) // CHARACTER
        return [
            filled(self.area, NIGHT),
            text(fitted(self.label, room), left + MARGIN, top + TEXT_DOWN, YELLOW),
        ]


@dataclass(frozen=True)
class Gap(Widget):
    """Some empty lines between rows."""

    row_lines: ClassVar[int] = ROW_LINES // 2

    def items(self, lit: bool) -> list[Item]:
        return [filled(self.area, NIGHT)]


@dataclass(frozen=True)
class Button(Widget):
    """A row that calls `run` when it is picked; `value` stands at its right."""

    run: Callable[[], object] = lambda: None
    value: str = ""
    is_chosen: bool = False

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
        items = self.row(lit, self.label, "  ", self.is_chosen)
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
        room = self.characters - len(low) - len(high) - 2
        return self.row(lit, f"{low} {fitted(self.label, room)}", high)

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

    @property
    def hint(self) -> str:
        if self.why_not or not self.has_list:
            return super().hint
        return f"{super().hint.removesuffix('.')}; a click lists all {len(self.names)}."

    def items(self, lit: bool) -> list[Item]:
        items = self.labeled_row(lit, self.present)
        if not self.has_list:
            return items
        left, top, *_ = self.area
        sign = pointer(left + 1, top + ROW_LINES // 2 - 1, LEFT, LIGHT_GRAY, SLATE if lit else NIGHT)
        return [*items, sign]

    def pick(self, place: Place) -> object:
        return self.nudge(-1 if place.element < self.area.left + 3 * MARGIN else 1)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        number = (place.element - self.area.left) * len(self.names) // self.area.width
        name = self.names[min(max(number, 0), len(self.names) - 1)] if self.names else self.present
        return None if name == self.present else self.choose(name)

    def nudge(self, steps: float) -> object:
        if not self.names:
            return None
        names = list(self.names)
        step = 1 if steps > 0 else -1
        if self.present not in names:
            return self.choose(names[min(step, 0)])
        return self.choose(names[(names.index(self.present) + step) % len(names)])


def page_choice(help: str, page: int, pages: int, turn: Callable[[int], object]) -> Choice:
    """A row that turns pages, counted from 0; `turn` is called with the number of another page."""
    names = [f"{number} of {pages}" for number in range(1, pages + 1)]
    return Choice(
        "page",
        help,
        names=names,
        present=names[page],
        choose=lambda name: turn(names.index(name)),
        turns_pages=True,
    )


@dataclass(frozen=True)
class Entry(Widget):
    """A text that can be typed over; see `Typed` for a text that is proposed."""

    value: str = ""
    take: Callable[[str], Any] = lambda _: None
    is_proposed: bool = False

    @property
    def typed(self) -> Typed:
        return Typed(self.value, self.take, self.is_proposed)

    def items(self, lit: bool) -> list[Item]:
        return self.labeled_row(lit, self.value)


@dataclass(frozen=True)
class Pair(Widget):
    """Two buttons in one row: `label` names the left one, `other` the right one. Keys pick them by steps."""

    run: Callable[[], object] = lambda: None
    other: str = ""
    run_other: Callable[[], object] = lambda: None
    is_chosen: bool = False
    """Whether the left button is chosen."""

    def items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        middle = self._middle
        items = self.row(
            lit,
            fitted(self.label, (middle - self.area.left - MARGIN) // CHARACTER - 1),
            chosen=self.is_chosen,
        )
        edge, top = middle - MARGIN // 2, self.area.top + TEXT_DOWN
        if self.is_chosen:
            items.append(filled(self.area._replace(left=edge), background))
        other = fitted(self.other, (self.area.right + 1 - middle) // CHARACTER)
        between = Area(edge, top, edge, top + CHARACTER_LINES - 1)
        return [
            *items,
            filled(between, GRAY if lit else SLATE),
            text(other, middle, top, self.ink, background),
        ]

    @property
    def _middle(self) -> int:
        """Where the right button begins: in the middle, or a letter after it if the left label is long."""
        left = self.area.left + MARGIN
        middle = left + (self.area.width - MARGIN) // 2
        return min(max(middle, left + CHARACTER * (len(self.label) + 1)), middle + CHARACTER)

    def pick(self, place: Place) -> object:
        return self.run_other() if place.element >= self._middle - MARGIN // 2 else self.run()

    def nudge(self, steps: float) -> object:
        return self.run_other() if steps > 0 else self.run()


STEM_LETTERS: Final = 3
"""The fewest letters of a shortened word before its period."""

VOWELS: Final = "aeiou"


def short_label(label: str, most: int) -> str:
    """A label whose longest words are shortened until it has at most `most` characters, if possible.

    A shortened word ends in a consonant and a period.

    >>> short_label("normal reflectance", 12), short_label("x minimum", 7), short_label("cone angle", 10)
    ('normal refl.', 'x min.', 'cone angle')
    """
    if len(label) <= most:
        return label
    words = label.split(" ")
    for number in sorted(range(len(words)), key=lambda each: -len(words[each])):
        excess = len(" ".join(words)) - most
        if excess <= 0:
            break
        word = words[number]
        stem = word[: max(STEM_LETTERS, len(word) - excess - 1)]
        while len(stem) > STEM_LETTERS and stem[-1] in VOWELS:
            stem = stem[:-1]
        if len(stem) + 1 < len(word):
            words[number] = f"{stem}."
    return " ".join(words)


def titled(noun: str, name: str) -> str:
    """A name after its noun; the name alone if it begins with the noun.

    >>> titled("light", "key"), titled("light", "light 2")
    ('light key', 'light 2')
    """
    return name if name.startswith(noun) else f"{noun} {name}"


def short_name(name: str, most: int) -> str:
    """A name of at most `most` characters. Longer names lose their middle, because their ends differ.

    >>> short_name("fender of the left door 12.obj", 16)
    'fender .. 12.obj'
    """
    if len(name) <= most:
        return name
    end = max(0, (most - 2) // 2)
    return f"{name[: max(0, most - 2 - end)]}..{name[len(name) - end :]}"[: max(0, most)]
