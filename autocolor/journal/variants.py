"""Variants: scenes that were kept under names, to come back to and to compare."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from string import ascii_uppercase
from typing import Final, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import UsageError
from autocolor.journal.places import Place
from autocolor.scene.scene import Scene

MOST_VARIANTS: Final = 1000
LONGEST_NAME: Final = 100


class Opened(NamedTuple):
    """A scene with the place that it belongs to."""

    scene: Scene
    place: Place


class Variants(Mapping[str, Opened]):
    """Kept scenes by name, in the order in which they were kept; an immutable value."""

    def __init__(self, kept: Mapping[str, Opened] | None = None) -> None:
        self._kept = dict(kept or {})

    def __getitem__(self, name: str) -> Opened:
        """The scene of a name. Raises UsageError, with the closest name, if there is none."""
        if name not in self._kept:
            raise UsageError(f"there is no variant {shown(name)}{nearest(str(name), self._kept)}")
        return self._kept[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kept)

    def __len__(self) -> int:
        return len(self._kept)

    def __contains__(self, name: object) -> bool:
        return name in self._kept

    def with_kept(self, name: str, opened: Opened) -> Variants:
        """These and another one. Raises UsageError for a name that is in use, empty or too long."""
        if not isinstance(name, str) or not 0 < len(name) <= LONGEST_NAME:
            raise UsageError(
                f"a variant must have a name of 1 to {LONGEST_NAME} characters, not {shown(name)};"
                " choose another"
            )
        if name in self._kept:
            raise UsageError(
                f"a variant must have a name of its own, and {shown(name)} is in use; choose another, or drop"
                " that one"
            )
        if len(self._kept) >= MOST_VARIANTS:
            raise UsageError(f"there must be at most {MOST_VARIANTS} variants; drop one")
        return Variants({**self._kept, name: opened})

    def without(self, name: str) -> Variants:
        """These without one. Raises UsageError if there is none of that name."""
        self[name]
        return Variants({each: kept for each, kept in self._kept.items() if each != name})

    def free_name(self) -> str:
        """The first of A, B, C ... Z, A2, B2 ... that is not in use."""
        names = (f"{letter}{number or ''}" for number in _numbers() for letter in ascii_uppercase)
        return next(name for name in names if name not in self._kept)


def _numbers() -> Iterator[int]:
    """0 for the first letters, then 2, 3, 4 and so on."""
    yield 0
    yield from count(2)
