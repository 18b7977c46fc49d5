"""The reference of the table store: every table and column, as the store itself makes them.

`python -m docs.generate.store > docs/STORE.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from autocolor.files.store.schema import (
    DEFINITIONS,
    INDEXES,
    ROW_TABLES,
    RowTable,
    SqlColumn,
    literal,
)

ROOT = Path(__file__).resolve().parents[2]

HEAD = """# The table store

A scene in one SQLite file (`.sqlite` or `.db`), whose tables any tool of SQLite 3.37 or later can ask and
edit. `read_scene`, `write_scene` and every command take it as they take a folder. The page is written
from the columns in `autocolor/scene` by `python -m docs.generate.store > docs/STORE.md`; what a key
means and what an edit of it costs is in COLUMNS.md.

    autocolor sql car.sqlite "SELECT name, intensity FROM lights"
    autocolor sql scenes/coupe "SELECT part, count(*) AS polygons FROM polygons GROUP BY part" --csv
    autocolor sql car.sqlite "UPDATE surfaces SET exponent = 40 WHERE name = 'body'" --write
    autocolor sql car.sqlite

The last one asks at a prompt: `.tables`, `.schema lights`, `.quit`. A scene that is no store is read into
memory for it; `--write` then saves to its folder, whose comments stay. In Python:

    with autocolor.open_tables("car.sqlite") as tables:
        tables.select("SELECT node, x, value AS stress FROM nodes JOIN node_scalars USING (node)"
                      " WHERE scalar = ? AND value > ?", ["stress", 200])
        tables.update("lights", "key", intensity=2.0)
        scene = tables.scene()

## What values are

- Rows are counted from 1: `nodes.node`, `polygons.polygon`, and `number` in the other tables, which keeps
  their order. Node and polygon numbers may have gaps and come in any order; they are counted anew when a
  scene is saved.
- Surfaces, parts, lights and scalars are referred to by their names.
- A point, a direction or an axis is three columns: `position_x`, `position_y`, `position_z`.
- A flap of a light is `flaps_z_minimum`, `flaps_z_maximum` and `flaps_z_on`. Without a flap all three are
  NULL. In an existing flap, a limit that is NULL is infinite.
- A mapping or an exposure is a word, or JSON: `'linear'` or `'[[0, 0], [1, 1]]'`, `'auto'`, `'99.5 %'` or
  `'{"object": [0, 1.3]}'`. A switch is 0 or 1. Colors are written as in scene files.
- NULL is absent. A scalar without a row for a node or polygon, or with NULL there, has no value there. Minus
  zero is 0.
- `on` and `of` are words of SQL: write `"on"` and `"of"`.

Only `nodes` and `polygons` are required. Other missing tables are created as for any mesh, and a missing
column has its default. Without `parts`, the parts are named by the polygons. A table `lights` without rows
means no lights.

## What is checked, and what is run

The tables check the types of values, and that names differ. Tools leave references unchecked unless they are
asked (`PRAGMA foreign_keys = ON`). Reading a store checks all of it, every range, choice and reference:
"polygons, row 12: node 40 is not in the node table; correct it". `--write` and `open_tables` read the changed
scene before they save it. Nothing is repaired: polygons without area and parts without polygons stay, as they
do in `.tables` files.

A store is data, and reading it runs no code from it. Views, triggers and tables of other names are
ignored; a view, a virtual table or a computed column with one of the names below is refused. Statements may
read, compute, and with `--write` change rows. They may not attach files, load extensions, set pragmas or
change tables, and they end after 30 seconds (`--seconds`). A value, also one that a statement computes, has
at most 128 KiB. A file has at most 1.1 GB, unless you allow more with `--limit`.

A store is read into memory, changed there, and replaced as a whole: the new file is written under another
name and renamed. A program of ours that is killed leaves the old store or the new one, and nothing beside
it. While a store is changed, SQLite's own lock keeps other programs from changing it. A program of SQLite
that has the store open from before keeps the old file. SQLite refuses its changes (`attempt to write a
readonly database`) until it opens the store again.

Tables, views, indexes and triggers of other programs stay, and none of them is run: the tables below are made
anew, and then the indexes and triggers that others gave them. If one does not fit the rows of the new scene,
the store is left as it is. `--write` refuses a store with triggers, because its statement would run them. A
studio that shows a store, or a scene file, shows the changes of other programs as one step to undo; with
unsaved edits it asks.

What another program has written to a `-wal` file is read with the store. Before the store is replaced,
SQLite moves the log into it, and the store leaves WAL mode. While a program has the store open in WAL mode,
it is read and not replaced. Do not turn WAL mode on while several programs change a store. A store in WAL
mode cannot be read where SQLite may not write.

If a program was killed while it changed the store, SQLite takes the change back by the `-journal` beside
it, as any tool of SQLite does. A `-journal` can also name another file, which SQLite deletes afterwards.
Such a store is refused, for reading and for writing. If you trust both files, open the store once with
`sqlite3 FILE .tables`; otherwise move the journal away.

The indexes make it fast to rename parts, and to remove nodes and polygons with their values. They are created
after the rows.

## The mesh
"""

ROWS = """
## Tables of one row

`scene`, `view` and `scalar` have at most one row, `number` 1.
"""

MANY = """
## Tables of many rows
"""


def document() -> str:
    """The whole reference."""
    parts = [HEAD]
    for name in [name for name in DEFINITIONS if name not in ROW_TABLES]:
        parts.append(f"\n```sql\n{DEFINITIONS[name]};\n```\n")
    parts.append(f"\n```sql\n{''.join(f'{index};{chr(10)}' for index in INDEXES.values())}```\n")
    for head, is_single in ((ROWS, True), (MANY, False)):
        parts.append(head)
        for table in ROW_TABLES.values():
            if table.is_single == is_single:
                parts.extend(lines_of(table))
    return "".join(parts)


def lines_of(table: RowTable) -> Iterator[str]:
    """The reference of a table, a line a column; the three columns of a vector share one."""
    yield f"\n### `{table.name}`\n\n| column | type | what it is | value | default |\n|---|---|---|---|---|\n"
    for column in table.columns:
        if column.path[-1] not in (1, 2):
            default = "" if column.default is None else f"`{shown_default(table, column)}`"
            told = default or ("NULL" if column.may_be_null else "")
            rule = column.column.kind.rule().removeprefix("must be ")
            name, text = shown_name(column), column.column.help
            yield f"| `{name}` | {column.type} | {text} | {rule} | {told} |\n".replace("|| ", "| ")


def shown_name(column: SqlColumn) -> str:
    """The name of a column; of a vector, with all its axes."""
    return f"{column.name[:-1]}x`, `..._y`, `..._z" if column.path[-1] == 0 else column.name


def shown_default(table: RowTable, column: SqlColumn) -> str:
    """The default of a column; of a vector, those of all its axes."""
    if column.path[-1] != 0:
        return literal(column.default)
    return ", ".join(literal(each.default) for each in table.columns if each.path[:-1] == column.path[:-1])


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(document())
