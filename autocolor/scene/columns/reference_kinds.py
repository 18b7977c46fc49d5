"""The kinds of columns that refer to rows of other tables by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from autocolor.arrays import LARGEST_SINGLE
from autocolor.scene.columns.column import Row, fields_of
from autocolor.scene.columns.problems import REFUSED
from autocolor.scene.columns.row_kinds import Nested
from autocolor.scene.columns.value_kinds import Leaf, Number, Text


@dataclass(frozen=True)
class Referring(Leaf):
    """References to rows of another table by name; the scene checks that these rows exist."""

    table: str

    @property
    def words(self) -> tuple[str, ...]:
        """What may stand for a name, and is none."""
        return ()

    def names_in(self, value: Any) -> Sequence[str]:
        """The names that a value refers to."""
        raise NotImplementedError


@dataclass(frozen=True)
class Reference(Referring):
    """The name of a row of another table."""

    def rule(self) -> str:
        return Text().rule()

    def accepts(self) -> str:
        return "str"

    def accepted(self, value: Any) -> str:
        return Text().accepted(value)

    def names_in(self, value: Any) -> Sequence[str]:
        return (value,)


@dataclass(frozen=True)
class WordOrName(Referring):
    """A word that means the same in every scene, or else the name of a row of another table."""

    word: str

    @property
    def words(self) -> tuple[str, ...]:
        return (self.word,)

    def rule(self) -> str:
        return f"must be {self.word!r} or the name of one of the {self.table}"

    def accepts(self) -> str:
        return "str"

    def accepted(self, value: Any) -> str:
        return Text().accepted(value)

    def names_in(self, value: Any) -> Sequence[str]:
        return () if value == self.word else (value,)


@dataclass(frozen=True)
class References(Referring):
    """A list of names of rows of another table."""

    def rule(self) -> str:
        return "must be a list of names"

    def accepts(self) -> str:
        return "Sequence[str]"

    def accepted(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, (list, tuple)):
            raise TypeError
        return tuple(Text().accepted(name) for name in value)

    def names_in(self, value: Any) -> Sequence[str]:
        return tuple(value)


@dataclass(frozen=True)
class RangesByName(Referring):
    """The word `none`, or ranges [minimum, maximum] by the name of a row, or by the name `others`.

    They are held as pairs of a name and a range. Numbers are at least 0, and each maximum above its minimum.
    """

    none: str
    others: str

    @property
    def words(self) -> tuple[str, ...]:
        return (self.others,)

    def rule(self) -> str:
        return (
            f"must be {self.none!r}, or a table of ranges [minimum, maximum] from 0 to 3.4e38 by the names of"
            f" {self.table} and {self.others!r}"
        )

    def accepts(self) -> str:
        return "str | Mapping[str, Sequence[float]] | Sequence[tuple[str, Sequence[float]]]"

    def accepted(self, value: Any) -> str | tuple[tuple[str, tuple[float, float]], ...]:
        if isinstance(value, str):
            if value != self.none:
                raise ValueError
            return self.none
        pairs = list(value.items()) if isinstance(value, Mapping) else list(value)
        intensity = Number(at_least=0, at_most=LARGEST_SINGLE).accepted
        ranges = tuple(
            (Text().accepted(name), (intensity(minimum), intensity(maximum)))
            for name, (minimum, maximum) in pairs
        )
        names = [name for name, _ in ranges]
        if not ranges or len(set(names)) < len(names) or not all(low < high for _, (low, high) in ranges):
            raise ValueError
        return ranges

    def names_in(self, value: Any) -> Sequence[str]:
        return () if isinstance(value, str) else [name for name, _ in value if name != self.others]

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: value if isinstance(value, str) else {key: list(limits) for key, limits in value}}


class ReferenceAt(NamedTuple):
    """A column that refers to other rows: its kind, and the fields that lead to it from the row."""

    kind: Referring
    path: tuple[str, ...]

    def value_in(self, row: Row) -> Any:
        """The value in a row, which may be None or REFUSED."""
        value: Any = row
        for name in self.path:
            value = vars(value)[name] if isinstance(value, Row) else REFUSED
        return value


def references_of(cls: type[Row]) -> Mapping[str, ReferenceAt]:
    """The columns of a row class that refer to rows of other tables, by key."""
    found = _REFERENCES.get(cls)
    if found is None:
        found = _REFERENCES[cls] = {}
        for name, field in fields_of(cls).items():
            kind = field.column.kind
            if isinstance(kind, Referring):
                found[name] = ReferenceAt(kind, (name,))
            elif isinstance(kind, Nested) and kind.inline:
                inner = references_of(kind.row_class)
                found |= {key: each._replace(path=(name, *each.path)) for key, each in inner.items()}
    return found


_REFERENCES: Final[dict[type[Row], dict[str, ReferenceAt]]] = {}
