from __future__ import annotations

import doctest

import numpy as np
import pytest

from autocolor import vectors
from autocolor.vectors import cross_products, lengths


def test_the_examples_hold() -> None:
    assert doctest.testmod(vectors).failed == 0


@pytest.mark.parametrize("shape", [(3, 0), (3, 5), (3, 4, 6)])
def test_they_are_those_that_numpy_has_for_columns(shape: tuple[int, ...]) -> None:
    one, other = np.random.default_rng(3).normal(size=(2, *shape))
    assert cross_products(one, other).tolist() == np.cross(one, other, axis=0).tolist()
    assert lengths(one) == pytest.approx(np.linalg.norm(one, axis=0))
