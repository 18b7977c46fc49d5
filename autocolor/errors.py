"""The errors of autocolor, each with the exit code that a command gives for it.

A sentence says thing, rule, not value, place, and what to do; `str(error)` is that sentence.
"""

from __future__ import annotations

from collections.abc import Iterable


class AutocolorError(Exception):
    """Anything that autocolor refuses; `exit_code` is what a command ends with."""

    exit_code = 70


class UsageError(AutocolorError, ValueError):
    """A call or a command that asks for something that does not exist."""

    exit_code = 2


class InputError(AutocolorError, ValueError):
    """Input that breaks a rule. `problems` holds every sentence, `str` joins them line by line."""

    exit_code = 65

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__("\n".join(self.problems))


class MissingInputError(InputError):
    """An input file or folder that is not there."""

    exit_code = 66


class UnavailableError(AutocolorError):
    """No screen, or an optional package that is not installed."""

    exit_code = 69


class OutputError(AutocolorError):
    """An output that exists already, or a place where none can be made."""

    exit_code = 73


class WriteError(AutocolorError):
    """A write that failed; what stood there before is still whole."""

    exit_code = 74
