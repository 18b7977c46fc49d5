"""The mesh: the node table and the polygon table.

Paper: "Introduction". The shape of an object is a mesh of polygons with three or four sides, defined by two
tables: nodes with their coordinates, and polygons with the numbers of their nodes. A `Mesh` checks both
tables, and they never change afterwards.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import EllipsisType
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, used_bounds, used_rows
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable, read_only
from autocolor.logs import logger_of, timed
from autocolor.scene.columns import Problem
from autocolor.scene.geometry.curvature import Curvatures, curvatures
from autocolor.scene.geometry.diagonals import Diagonals, quad_diagonals
from autocolor.scene.geometry.foreign_meshes import foreign_tables
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals, edge_keys, node_normals
from autocolor.scene.geometry.planes import SharedPlanes, shared_planes
from autocolor.scene.kinds import Number
from autocolor.scene.scalar import MeshScalar, joined_scalars, scalar_problems

LOG: Final = logger_of(__name__)

CREASE_ANGLES: Final = Number(at_least=0, at_most=180)
"""The kind of a crease angle, in degrees."""

PART: Final = "mesh"
"""The name of the part of a mesh without parts."""

UNIT: Final = 1e-5
"""Assumed: how far the square of the length of an own normal may be from 1."""

BYTES_OF_NORMALS: Final = 160
"""Measured: bytes a polygon while its normals are computed."""


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(Immutable):
    """The node table and the polygon table.

    `coordinates` is (nodes, 3) float64. `node_numbers` is (polygons, 4) intp, rows of the node table counted
    from 0; a triangle repeats its last node, and (polygons, 3) is accepted if all are triangles.
    `part_numbers` is (polygons,) intp, rows of `part_names` counted from 0; without part numbers all
    polygons belong to the first part. Polygons that meet at more than `crease_angle` degrees keep a sharp
    edge. The tables are copied and stored by columns (Fortran order), so that `.T` is the contiguous array
    that the renderer works on. `scalars` are numbers at the nodes or polygons. `own_normals` are the normals
    of a file, which are used instead of computed ones.

    `Mesh.of` converts meshes of other programs, and splits polygons of more than four sides and quads whose
    sides cross, as files are split. The tables given here keep such quads, and not all of them are filled.
    """

    coordinates: Floats
    node_numbers: Indices
    part_numbers: Indices = None  # type: ignore[assignment]
    part_names: tuple[str, ...] = (PART,)
    crease_angle: float = CREASE_ANGLE
    scalars: tuple[MeshScalar, ...] = ()
    own_normals: NodeNormals | None = None

    def __post_init__(self) -> None:
        problems: list[str] = []
        coordinate_rows = _rows(problems, "node table", self.coordinates, np.float64, (3,))
        has_nodes = not problems
        node_rows = _rows(problems, "polygon table", self.node_numbers, np.intp, (3, 4))
        if len(node_rows) == 3:
            node_rows = node_rows[[0, 1, 2, 2]]
        given = np.zeros(node_rows.shape[1], np.intp) if self.part_numbers is None else self.part_numbers
        part_numbers = np.array(_numbers(problems, "part numbers", given, np.intp), ndmin=1)
        node_count, polygon_count = coordinate_rows.shape[1], node_rows.shape[1]
        wrong = ~(np.abs(coordinate_rows) <= LARGEST_COORDINATE).all(axis=0)
        if wrong.any():
            problems.append(
                f"node table: coordinates must be finite and at most 1e30 in size, not"
                f" {coordinate_rows[:, wrong.argmax()].tolist()} (row {wrong.argmax()})"
            )
        names = tuple(self.part_names) if isinstance(self.part_names, (list, tuple)) else (None,)
        if not all(isinstance(name, str) and name for name in names):
            rule = "part names must be strings, one for each part"
            problems.append(f"part table: {rule}, not {shown(self.part_names)}")
        elif len(set(names)) != len(names):
            problems.append("part table: part names must differ, not repeat")
        if has_nodes:
            _check_rows(problems, "polygon table: a node number", node_rows, node_count, "node table")
        _check_rows(problems, "polygon table: a part number", part_numbers, len(names), "part table")
        if part_numbers.shape != (polygon_count,):
            problems.append(
                f"polygon table: there must be one part number a polygon ({polygon_count}), not an"
                f" array of shape {part_numbers.shape}"
            )
        of_angle: list[Problem] = []
        angle = CREASE_ANGLES.validated(self.crease_angle, ("crease_angle",), of_angle)
        problems.extend(f"mesh: {problem.sentence}" for problem in of_angle)
        scalars = tuple(self.scalars)
        problems.extend(scalar_problems(scalars, node_count, polygon_count))
        if self.own_normals is not None:
            problems.extend(_problems_of_normals(self.own_normals, polygon_count))
        if problems:
            raise InputError(problems)
        for table in (coordinate_rows, node_rows, part_numbers):
            read_only(table)
        for name, value in (
            ("coordinates", coordinate_rows.T),
            ("node_numbers", node_rows.T),
            ("part_numbers", part_numbers),
            ("part_names", names),
            ("crease_angle", angle),
            ("scalars", scalars),
        ):
            object.__setattr__(self, name, value)

    @cached_property
    def normals(self) -> NodeNormals:
        """Unit normals at the corners of the polygons: the file's, or computed from the adjoining polygons.

        Raises InputError if that takes more memory than the budget allows, such as for a sparse mapped file.
        """
        own = self.own_normals
        if own is not None and own.are_complete:
            return own
        require_memory(
            BYTES_OF_NORMALS * len(self.node_numbers),
            f"the normals of {len(self.node_numbers):,} polygons",
            "write the mesh with its normals by `autocolor convert MESH OUT --to npy`",
        )
        with timed(LOG, "node normals"):
            computed = node_normals(self.coordinates, self.node_numbers, self.part_numbers, self.crease_angle)
        return computed if own is None else own.completed(computed)

    @cached_property
    def curvatures(self) -> Curvatures:
        """Mean and Gaussian curvature at each of the normals."""
        with timed(LOG, "curvatures"):
            return curvatures(self.coordinates, self.node_numbers, self.normals)

    @cached_property
    def shared_planes(self) -> SharedPlanes | None:
        """The planes in which polygons may overlap; None if there are none."""
        return shared_planes(self.coordinates, self.node_numbers)

    @cached_property
    def diagonals(self) -> Diagonals:
        """The diagonals along which quads are cut, if a picture must not change as the camera rolls."""
        return quad_diagonals(self.coordinates, self.node_numbers)

    @property
    def used_coordinates(self) -> Floats:
        """The coordinates of the nodes that polygons use, (nodes, 3), stored by columns."""
        return self._coordinates_of(self.node_numbers)

    def coordinates_of_parts(self, part_numbers: Sequence[int]) -> Floats:
        """The coordinates of the nodes that the polygons of some parts use, (nodes, 3), stored by columns."""
        chosen = np.zeros(len(self.part_names), np.bool_)
        chosen[list(part_numbers)] = True
        return self._coordinates_of(self.node_numbers[chosen[self.part_numbers]])

    def _coordinates_of(self, node_numbers: Indices) -> Floats:
        used = used_rows(node_numbers.T, len(self.coordinates))
        return self.coordinates if used.all() else np.compress(used, self.coordinates.T, axis=1).T

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        """The least and the largest coordinates of the nodes that polygons use; zeros for an empty mesh."""
        if not len(self.node_numbers):
            return read_only(np.zeros(3)), read_only(np.zeros(3))
        low, high = used_bounds(self.coordinates.T, self.node_numbers.T)
        return read_only(low), read_only(high)

    @cached_property
    def parts_in_use(self) -> tuple[int, ...]:
        """The numbers of the parts that have polygons."""
        used = used_rows(self.part_numbers[None], len(self.part_names))
        return tuple(np.flatnonzero(used).tolist())

    @property
    def edge_count(self) -> int:
        """How many distinct edges the polygons have (the paper counts 17,940 for its car)."""
        start = self.node_numbers.T
        keys = edge_keys(start, np.roll(start, -1, axis=0), len(self.coordinates))
        # The edge from a node to itself in a triangle, with the key -1, does not count.
        return len(np.unique(keys[keys >= 0]))

    @property
    def triangle_count(self) -> int:
        """How many polygons have three sides."""
        return int(np.count_nonzero(self.node_numbers[:, 2] == self.node_numbers[:, 3]))

    @classmethod
    def of(
        cls, source: object, polygons: object = None, *, part: str = PART, crease_angle: float = CREASE_ANGLE
    ) -> Mesh:
        """A mesh of one part, from a mesh of trimesh, PyVista or meshio, or from nodes and polygons.

        Polygons may have any number of sides from three on; polygons of more than four are split. Data of one
        component at the points or the cells of PyVista and meshio become scalars. A Mesh is returned
        unchanged. Raises InputError, and UsageError for any other source.

            >>> Mesh.of([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2, 3]])
            Mesh(nodes 4, polygons 2, parts 1)
        """
        if isinstance(source, Mesh) and polygons is None:
            return source
        nodes, table, scalars = foreign_tables(source, polygons)
        return cls(nodes, table, None, (part,), crease_angle, scalars)  # type: ignore[arg-type]

    @classmethod
    def of_tables(
        cls,
        coordinates: Floats,
        node_numbers: Indices,
        part_numbers: Indices,
        part_names: tuple[str, ...],
        crease_angle: float = CREASE_ANGLE,
        scalars: tuple[MeshScalar, ...] = (),
        *,
        normals: NodeNormals | None = None,
        shared_planes: SharedPlanes | EllipsisType | None = ...,
    ) -> Mesh:
        """The mesh with these tables themselves, without checks or copies: they may be mapped files.

        Tables and normals must have the types of their fields, and be stored by columns and read-only.
        Normals and planes are computed if they are not given.
        """
        mesh = object.__new__(cls)
        vars(mesh).update(
            coordinates=coordinates,
            node_numbers=node_numbers,
            part_numbers=part_numbers,
            part_names=part_names,
            crease_angle=crease_angle,
            scalars=scalars,
        )
        if normals is not None:
            vars(mesh)["normals"] = normals
        if shared_planes is not ...:
            vars(mesh)["shared_planes"] = shared_planes
        return mesh

    def with_scalars(self, *scalars: MeshScalar) -> Mesh:
        """The mesh with these scalars and no others; both share the tables and everything computed from them.

        Raises InputError if a scalar does not fit the mesh.
        """
        problems = list(scalar_problems(scalars, len(self.coordinates), len(self.node_numbers)))
        if problems:
            raise InputError(problems)
        copy = object.__new__(Mesh)
        vars(copy).update({**vars(self), "scalars": scalars})
        return copy

    @staticmethod
    def joined(meshes: Sequence[Mesh]) -> Mesh:
        """One mesh of several; parts of the same name become one part. The first crease angle counts."""
        if len(meshes) == 1:
            return meshes[0]
        names = tuple(dict.fromkeys(name for mesh in meshes for name in mesh.part_names))
        first_nodes = np.cumsum([0] + [len(mesh.coordinates) for mesh in meshes[:-1]])
        row_of = {name: row for row, name in enumerate(names)}
        rows = [np.array([row_of[name] for name in mesh.part_names], dtype=np.intp) for mesh in meshes]
        return Mesh(
            np.concatenate([mesh.coordinates.T for mesh in meshes], axis=1).T,
            np.concatenate(
                [mesh.node_numbers.T + first for mesh, first in zip(meshes, first_nodes, strict=True)], axis=1
            ).T,
            np.concatenate([row[mesh.part_numbers] for mesh, row in zip(meshes, rows, strict=True)]),
            names,
            meshes[0].crease_angle,
            joined_scalars(
                [mesh.scalars for mesh in meshes],
                [len(mesh.coordinates) for mesh in meshes],
                [len(mesh.node_numbers) for mesh in meshes],
            ),
            NodeNormals.joined(
                [mesh.own_normals for mesh in meshes], [len(mesh.node_numbers) for mesh in meshes]
            ),
        )

    def __repr__(self) -> str:
        nodes, polygons, parts = len(self.coordinates), len(self.node_numbers), len(self.part_names)
        return f"Mesh(nodes {nodes}, polygons {polygons}, parts {parts})"


def _numbers(problems: list[str], what: str, value: object, dtype: type) -> AnyArray:
    """The value as an array of the type; if that is impossible, a problem is noted and the array is empty."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        array = np.array(None)
    if array.size and array.dtype.kind not in ("iu" if dtype is np.intp else "iuf"):
        kind = "whole numbers" if dtype is np.intp else "numbers"
        given = f"of {array.dtype}" if array.dtype.kind in "bcf" else type(value).__name__
        problems.append(f"{what}: it must be an array of {kind}, not {given}; convert it")
        array = np.empty(0)
    return array.astype(dtype, copy=False)


