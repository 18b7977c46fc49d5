from __future__ import annotations

import inspect

import pytest

import ramtek_emu
from ramtek_emu import errors

TREE = {name: error for name, error in inspect.getmembers(errors, inspect.isclass)}
KINDS = {
    "RamtekError": (65, Exception),
    "ConfigurationError": (2, ValueError),
    "WordsError": (65, ValueError),
    "ColorsError": (65, ValueError),
    "InstructionError": (65, ValueError),
    "ReplyError": (65, LookupError),
    "ListingError": (65, ValueError),
    "SnapshotError": (65, ValueError),
    "MissingInputError": (66, OSError),
    "NoScreenError": (69, RuntimeError),
    "PortError": (69, ConnectionError),
    "OutputError": (73, OSError),
    "OutputExistsError": (73, FileExistsError),
    "WriteError": (74, OSError),
}
"""The exit codes, and the errors of Python that ours are like."""


def test_each_refusal_is_public_and_has_its_exit_code_and_its_error_of_python() -> None:
    assert TREE.keys() == KINDS.keys()
    for name, (code, built_in) in KINDS.items():
        error = getattr(ramtek_emu, name)
        assert (error, error.exit_code) == (TREE[name], code)
        with pytest.raises(built_in, match="sentence"):
            raise error("sentence")
        assert issubclass(error, errors.RamtekError)
