"""Registries of file formats: which there are, and which one a file has.

The lists of what can be read, opened, completed and written are all made of these. A format is put into one
by the module that defines it; all modules of a package are imported for that.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Generic, Protocol, TypeVar

from autocolor.files.reading import read_head
from autocolor.modules import import_modules_of


class Named(Protocol):
    """What has suffixes, in lower case, and a name that is said in messages."""

    @property
    def name(self) -> str:
        """The name."""
        ...

    @property
    def suffixes(self) -> tuple[str, ...]:
        """The suffixes of its files."""
        ...


class Format(Named, Protocol):
    """What is asked of every format that is read: also how its files begin."""

    @property
    def begins(self) -> Callable[[bytes], bool] | None:
        """Whether a file that begins with these bytes may have the format; None if nothing can be told."""
        ...


SomeNamed = TypeVar("SomeNamed", bound=Named)
SomeFormat = TypeVar("SomeFormat", bound=Format)


class Registry(Generic[SomeFormat]):
    """The formats that the modules of a package define, sorted by name."""

    def __init__(self, package: str) -> None:
        self._package = package
        self._registered: list[SomeFormat] = []
        self._all: tuple[SomeFormat, ...] = ()

    def register(self, each: SomeFormat) -> SomeFormat:
        """Add a format; returns it."""
        self._registered.append(each)
        self._all = ()
        return each

    def formats(self) -> tuple[SomeFormat, ...]:
        """All formats; the modules of the package are imported first."""
        if not self._all:
            import_modules_of(self._package)
            self._all = tuple(sorted(self._registered, key=lambda each: each.name))
        return self._all


def suffixes_of(formats: Iterable[Named]) -> tuple[str, ...]:
    """The suffixes of some formats, sorted, each once."""
    return tuple(sorted({suffix for each in formats for suffix in each.suffixes}))


def format_named(path: Path, formats: Iterable[SomeNamed]) -> SomeNamed | None:
    """The format with the suffix of the path; None if there is none."""
    suffix = path.suffix.lower()
    return next((each for each in formats if suffix in each.suffixes), None)


def recognized(path: Path, formats: Sequence[SomeFormat]) -> SomeFormat | None:
    """The format of a file: that of its suffix, or another one if only that agrees with its first bytes.

    None if neither tells one.
    """
    named = format_named(path, formats)
    if named is not None and named.begins is None:
        return named
    head = read_head(path)
    if named is not None and (not head or (named.begins is not None and named.begins(head))):
        return named
    return next((each for each in formats if each.begins is not None and each.begins(head)), named)


def suffix_rule(path: Path, suffixes: Sequence[str]) -> str:
    """The rule for the suffix of a path as part of a message, and the nearest of those that there may be.

    >>> suffix_rule(Path("car.obk"), (".npz", ".obj", ".toml"))
    "end in .npz, .obj or .toml, not in '.obk'; did you mean '.obj'?"
    """
    *others, last = suffixes
    listed = f"{', '.join(others)} or {last}" if others else last
    given = f"not in {path.suffix!r}" if path.suffix else "and this one has no ending"
    near = difflib.get_close_matches(path.suffix.lower(), suffixes, 1, 0.75) if path.suffix else []
    return f"end in {listed}, {given}{f'; did you mean {near[0]!r}?' if near else ''}"
