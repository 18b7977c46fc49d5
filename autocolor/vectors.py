"""Many vectors in three rows, one an axis, so that numpy works on long rows.

Measured: `np.cross` and `np.linalg.norm` of a million rows of three numbers take five times as long.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Real = TypeVar("Real", np.float32, np.float64)


def products(one: npt.NDArray[Real], other: npt.NDArray[Real]) -> npt.NDArray[Real]:
    """The product of each vector with its other; both are (3, n).

    >>> products(np.array([[2.0], [3.0], [6.0]]), np.array([[1.0], [0.0], [0.5]])).tolist()
    [5.0]
    """
    each: npt.NDArray[Real] = np.einsum("ij,ij->j", one, other)
    return each


def cross_products(one: Floats, other: Floats) -> Floats:
    """The cross product of each vector with its other; both are (3, ...).

    >>> cross_products(np.array([[1.0], [0.0], [0.0]]), np.array([[0.0], [1.0], [0.0]])).ravel().tolist()
    [0.0, 0.0, 1.0]
    """
    products = np.empty_like(one)
    for axis, product in enumerate(products):
        after, before = (axis + 1) % 3, (axis + 2) % 3
        np.multiply(one[after], other[before], out=product)
        product -= one[before] * other[after]
    return products


def lengths(vectors: Floats) -> Floats:
    """The length of each vector of (3, ...).

    >>> lengths(np.array([[2.0, 0.0], [3.0, 0.0], [6.0, 1.0]])).tolist()
    [7.0, 1.0]
    """
    squares: Floats = (vectors * vectors).sum(axis=0)
    return np.sqrt(squares, out=squares)
