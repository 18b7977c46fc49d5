"""The tests of the renderer run as in a program that has numpy raise floating-point errors."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

RENDERER = ("scene", "visibility", "scalars", "lighting", "mapping", "test_floating_point.py")


@pytest.fixture(autouse=True)
def floating_point_errors(request: pytest.FixtureRequest) -> Iterator[None]:
    """Raise FloatingPointError wherever numpy would be silent or warn.

    A function that expects an underflow, an overflow or a division by zero says so with `np.errstate`.
    """
    inside = request.path.relative_to(Path(__file__).parent).parts[0] in RENDERER
    with np.errstate(all="raise" if inside else None):
        yield
