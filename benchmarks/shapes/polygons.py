"""Meshes of polygons given by the places of their corners; polygons at the same place share its node."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from autocolor import Mesh
from autocolor.arrays import Booleans, Floats

DECIMALS = 9
"""Places that agree in so many decimals are the same."""

SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
"""The corners of a side, counterclockwise, in steps along the two axes after that of its normal."""


def mesh_of(name: str, *corners: Floats) -> Mesh:
    """The mesh of polygons, each array (polygons, 4, 3): counterclockwise as seen from outside.

    A quad with two neighboring corners at the same place becomes a triangle; one with fewer is dropped.
    """
    every = np.concatenate(corners)
    places = np.round(every.reshape(-1, 3), DECIMALS) + 0.0
    coordinates, numbers = np.unique(places, axis=0, return_inverse=True)
    rows = numbers.reshape(-1, 4)
    repeated = rows == np.roll(rows, -1, axis=1)
    rows, repeated = rows[repeated.sum(axis=1) < 2], repeated[repeated.sum(axis=1) < 2]
    # A triangle repeats its last node.
    turn = np.where(repeated.any(axis=1), repeated.argmax(axis=1) - 2, 0)
    rows = np.take_along_axis(rows, (np.arange(4) + turn[:, None]) % 4, axis=1)
    return Mesh(coordinates, rows, np.zeros(len(rows), np.intp), (name,))


def cells(edges: Sequence[Sequence[float] | Floats], filled: Booleans) -> Floats:
    """The sides between filled and empty cells of a grid, (polygons, 4, 3).

    `edges` are the coordinates of the cells' bounds along x, y and z; `filled` has one cell less along each.
    """
    bounds = [np.array(along, np.float64) for along in edges]
    padded = np.pad(filled, 1)
    sides = []
    for axis in range(3):
        for step in (-1, 1):
            beyond = np.roll(padded, -step, axis=axis)[1:-1, 1:-1, 1:-1]
            cell = np.argwhere(filled & ~beyond)
            first, second = (axis + 1) % 3, (axis + 2) % 3
            corners = np.empty((len(cell), 4, 3))
            for number, (along, across) in enumerate(SQUARE[::step]):
                corners[:, number, axis] = bounds[axis][cell[:, axis] + (step + 1) // 2]
                corners[:, number, first] = bounds[first][cell[:, first] + along]
                corners[:, number, second] = bounds[second][cell[:, second] + across]
            sides.append(corners)
    return np.concatenate(sides)


def sheet(places: Floats) -> Floats:
    """The quads of a grid of places, (rows, columns, 3), as (polygons, 4, 3).

    They are counterclockwise as seen from where columns go to the right and rows upward.
    """
    corners = (places[:-1, :-1], places[:-1, 1:], places[1:, 1:], places[1:, :-1])
    quads: Floats = np.stack(corners, axis=2).reshape(-1, 4, 3)
    return quads


def turned(radii: Floats, heights: Sequence[float] | Floats, angles: Floats) -> Floats:
    """The surface of an outline turned around the z axis, (polygons, 4, 3).

    `radii` is (heights, angles), or (heights, 1) for a round one. The outline goes up where it faces away
    from the axis. The angles are in radians, the first and the last a whole turn apart.
    """
    high = np.broadcast_to(np.array(heights, np.float64)[:, None], (len(heights), len(angles)))
    return sheet(np.stack([radii * np.cos(angles), radii * np.sin(angles), high], axis=-1))


def whole_turn(sides: int) -> Floats:
    """The angles of a polygon with so many sides, in radians; the last is that of the first again."""
    return np.linspace(0, 2 * np.pi, sides + 1)
