"""Writing files atomically: after any failure, either the old or the new file is there, complete.

`ramtek_emu.writing` does the work. Its errors become errors of this package.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import ramtek_emu
from autocolor.errors import OutputError, UsageError, WriteError
from ramtek_emu import writing


def write_atomically(path: str | os.PathLike[str], data: bytes, *, overwrite: bool) -> None:
    """Write the bytes to a temporary file beside the path, sync it, and rename it to the path.

    Raises OutputError if the path exists and `overwrite` is false, or if no file can be created there;
    WriteError if writing fails. In both cases the old file, if any, is intact.
    """
    with _refusals_of_this_package():
        writing.write_atomically(path, data, overwrite=overwrite)


def write_together(
    files: Iterable[tuple[Path, Iterable[bytes]]],
    *,
    overwrite: bool,
    before_names: Callable[[], None] = lambda: None,
) -> None:
    """Write files piece by piece, and rename all of them when they are whole, in their order.

    `before_names` is called before that. Raises OutputError and WriteError as `write_atomically` does.
    """
    with _refusals_of_this_package(), ExitStack() as stack:
        outputs = []
        for path, pieces in files:
            outputs.append(stack.enter_context(writing.Output(path, overwrite=overwrite)))
            for piece in pieces:
                outputs[-1].write(piece)
        before_names()
        for output in outputs:
            output.keep()


def refuse_output(path: str | os.PathLike[str], *, overwrite: bool) -> None:
    """Raise OutputError if no file can be written to the path; for use before an expensive computation."""
    with _refusals_of_this_package():
        writing.refuse_output(path, overwrite)


def check_suffix(path: str | os.PathLike[str], suffix: str, what: str) -> None:
    """Raise UsageError if the name of a file does not end in a suffix; `what` is written to it."""
    if Path(path).suffix.lower() != suffix:
        raise UsageError(f"{what} must be written to a file that ends in {suffix}, not to {path}; rename it")


@contextmanager
def _refusals_of_this_package() -> Iterator[None]:
    try:
        yield
    except ramtek_emu.OutputError as refusal:
        raise OutputError(str(refusal)) from None
    except ramtek_emu.WriteError as refusal:
        raise WriteError(str(refusal)) from None
