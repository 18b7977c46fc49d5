"""The errors of the display. A message says the rule, the wrong value, and what to do about it.

They are raised to Python callers only. Words that a host sends never raise anything.
"""

from __future__ import annotations


class RamtekError(Exception):
    """The base of all errors of this package; a command that fails with one ends with its `exit_code`."""

    exit_code = 70


class ConfigurationError(RamtekError, ValueError):
    """A display that cannot be built."""

    exit_code = 2


class WordsError(RamtekError, ValueError):
    """Words of a wrong type, range or shape."""

    exit_code = 65


class ColorsError(RamtekError, ValueError):
    """Colors of a wrong type, range or shape, or more than the lookup table takes."""

    exit_code = 65


class InstructionError(RamtekError, ValueError):
    """An instruction that cannot be encoded."""

    exit_code = 65


class ReplyError(RamtekError, LookupError):
    """A host asked for more words than the display has replied."""

    exit_code = 65


class NoScreenError(RamtekError, RuntimeError):
    """There is no screen to open a window on."""

    exit_code = 69


class MissingInputError(RamtekError, OSError):
    """An input file that does not exist or cannot be read."""

    exit_code = 66


class ListingError(RamtekError, ValueError):
    """A line of a listing that cannot be assembled."""

    exit_code = 65


class SnapshotError(RamtekError, ValueError):
    """A file that is not a valid snapshot."""

    exit_code = 65


class PortError(RamtekError, ConnectionError):
    """A display that cannot be reached, or whose connection was lost."""

    exit_code = 69


class OutputError(RamtekError, OSError):
    """A place where no output file can be created."""

    exit_code = 73


class OutputExistsError(OutputError, FileExistsError):
    """A file that would be overwritten."""

    exit_code = 73


class WriteError(RamtekError, OSError):
    """A file that could not be written."""

    exit_code = 74


def reason_of(cause: Exception) -> str:
    """Why a system call failed, as an error's sentence tells it in parentheses."""
    return (getattr(cause, "strerror", None) or str(cause) or type(cause).__name__).lower()
