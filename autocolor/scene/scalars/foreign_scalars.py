"""The scalars of meshes of other programs: the data of points and cells of PyVista and meshio."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices
from autocolor.immutable import read_only
from autocolor.logs import logger_of
from autocolor.scene.scalars.mesh_scalars import LARGEST_SCALAR, MOST_SCALARS, NODE, POLYGON, MeshScalar

LOG: Final = logger_of(__name__)


def foreign_scalars(
    source: object, nodes: object, owners: Indices, blocks: Sequence[int] | None
) -> tuple[MeshScalar, ...]:
    """The scalars of a mesh with `point_data` and `cell_data`; none of one without.

    Arrays of one component are taken and all others left out; a number that is infinite or above 1e30 in size
    becomes missing. `owners` has the source's polygon of each row of the polygon table, at least one of each.
    Where the data of cells are lists of one array a block, `blocks` are those of the polygons.
    """
    found: dict[str, MeshScalar] = {}
    of_polygons = (
        (name, values if blocks is None else _joined(values, blocks))
        for name, values in _items(source, "cell_data")
    )
    for of, count, rows, data in (
        (NODE, _row_count(nodes), None, _items(source, "point_data")),
        (POLYGON, int(owners.max(initial=-1)) + 1, owners, of_polygons),
    ):
        for name, given in data:
            values = _numbers(given)
            if values is None or values.shape != (count,) or len(found) >= MOST_SCALARS:
                LOG.info("data of a %s left out, since they are no scalar: %s", of, name)
                continue
            with np.errstate(invalid="ignore"):
                too_large = np.abs(values) > LARGEST_SCALAR
            if too_large.any():
                LOG.info("values of scalar %s above 1e30 in size made missing: %d", name, too_large.sum())
                values[too_large] = np.nan
            name = name if name not in found else f"{name} of {of}s"
            values = values if rows is None else values[rows]
            found.setdefault(name, MeshScalar(name, read_only(values), of))
    return tuple(found.values())


def _items(source: Any, data: str) -> Iterator[tuple[str, Any]]:
    """The names and the arrays of the data of a mesh, those of names that a scalar can have."""
    table = getattr(source, data, None)
    if table is not None and callable(getattr(table, "items", None)):
        yield from ((name, values) for name, values in table.items() if isinstance(name, str) and name)


def _row_count(table: object) -> int:
    """How many rows a table has; -1, as no array of data has, for what the checks of `Mesh` will refuse."""
    try:
        return len(np.asarray(table))
    except (TypeError, ValueError):
        return -1


def _joined(values: Any, blocks: Sequence[int]) -> object:
    """The arrays of some blocks, one after the other; None if they do not fit together."""
    try:
        return np.concatenate([np.asarray(values[block]) for block in blocks])
    except (TypeError, ValueError, LookupError):
        return None


def _numbers(given: object) -> AnyArray | None:
    """A copy of an array of one component as float64, (n,); None for anything else."""
    try:
        values = np.asarray(given)
    except (TypeError, ValueError):
        return None
    if values.dtype.kind not in "iuf" or not (values.ndim == 1 or values.shape[1:] == (1,)):
        return None
    with np.errstate(over="ignore"):
        return np.array(values.reshape(-1), np.float64)
