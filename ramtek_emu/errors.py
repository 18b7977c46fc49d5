"""The errors of the display. A message says the rule, the wrong value, and what to do about it.

Only Python callers get these errors: no word that a host sends raises an error.
"""

from __future__ import annotations


def escaped(text: str) -> str:
    r"""The text with an escape for each character that cannot be printed, as in names of files.

    >>> print(escaped("car\n\u202e.obj"))
    car\n\u202e.obj
    """
    if text.isprintable():
        return text
    return "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in text)


class RamtekError(Exception):
    """The base of all errors of this package: without a code of its own, an error is about bad input.

    The message is one line; what cannot be printed in it is escaped.
    """

    exit_code = 65
    """The exit code of a command that ends with this error."""

    def __init__(self, message: str = "") -> None:
        super().__init__(escaped(message))


class ConfigurationError(RamtekError, ValueError):
    """A display that cannot be built."""

    exit_code = 2


class WordsError(RamtekError, ValueError):
    """Words of a wrong type, range or shape."""


class ColorsError(RamtekError, ValueError):
    """Colors of a wrong type, range or shape, or more than the lookup table takes."""


class InstructionError(RamtekError, ValueError):
    """An instruction that cannot be encoded."""


class ReplyError(RamtekError, LookupError):
    """A host asked for more words of replies than are waiting."""


class NoScreenError(RamtekError, RuntimeError):
    """A window cannot open because there is no screen."""

    exit_code = 69


class MissingInputError(RamtekError, OSError):
    """An input file that does not exist or cannot be read."""

    exit_code = 66


class ListingError(RamtekError, ValueError):
    """A line of a listing that cannot be assembled."""


class SnapshotError(RamtekError, ValueError):
    """A file that is not a valid snapshot."""


class PortError(RamtekError, ConnectionError):
    """A display that cannot be reached, or a lost connection to a display."""

    exit_code = 69


class OutputError(RamtekError, OSError):
    """A place where no output file can be created."""

    exit_code = 73


class OutputExistsError(OutputError, FileExistsError):
    """A file that would be overwritten."""


class WriteError(RamtekError, OSError):
    """A file that could not be written."""

    exit_code = 74


def reason_of(cause: Exception) -> str:
    """The reason for a failed system call, in lower case, for the parentheses of an error's sentence."""
    return (getattr(cause, "strerror", None) or str(cause) or type(cause).__name__).lower()
