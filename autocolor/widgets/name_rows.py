"""The rows of a menu for columns that refer to rows of other tables by name.

A list of names has a switch that gives it, and then one for each known name. Many names come in pages, so
that they do not fill the menu.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.scene.columns.column import Column, Field
from autocolor.scene.columns.reference_kinds import Reference, References, Referring, WordOrName
from autocolor.widgets.labels import short_label
from autocolor.widgets.widget import Choice, Switch, Widget

NAMES_A_PAGE: Final = 12
"""Assumed: names that are shown at once; two lists of them fit in a menu."""

LONGEST_LABEL: Final = 14
"""Characters of a label beside a box."""

INDENT: Final = "  "

NONE: Final = "none"
"""The choice of no name."""

TakeNames = Callable[[Any], object]
"""Takes a name, names, or None."""


class KnownNames(NamedTuple):
    """The names that can be chosen: those of a table, and the page of them that is shown, by table."""

    of: Callable[[str], Sequence[str]]
    pages: dict[str, int]


def reference_rows(
    label: str, field: Field, kind: Referring, value: Any, take: TakeNames, known: KnownNames
) -> Iterator[Widget]:
    """The rows for names in a column; `take` is called with what they are to be."""
    column, names = field.column, known.of(kind.table)
    if isinstance(kind, References):
        yield from _list_rows(label, column, value, take, known.pages, (kind.table, names))
    elif isinstance(kind, (Reference, WordOrName)):
        first = (NONE,) if field.is_optional else ()
        word = (kind.word,) if isinstance(kind, WordOrName) else ()
        yield Choice(
            label,
            column.help,
            names=(*first, *word, *(name for name in names if name not in (*first, *word))),
            present=NONE if value is None else value,
            choose=partial(_choose, take, field.is_optional),
        )


def _list_rows(
    label: str,
    column: Column,
    value: Sequence[str] | None,
    take: TakeNames,
    pages: dict[str, int],
    table: tuple[str, Sequence[str]],
) -> Iterator[Widget]:
    """A switch that gives a list, without a name at first; below it one for each name of a page."""
    what, names = table
    is_given = value is not None
    short = short_label(label, LONGEST_LABEL)
    yield Switch(short, column.help, is_on=is_given, flip=partial(take, None if is_given else ()))
    if value is None:
        return
    page = min(pages.get(what, 0), max(0, len(names) - 1) // NAMES_A_PAGE)
    if len(names) > NAMES_A_PAGE:
        numbers = range(0, len(names), NAMES_A_PAGE)
        titles = [f"{first + 1} to {min(first + NAMES_A_PAGE, len(names))}" for first in numbers]
        yield Choice(
            what,
            within=label,
            help=f"Which of the {len(names)} {what} are shown below; {len(value)} are in the list.",
            names=titles,
            present=titles[page],
            choose=lambda title: pages.__setitem__(what, titles.index(title)),
        )
    for name in names[page * NAMES_A_PAGE : (page + 1) * NAMES_A_PAGE]:
        wanted = {*value} ^ {name}
        chosen = tuple(each for each in names if each in wanted)
        is_in = name in value
        told = f"Take {name} {'from' if is_in else 'into'} the list: {label}."
        yield Switch(f"{INDENT}{name}", told, within=label, is_on=is_in, flip=partial(take, chosen))


def _choose(take: TakeNames, has_none: bool, name: str) -> object:
    return take(None if has_none and name == NONE else name)
