"""The closeness of large arrays: that of `pytest.approx`, which compares element by element in Python."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def all_close(
    values: npt.ArrayLike, expected: npt.ArrayLike, rel: float | None = None, abs: float | None = None
) -> bool:
    """Whether each value is within the larger of both bounds, whose defaults are those of `pytest.approx`.

    The shapes must be equal. NaN is close to nothing, and infinity to itself alone.
    """
    left, right = np.asarray(values, np.float64), np.asarray(expected, np.float64)
    if left.shape != right.shape:
        return False
    relative = rel if rel is not None else 1e-6 if abs is None else 0.0
    with np.errstate(invalid="ignore"):
        near = np.abs(left - right) <= np.maximum(relative * np.abs(right), 1e-12 if abs is None else abs)
    return bool(np.all((left == right) | (near & np.isfinite(right))))
