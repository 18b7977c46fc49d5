"""The kinds of columns that hold rows: one row, a row of one of several classes, a table of rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from autocolor.checks import either, listed, nearest, shown
from autocolor.scene.columns.column import Column, Kind, Row, Tier, keys_of
from autocolor.scene.columns.problems import REFUSED, Path, Problem, RowError
from autocolor.scene.columns.rows import changed, cost, difference, made, plain

MOST_ROWS: Final = 1_000_000


@dataclass(frozen=True)
class Nested(Kind):
    """A row of another class; if it is `inline`, its keys are among those of the containing row."""

    row_class: type[Row]
    inline: bool = False

    def rule(self) -> str:
        return f"must be a table of {listed(keys_of(self.row_class))}"

    def accepts(self) -> str:
        return f"Row | {self.row_class.__name__}Changes"

    def has_keys_inside(self) -> bool:
        return self.inline

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        if not self.inline:
            return {name: column}
        return {key: inner.column for key, inner in keys_of(self.row_class).items()}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if isinstance(value, self.row_class):
            return value
        if isinstance(value, Mapping):
            try:
                return made(self.row_class, value)
            except RowError as error:
                return _refused(error, self._path(path), problems)
        rule = f"must be a {self.row_class.__name__}" if self.inline else self.rule()
        problems.append(Problem(path, f"{rule}, not {shown(value)}"))
        return REFUSED

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        if isinstance(present, self.row_class):
            try:
                return changed(present, table)
            except RowError as error:
                return _refused(error, self._path(path), problems)
        # Make a new row if there was none or an invalid one; anything else is refused where it is held.
        is_made = present is REFUSED or (present is None and not self.inline)
        return self.held(table, path, problems) if is_made else present

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return plain(value) if self.inline else {name: plain(value)}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        told = difference(one, other)
        return told if self.inline or not told else {name: told}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return own if one is None or other is None else cost(one, other)

    def _path(self, path: Path) -> Path:
        return path[:-1] if self.inline else path


@dataclass(frozen=True, eq=False)
class Variant(Kind):
    """A row of one of several classes, chosen by name; the name and its keys are in the containing row."""

    classes: Mapping[str, type[Row]]

    def has_keys_inside(self) -> bool:
        return True

    def accepts(self) -> str:
        return "str | Row"

    def rule(self) -> str:
        return f"must be {either(self.classes)}"

    def name_of(self, value: Row) -> str:
        """The name of the class of a value."""
        return next(name for name, cls in self.classes.items() if type(value) is cls)

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        inner = {key: each.column for cls in self.classes.values() for key, each in keys_of(cls).items()}
        return {name: column, **inner}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if type(value) in self.classes.values():
            return value
        if isinstance(value, str) and value in self.classes:
            return self.classes[value]()
        clause = nearest(value, self.classes) if isinstance(value, str) else ""
        problems.append(Problem(path, f"{self.rule()}, not {shown(value)}{clause}"))
        return REFUSED

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        name = path[-1]
        value = self.held(table[str(name)], path, problems) if name in table else present
        if not isinstance(value, Row):
            return value
        own = keys_of(type(value))
        keys = {key: inner for key, inner in table.items() if key != name}
        for key in [key for key in keys if key not in own]:
            having = [repr(other) for other, cls in self.classes.items() if key in keys_of(cls)]
            problems.append(
                Problem(
                    (*path[:-1], key),
                    f"must go with {name} = {' or '.join(having)}, not with {self.name_of(value)!r};"
                    " leave it out, or change the other",
                )
            )
            del keys[key]
        try:
            return changed(value, keys) if keys else value
        except RowError as error:
            return _refused(error, path[:-1], problems)

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: self.name_of(value), **plain(value)}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        return difference(one, other) if type(one) is type(other) else self.written(name, other)

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return cost(one, other, own)


@dataclass(frozen=True)
class Rows(Kind):
    """A table: rows of a class with unique names; scene files write them `by_name` or as an array."""

    row_class: type[Row]
    by_name: bool = False

    def accepts(self) -> str:
        return "Sequence[Row]"

    def rule(self) -> str:
        return f"must be a list of {self.row_class.__name__} rows"

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if not isinstance(value, (list, tuple)) or len(value) > MOST_ROWS:
            problems.append(Problem(path, f"{self.rule()}, not {shown(value)}"))
            return REFUSED
        nested = Nested(self.row_class)
        rows = tuple(
            row if type(row) is self.row_class else nested.held(row, (*path, number), problems)
            for number, row in enumerate(value)
        )
        first: dict[str, int] = {}
        for number, row in enumerate(value):
            name = row.get("name") if isinstance(row, Mapping) else getattr(row, "name", None)
            if isinstance(name, str) and first.setdefault(name, number) != number:
                text = f"must be unique, not the same as {path[-1]}[{first[name] + 1}]; rename it"
                problems.append(Problem((*path, number, "name"), text))
        return REFUSED if any(row is REFUSED for row in rows) else rows

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: [plain(row) for row in value]}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        if len(one) != len(other):
            return own
        pairs = zip(one, other, strict=True)
        costs = [cost(a, b) for a, b in pairs if a is not b]
        return max((each for each in costs if each is not None), default=None)


def _refused(error: RowError, path: Path, problems: list[Problem]) -> Any:
    """Append the problems of a nested row, with its path before theirs, and return REFUSED."""
    problems.extend(problem.under(path) for problem in error.found)
    return REFUSED