def _rows(problems: list[str], what: str, value: object, dtype: type, widths: tuple[int, ...]) -> AnyArray:
    """A copy of the value, (rows, width), as contiguous (width, rows); empty if a problem is noted."""
    array = _numbers(problems, what, value, dtype)
    if array.size == 0:
        array = array.reshape(0, widths[-1])
    if array.ndim != 2 or array.shape[1] not in widths:
        shape = " or ".join(f"(rows, {width})" for width in widths)
        problems.append(f"{what}: its shape must be {shape}, not {array.shape}")
        array = np.empty((0, widths[-1]), dtype)
    return np.array(array.T, order="C")


def _problems_of_normals(normals: NodeNormals, polygons: int) -> Iterator[str]:
    """A sentence for each fault of the normals of a file."""
    vectors, numbers = normals.vectors, normals.numbers
    if numbers.shape != (polygons, 4) or numbers.dtype != np.intp:
        yield f"own normals: their numbers must be intp of shape {(polygons, 4)}, not {numbers.shape}"
    elif numbers.min(initial=0) < -1 or numbers.max(initial=-1) >= len(vectors):
        yield f"own normals: a number must be from -1 to {len(vectors) - 1}; correct it"
    if vectors.dtype != np.float32 or not (np.abs((vectors**2).sum(axis=1) - 1) < UNIT).all():
        yield "own normals: they must be unit vectors of float32; normalize them"


