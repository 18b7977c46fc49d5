"""The exceptions of autocolor, with the exit codes of commands, and a warning.

A message names the thing, the rule that it breaks, its value, its place, and what to do.
"""

from __future__ import annotations

from collections.abc import Iterable
from warnings import warn

from ramtek_emu.errors import escaped


class AutocolorError(Exception):
    """Base class of all errors of this package. `exit_code` is the exit code of a command that fails.

    `problems` holds one message for each problem; `str` joins them with line breaks. In a message, whatever
    cannot be printed is escaped.
    """

    exit_code = 70

    def __init__(self, problems: str | Iterable[str] = ()) -> None:
        self.problems = tuple(map(escaped, (problems,) if isinstance(problems, str) else problems))
        super().__init__("\n".join(self.problems))


class UsageError(AutocolorError, ValueError):
    """A wrong call or command line, such as an unknown name."""

    exit_code = 2


class InputError(AutocolorError, ValueError):
    """Invalid input."""

    exit_code = 65


class MissingInputError(InputError):
    """An input file or folder that does not exist."""

    exit_code = 66


class UnavailableError(AutocolorError):
    """A screen or an optional package that is missing, a display without an answer, or workers that ended."""

    exit_code = 69


class OutputError(AutocolorError):
    """An output file that already exists, or that cannot be created at its path."""

    exit_code = 73


class WriteError(AutocolorError):
    """A write that failed; the previous content of the file is intact."""

    exit_code = 74


class EditWarning(UserWarning):
    """An edit that no picture shows: of a surface without polygons, or to values that are there already."""


def warn_of_edit(sentence: str) -> None:
    """Issue an EditWarning, unless the sentence is empty, at the line that called a method of a studio."""
    if sentence:
        # Between are this function, the method, and the function around it (see `threads`).
        warn(sentence, EditWarning, stacklevel=4)


def reason_of(cause: Exception) -> str:
    """The reason of a failed system call, for the parentheses of a message.

    >>> reason_of(PermissionError(13, "Permission denied"))
    'permission denied'
    """
    return (getattr(cause, "strerror", None) or str(cause)).lower()
