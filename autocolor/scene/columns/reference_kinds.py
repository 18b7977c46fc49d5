"""The kinds of columns that refer to rows of other tables by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from autocolor.scene.columns.column import Row, fields_of
from autocolor.scene.columns.value_kinds import Leaf, Text, VectorKind


@dataclass(frozen=True)
class Referring(Leaf):
    """References to rows of another table by name; the scene checks that these rows exist."""

    table: str

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
class PointOrName(Referring):
    """A point, or the name of a row of another table that gives the point."""

    def rule(self) -> str:
        return f"{VectorKind().rule()}, or a name"

    def accepts(self) -> str:
        return "str | Sequence[float]"

    def accepted(self, value: Any) -> str | tuple[float, float, float]:
        return Text().accepted(value) if isinstance(value, str) else VectorKind().accepted(value)

    def names_in(self, value: Any) -> Sequence[str]:
        return (value,) if isinstance(value, str) else ()


def references_of(cls: type[Row]) -> Mapping[str, Referring]:
    """The kinds of the fields of a row class that refer to rows of other tables, by field name."""
    found = _REFERENCES.get(cls)
    if found is None:
        kinds = {name: field.column.kind for name, field in fields_of(cls).items()}
        found = _REFERENCES[cls] = {name: kind for name, kind in kinds.items() if isinstance(kind, Referring)}
    return found


_REFERENCES: Final[dict[type[Row], Mapping[str, Referring]]] = {}