def _check_rows(problems: list[str], what: str, numbers: Indices, count: int, table: str) -> None:
    """Note the first number, or the first column of numbers, that is no row of a table."""
    missing = np.atleast_2d((numbers < 0) | (numbers >= count)).any(axis=0)
    if missing.any():
        row = int(missing.argmax())
        rule = f"{what} must be a row of the {table} (0 to {count - 1})"
        problems.append(f"{rule}, not {numbers[..., row].tolist()} (row {row})")


def has_same_tables(one: Mesh, other: Mesh) -> bool:
    """Whether all tables, scalars and own normals of two meshes are equal, whatever their crease angles."""
    if one is other:
        return True
    if one.part_names != other.part_names:
        return False
    ones, others = _arrays(one), _arrays(other)
    return list(ones) == list(others) and all(
        np.array_equal(array, others[name], equal_nan=True) for name, array in ones.items()
    )


def _arrays(mesh: Mesh) -> dict[tuple[str, str], AnyArray]:
    """The tables, scalars and own normals at the corners of a mesh, by name and what they are of."""
    arrays: dict[tuple[str, str], AnyArray] = {
        (name, "mesh"): vars(mesh)[name] for name in ("coordinates", "node_numbers", "part_numbers")
    }
    arrays |= {(scalar.name, scalar.of): scalar.values for scalar in mesh.scalars}
    if (own := mesh.own_normals) is not None:
        # A corner without a normal has the number -1.
        arrays["normals", "mesh"] = np.append(own.vectors, np.full((1, 3), np.nan, np.float32), axis=0)[
            own.numbers
        ]
    return arrays
