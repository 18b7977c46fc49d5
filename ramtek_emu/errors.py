"""The refusals of the display: one tree, each sentence naming thing, rule, not value, place and what to do.

They are raised to Python callers only. Words that arrive on the wire never raise anything.
"""

from __future__ import annotations


class RamtekError(Exception):
    """Every refusal of this package; `exit_code` is what a command leaves with."""

    exit_code = 70


class ConfigurationError(RamtekError, ValueError):
    """A display that cannot be built."""

    exit_code = 2


class WordsError(RamtekError, ValueError):
    """Words that do not fit: their type, their range or their shape."""

    exit_code = 65


class ColorsError(RamtekError, ValueError):
    """Colors that do not fit the lookup table: their type, their range, their shape or their number."""

    exit_code = 65


class InstructionError(RamtekError, ValueError):
    """An instruction that cannot be encoded."""

    exit_code = 65


class ReplyError(RamtekError, LookupError):
    """More words asked of the display than it has to give."""

    exit_code = 65


class NoScreenError(RamtekError, RuntimeError):
    """There is no screen to open a window on."""

    exit_code = 69


class MissingInputError(RamtekError, OSError):
    """A file to be read that is not there, or that cannot be read."""

    exit_code = 66


class ListingError(RamtekError, ValueError):
    """A line of a listing that cannot be assembled."""

    exit_code = 65


class SnapshotError(RamtekError, ValueError):
    """A file that is no snapshot of a display."""

    exit_code = 65


class PortError(RamtekError, ConnectionError):
    """A display that is not reached, or no longer."""

    exit_code = 69


class OutputError(RamtekError, OSError):
    """A place where no output can be made."""

    exit_code = 73


class OutputExistsError(OutputError, FileExistsError):
    """A file that would be overwritten."""

    exit_code = 73


class WriteError(RamtekError, OSError):
    """A file that could not be written."""

    exit_code = 74
