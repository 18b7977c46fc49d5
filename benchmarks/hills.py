"""A mesh of as many polygons as are wanted."""

from __future__ import annotations

import math

import numpy as np

import autocolor


def hills(side: int) -> autocolor.Mesh:
    """A square of side x side quads, waved; from the side some of it hides behind the rest."""
    across, along = np.meshgrid(np.linspace(-1, 1, side + 1), np.linspace(-1, 1, side + 1))
    height = 0.1 * np.sin(7 * across) * np.cos(5 * along)
    row = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    quads = np.stack([row[:-1, :-1], row[:-1, 1:], row[1:, 1:], row[1:, :-1]], axis=-1).reshape(-1, 4)
    places = np.stack([across, along, height], axis=-1).reshape(-1, 3)
    return autocolor.Mesh(places, quads, np.zeros(len(quads), np.intp), ("hills",))


def side_of(polygons: int) -> int:
    """The side of the square of hills that comes nearest to a number of polygons.

    >>> side_of(1_000), side_of(1_000_000)
    (32, 1000)
    """
    return max(1, round(math.sqrt(polygons)))
