"""Writing that leaves the old file or the new one, whole, whatever happens in between.

The display writes its files in the same way; here its refusals become those of this package.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import ramtek_emu
from autocolor.errors import OutputError, WriteError
from ramtek_emu import writing


def write_atomically(path: str | os.PathLike[str], data: bytes, *, overwrite: bool) -> None:
    """Write the bytes beside the path, sync them, and give them its name.

    Raises OutputError where the path exists and may not be overwritten, or where nothing can be put;
    WriteError where writing failed. Nothing but a whole old or new file is left in either case.
    """
    with _refusals_of_this_package():
        writing.write_atomically(path, data, overwrite=overwrite)


def refuse_output(path: str | os.PathLike[str], *, overwrite: bool) -> None:
    """Raise OutputError where no output can be put, before anything is computed for it."""
    with _refusals_of_this_package():
        writing.refuse_output(path, overwrite)


@contextmanager
def _refusals_of_this_package() -> Iterator[None]:
    try:
        yield
    except ramtek_emu.OutputError as refusal:
        raise OutputError(str(refusal)) from None
    except ramtek_emu.WriteError as refusal:
        raise WriteError(str(refusal)) from None
