"""The exceptions of autocolor, each with the exit code of a command that fails with it.

A message names the thing, the rule it breaks, its value, its place, and what to do about it.
"""

from __future__ import annotations

from collections.abc import Iterable


class AutocolorError(Exception):
    """Base class of all errors of this package; `exit_code` is the exit code of the command."""

    exit_code = 70


class UsageError(AutocolorError, ValueError):
    """A call or a command line that is wrong, such as a name that does not exist."""

    exit_code = 2


class InputError(AutocolorError, ValueError):
    """Invalid input. `problems` holds one message for each problem; `str` joins them with line breaks."""

    exit_code = 65

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__("\n".join(self.problems))


class MissingInputError(InputError):
    """An input file or folder that does not exist."""

    exit_code = 66


class UnavailableError(AutocolorError):
    """Something that this machine lacks: a screen, or an optional package."""

    exit_code = 69


class OutputError(AutocolorError):
    """An output file that already exists, or that cannot be created at its path."""

    exit_code = 73


class WriteError(AutocolorError):
    """A write that failed; the previous content of the file is intact."""

    exit_code = 74


def reason_of(cause: Exception) -> str:
    """Why a system call failed, as a message tells it in parentheses.

    >>> reason_of(PermissionError(13, "Permission denied"))
    'permission denied'
    """
    return (getattr(cause, "strerror", None) or str(cause)).lower()
