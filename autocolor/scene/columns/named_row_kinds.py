"""The kind of columns that hold rows by name, any number of them, inside another row."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from autocolor.checks import listed, nearest, shown
from autocolor.scene.columns.column import Kind, Row, Tier, keys_of
from autocolor.scene.columns.problems import REFUSED, Path, Problem
from autocolor.scene.columns.row_kinds import Nested
from autocolor.scene.columns.rows import cost, difference, plain

MOST_NAMED_ROWS: Final = 64
"""Assumed: the most rows inside another one; more would hardly be told apart on a screen."""


@dataclass(frozen=True)
class NamedRows(Kind):
    """Rows of a class with unique names, inside another row; they are sorted by name.

    Files write them as a table of tables by name. A change is such a table, too: it changes the keys of the
    rows that are there, of which `name` renames one, adds rows, and removes those for which it has None.
    """

    row_class: type[Row]

    def accepts(self) -> str:
        name = self.row_class.__name__
        return f"Mapping[str, Row | {name}Changes | None] | Sequence[Row]"

    def rule(self) -> str:
        return f"must be a table of {self.row_class.noun}s by name"

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if isinstance(value, Mapping):
            return self.changed((), value, path, problems)
        if not isinstance(value, (list, tuple)) or not all(type(row) is self.row_class for row in value):
            problems.append(Problem(path, f"{self.rule()}, not {shown(value)}"))
            return REFUSED
        if not self._are_few(len(value), MOST_NAMED_ROWS, path, problems):
            return REFUSED
        rows: list[Any] = sorted(value, key=lambda row: row.name)
        taken = {one.name: None for one, other in pairwise(rows) if one.name == other.name}
        for name in taken:
            text = "must have a name of its own, not that of another; rename one of them"
            problems.append(Problem((*path, name), text))
        return REFUSED if taken else tuple(rows)

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        rows = {row.name: row for row in present} if isinstance(present, tuple) else {}
        # All of them may be removed, and as many added.
        if not self._are_few(len(table), 2 * MOST_NAMED_ROWS, path, problems):
            return REFUSED
        for name, given in table.items():
            if not isinstance(name, str) or not name:
                text = f"{self.rule()}, not by {shown(name)}; name it by at least one character"
                problems.append(Problem(path, text))
                rows[name] = REFUSED
            elif given is None and name in rows:
                del rows[name]
            elif given is None:
                advice = nearest(name, rows) or "; leave it out"
                text = f"there is no {self.row_class.noun} of this name{advice}"
                problems.append(Problem((*path, name), text))
                rows[name] = REFUSED
            elif name in rows and isinstance(given, Mapping):
                rows[name] = Nested(self.row_class).changed(rows[name], given, (*path, name), problems)
            else:
                rows[name] = self._new(name, given, (*path, name), problems)
        if any(row is REFUSED for row in rows.values()):
            return REFUSED
        return self.held(tuple(rows.values()), path, problems)

    def _new(self, name: str, given: object, path: Path, problems: list[Problem]) -> object:
        """The row of a name, of keys or as a row; REFUSED if it is invalid, or has another name."""
        if not isinstance(given, (Mapping, self.row_class)):
            keys = [key for key in keys_of(self.row_class) if key != "name"]
            problems.append(Problem(path, f"must be a table of {listed(keys)}, not {shown(given)}"))
            return REFUSED
        own = given.get("name", name) if isinstance(given, Mapping) else vars(given)["name"]
        if own != name:
            text = f"must be that of the table, {shown(name)}, not {shown(own)}; leave it out"
            problems.append(Problem((*path, "name"), text))
            return REFUSED
        new = {**given, "name": name} if isinstance(given, Mapping) else given
        return Nested(self.row_class).held(new, path, problems)

    def _are_few(self, count: int, most: int, path: Path, problems: list[Problem]) -> bool:
        """Whether rows or changes are not too many; else that is a problem."""
        if count > most:
            problems.append(
                Problem(path, f"must be at most {MOST_NAMED_ROWS}, not {count:,}; leave some out")
            )
        return count <= most

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: {row.name: without_name(plain(row)) for row in value} or None}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        before, after = ({row.name: row for row in rows} for rows in (one, other))
        told: dict[str, object] = {gone: None for gone in before if gone not in after}
        for key, row in after.items():
            if key not in before:
                told[key] = without_name(plain(row))
            elif inner := difference(before[key], row):
                told[key] = inner
        return {name: told} if told else {}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        if [row.name for row in one] != [row.name for row in other]:
            return own
        costs = [cost(a, b) for a, b in zip(one, other, strict=True) if a is not b]
        return max((each for each in costs if each is not None), default=None)


def without_name(keys: Mapping[str, object]) -> dict[str, object]:
    """The keys of a row that is written by name, which are those but its name."""
    return {key: value for key, value in keys.items() if key != "name"}
