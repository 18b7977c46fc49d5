"""Scalars of a mesh from the arrays of a file: of one or several components, with any values.

- An array of one component becomes a scalar with its name.
- A vector (two or three components) becomes its length, as in "velocity magnitude".
- A tensor (six components in the order xx, yy, zz, xy, yz, xz, or nine) becomes von Mises' stress, as in
  "stress von Mises".
- An array of another size is skipped, and a message says so.
- A value that is infinite or above 1e30 in size becomes missing, and is counted.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.files.meshes.repair import different, printable_name
from autocolor.files.reading import shown
from autocolor.immutable import read_only
from autocolor.scene.scalar import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

SYMMETRIC: Final = (0, 3, 5, 3, 1, 4, 5, 4, 2)
"""The place of each of the nine components of a tensor among six."""


class FileScalars:
    """Collects the scalars of a file, with different names, and sentences about what was left out."""

    def __init__(self) -> None:
        self._scalars: dict[str, list[tuple[str, Floats]]] = {NODE: [], POLYGON: []}
        self._sentences: list[str] = []
        self._skipped = 0

    def add(self, name: str, values: AnyArray, of: str, rows: Indices | None = None) -> None:
        """Add an array, (rows,) or (rows, components), or the given `rows` of it, in their order."""
        name = printable_name(name) or "scalar"
        values = values if rows is None else values[rows]
        values = values.reshape(len(values), -1) if values.size else values.reshape(len(values), 1)
        if sum(map(len, self._scalars.values())) >= MOST_SCALARS:
            self._skipped += 1
        elif (found := _one_component(values)) is None:
            self._sentences.append(
                f"skipped the {of} array {shown(name)}, which has {values.shape[1]:,} components"
            )
        else:
            what, numbers = found
            with np.errstate(invalid="ignore"):
                is_large = np.abs(numbers) > LARGEST_SCALAR
            if count := int(is_large.sum()):
                numbers = np.where(is_large, np.nan, numbers)
                self._sentences.append(
                    f"scalar {shown(name + what)}: values above 1e30 in size were made missing: {count:,}"
                )
            self._scalars[of].append((name + what, numbers))

    @property
    def scalars(self) -> tuple[MeshScalar, ...]:
        """The scalars, those of nodes first."""
        all_scalars = [(of, *each) for of, several in self._scalars.items() for each in several]
        of_nodes = different([name for name, _ in self._scalars[NODE]])
        names = different([*of_nodes, *(name for name, _ in self._scalars[POLYGON])], f" of {POLYGON}s")
        return tuple(
            MeshScalar(name, read_only(np.array(values, np.float64)), of)
            for name, (of, _, values) in zip(names, all_scalars, strict=True)
        )

    @property
    def messages(self) -> tuple[str, ...]:
        """Sentences about what was left out or made missing."""
        more = f"skipped {self._skipped:,} arrays: a mesh has at most {MOST_SCALARS:,} scalars"
        return (*self._sentences, more) if self._skipped else tuple(self._sentences)


def _one_component(values: AnyArray) -> tuple[str, Floats] | None:
    """The ending of a scalar's name, and its values, (rows,); None for other numbers of components."""
    components = values.shape[1]
    values = values.astype(np.float64, copy=False)
    with np.errstate(over="ignore", invalid="ignore"):
        if components == 1:
            return "", values[:, 0]
        if components in (2, 3):
            return " magnitude", np.sqrt((values * values).sum(axis=1))
        if components in (6, 9):
            return " von Mises", von_mises(values if components == 9 else values[:, SYMMETRIC])
    return None


def von_mises(tensors: Floats) -> Floats:
    """Von Mises' equivalent stress of stress tensors, (n, 9), of which the symmetric part counts."""
    stresses = (tensors + tensors[:, [0, 3, 6, 1, 4, 7, 2, 5, 8]]) / 2
    deviators = stresses - stresses[:, [0, 4, 8]].mean(axis=1)[:, None] * np.eye(3).ravel()
    stress: Floats = np.sqrt(1.5 * (deviators**2).sum(axis=1))
    return stress
