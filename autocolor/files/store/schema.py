"""The tables of a store: their names, their columns and how they are made.

Every table of a scene has one, and so have the node table, the polygon table and the scalars of the mesh. All
are STRICT, and tell what a value must be and which rows it refers to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from autocolor.checks import LARGEST_COORDINATE
from autocolor.files.store.sql_columns import NUMBER, SqlColumn, checked, columns_of, quoted
from autocolor.scene.columns.column import Row, fields_of
from autocolor.scene.columns.row_kinds import Nested, Rows
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON
from autocolor.scene.scene import Scene

APPLICATION: Final = 0x47_4D_41_43
"""The number in the header of our stores: GMAC, for GM AUTOCOLOR."""

VERSION: Final = 1
"""The version of the tables, `PRAGMA user_version`."""

SCENE: Final = "scene"
MESH: Final = "mesh"
NODES: Final = "nodes"
POLYGONS: Final = "polygons"
SCALARS: Final = "mesh_scalars"
IN_DEGREES: Final = "crease_angle BETWEEN 0 AND 180"

VALUES: Final = {NODE: "node_scalars", POLYGON: "polygon_scalars"}
"""The tables of the values of scalars, by what they are of."""


@dataclass(frozen=True)
class RowTable:
    """A table with a row for each row of a class, in their order; at most one if it `is_single`.

    `columns` are those for the class, without the one that counts the rows.
    """

    name: str
    row_class: type[Row]
    columns: tuple[SqlColumn, ...]
    is_single: bool

    @property
    def definition(self) -> str:
        """The statement that makes the table."""
        key = f"{quoted(NUMBER)} INTEGER PRIMARY KEY"
        if self.is_single:
            key += f" DEFAULT 1 CHECK ({quoted(NUMBER)} = 1)"
        lines = [key, *(column.declaration for column in self.columns), *_vector_checks(self.columns)]
        return _definition(self.name, lines)


def _vector_checks(columns: tuple[SqlColumn, ...]) -> list[str]:
    """That a vector that may be absent has all of its components or none, and that some are not all 0."""
    checks = []
    vectors: dict[tuple[str, ...], list[SqlColumn]] = {}
    for column in columns:
        if column.component is not None:
            vectors.setdefault(column.path, []).append(column)
    for x, y, z in vectors.values():
        name = ".".join(x.path)
        a, b, c = (quoted(column.name) for column in (x, y, z))
        if x.may_be_null:
            all_or_none = f"({a} IS NULL) = ({b} IS NULL) AND ({a} IS NULL) = ({c} IS NULL)"
            checks.append(checked(f"{name} must have all of x, y and z, or none of them", all_or_none))
        if getattr(x.kind, "has_length", False):
            checks.append(checked(f"{name} must not be zero", f"{a} <> 0 OR {b} <> 0 OR {c} <> 0"))
    return checks


def row_table(name: str, row_class: type[Row], is_single: bool = False) -> RowTable:
    """The table for a row class; of a scene, without what has tables of its own."""
    columns = columns_of(row_class)
    if row_class is Scene:
        columns = tuple(column for column in columns if len(column.path) == 1)
    return RowTable(name, row_class, columns, is_single)


def _row_tables() -> dict[str, RowTable]:
    """The tables for the rows of a scene by name; a table comes after those that it refers to."""
    found = {SCENE: row_table(SCENE, Scene, is_single=True)}
    for name, field in fields_of(Scene).items():
        kind = field.column.kind
        if isinstance(kind, (Rows, Nested)):
            found[name] = row_table(name, kind.row_class, is_single=isinstance(kind, Nested))
    return found


ROW_TABLES: Final[Mapping[str, RowTable]] = _row_tables()
"""The tables of a scene but those of its mesh: `scene`, `parts`, `surfaces`, `lights`, `view`, `scalar`."""


def _definition(name: str, lines: list[str], end: str = "STRICT") -> str:
    return f"CREATE TABLE {quoted(name)} (\n  " + ",\n  ".join(lines) + f"\n) {end}"


def _number(name: str, rest: str = " NOT NULL") -> str:
    rule = f"{name} must be finite and at most {LARGEST_COORDINATE:g} in size"
    return f"{name} REAL{rest} {checked(rule, f'abs({name}) <= {LARGEST_COORDINATE!r}')}"


def _values(of: str, table: str) -> str:
    return _definition(
        VALUES[of],
        [
            f"scalar TEXT NOT NULL REFERENCES {SCALARS} (name) ON UPDATE CASCADE ON DELETE CASCADE",
            f"{of} INTEGER NOT NULL REFERENCES {table} ({of})",
            _number("value", ""),
            f"PRIMARY KEY (scalar, {of})",
        ],
        "STRICT, WITHOUT ROWID",
    )


DEFINITIONS: Final[Mapping[str, str]] = {
    NODES: _definition(NODES, ["node INTEGER PRIMARY KEY", *map(_number, ("x", "y", "z"))]),
    **{name: table.definition for name, table in ROW_TABLES.items()},
    POLYGONS: _definition(
        POLYGONS,
        [
            "polygon INTEGER PRIMARY KEY",
            "part TEXT NOT NULL REFERENCES parts (name) ON UPDATE CASCADE",
            *(f"node{corner} INTEGER NOT NULL REFERENCES {NODES} (node)" for corner in (1, 2, 3)),
            f"node4 INTEGER REFERENCES {NODES} (node)",
        ],
    ),
    MESH: _definition(
        MESH,
        [
            f"{NUMBER} INTEGER PRIMARY KEY DEFAULT 1 CHECK ({NUMBER} = 1)",
            f"crease_angle REAL NOT NULL {checked('crease_angle must be from 0 to 180', IN_DEGREES)}",
        ],
    ),
    SCALARS: _definition(
        SCALARS,
        [
            f"{NUMBER} INTEGER PRIMARY KEY",
            "name TEXT NOT NULL UNIQUE CHECK (name <> '')",
            f'"of" TEXT NOT NULL DEFAULT {NODE!r} CHECK ("of" IN ({NODE!r}, {POLYGON!r}))',
        ],
    ),
    VALUES[NODE]: _values(NODE, NODES),
    VALUES[POLYGON]: _values(POLYGON, POLYGONS),
}
"""The statements that make the tables, by name: all tables of a store."""

MESH_TABLES: Final = (NODES, POLYGONS, MESH, SCALARS, *VALUES.values())
