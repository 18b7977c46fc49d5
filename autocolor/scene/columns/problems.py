"""The problems of rows: what is wrong where, as a message, and the placeholder for an invalid value."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import InputError

Path = tuple[str | int, ...]
"""The keys and row numbers that lead from a row to a value inside it."""

BARE: Final = re.compile(r"[\w-]{1,100}")
"""Names in a path that need no quotes."""


class Problem(NamedTuple):
    """A problem of the value at a path; the path () is the row as a whole.

    `text` is the end of a message. If `names_key`, it already contains the last key of the path.
    """

    path: Path
    text: str
    names_key: bool = False

    @property
    def sentence(self) -> str:
        """The message: the path and the text.

        >>> Problem(("flaps", "z", "on"), "must be true or false, not 3").sentence
        'flaps.z.on must be true or false, not 3'
        >>> Problem(("half_spaces", "left door", "on"), "must be true or false, not 3").sentence
        "half_spaces.'left door'.on must be true or false, not 3"
        """
        key = ""
        for part in self.path[:-1] if self.names_key else self.path:
            name = part if isinstance(part, str) and BARE.fullmatch(part) else shown(part)
            key += f"[{part + 1}]" if isinstance(part, int) else f".{name}" if key else name
        return f"{key}{'' if self.text.startswith('must ') else ':'} {self.text}" if key else self.text

    def under(self, path: Path) -> Problem:
        """The same problem with a path that starts at a row around it."""
        return self._replace(path=(*path, *self.path))


class RowError(InputError):
    """An invalid row.

    `found` are its problems; `row` is its noun and name, as in "light 'key'", or empty.
    """

    def __init__(self, found: Iterable[Problem], row: str = "") -> None:
        self.found = tuple(found)
        self.row = row
        super().__init__(f"{row}: {each.sentence}" if row else each.sentence for each in self.found)

    def __reduce__(self) -> tuple[type[RowError], tuple[object, ...]]:
        return RowError, (self.found, self.row)


class Refused:
    """The placeholder for an invalid value while the rules between columns are checked.

    It is not None, and all its comparisons are false, so that it breaks no further rule.
    """

    def __eq__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __ge__ = __lt__ = __le__ = __gt__
    __hash__ = object.__hash__


REFUSED: Final[Any] = Refused()


def unknown(name: object, known: Iterable[str]) -> Problem:
    """The problem of an unknown key, with the closest known one."""
    text = name if isinstance(name, str) else shown(name)
    clause = nearest(text, known)
    return Problem((text,), f"there is no {shown(name)}{clause}", names_key=True)
