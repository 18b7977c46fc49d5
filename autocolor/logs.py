"""The loggers of the library, `autocolor` and one below it for each module: silent unless somebody listens.

A program listens by `logging.getLogger("autocolor")`, and a command with `-v`. What was read, created and
rendered is at the level INFO.
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
    """Log how long a stage takes, at the level INFO; no time is taken if nobody listens."""
    if not logger.isEnabledFor(logging.INFO):
        yield
        return
    start = perf_counter()
    yield
    logger.info("%s: %.1f ms", stage, 1000 * (perf_counter() - start))
