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
    """Log the duration of a stage at the level INFO. Without a listener, the time is not measured."""
    if not logger.isEnabledFor(logging.INFO):
        yield
        return
    start = perf_counter()
    yield
    logger.info("%s: %.1f ms", stage, 1000 * (perf_counter() - start))
