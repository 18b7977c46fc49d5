"""The loggers of the library: `autocolor`, and a logger below it for each module. They are silent by default.

A program listens with `logging.getLogger("autocolor")`, and a command with `-v`. The level of records about
reading, creating and rendering is INFO.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

logging.getLogger("autocolor").addHandler(logging.NullHandler())


def logger_of(module: str) -> logging.Logger:
    """The logger of a module, given by its `__name__`."""
    return logging.getLogger(module)


@contextmanager
def timed(logger: logging.Logger, stage: str) -> Iterator[None]:
    """Log the duration of a stage at the level INFO.

    If memory runs out, the innermost stage is a note of the MemoryError.
    """
    start = perf_counter()
    try:
        yield
    except MemoryError as error:
        if not hasattr(error, "__notes__"):
            error.add_note(stage)
        raise
    logger.info("%s: %.1f ms", stage, 1000 * (perf_counter() - start))
