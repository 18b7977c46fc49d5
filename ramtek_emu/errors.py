"""The refusals of the display: one tree, each sentence naming thing, rule, not value, place and what to do.

They are raised to Python callers only. Words that arrive on the wire never raise anything.
"""


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


class OutputExistsError(RamtekError, FileExistsError):
    """A file that would be overwritten."""

    exit_code = 73


class WriteError(RamtekError, OSError):
    """A file that could not be written."""

    exit_code = 74
