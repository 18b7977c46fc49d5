"""The reference of the table store: its rules, and the statements that create its tables.

`python -m docs.generate.store > docs/STORE.md` writes it.
"""

from __future__ import annotations

import sys

from autocolor.files.store.schema import DEFINITIONS, INDEXES

HEAD = """# The table store

A scene in one SQLite file (`.sqlite` or `.db`), for any tool of SQLite 3.37 or later. `read_scene`,
`write_scene` and every command accept a store like a folder. `python -m docs.generate.store > docs/STORE.md`
writes this page.

```
autocolor convert scenes/coupe car.sqlite
autocolor sql car.sqlite "SELECT name, intensity FROM lights"
autocolor sql scenes/coupe "SELECT part, count(*) AS polygons FROM polygons GROUP BY part" --csv
autocolor sql car.sqlite "UPDATE surfaces SET exponent = 40 WHERE name = 'body'" --write
```

Without a statement, `autocolor sql car.sqlite` opens a prompt with `.tables`, `.schema lights` and `.quit`.
Any other scene is read into a store in memory; `--write` then saves it to its folder, with its comments. In
Python:

```python
with autocolor.open_tables("car.sqlite") as tables:
    tables.select("SELECT node, value FROM node_scalars WHERE scalar = ? AND value > ?", ["stress", 200])
    tables.update("lights", "key", intensity=2.0)
    scene = tables.scene()
```

## Values

A column has the name of its key. [COLUMNS.md](COLUMNS.md) has the meaning, the range and the default of every
key.

- `number` orders the rows of a table, from 1. `scene`, `view`, `scalar` and `mesh` have at most one row.
- Node and polygon numbers start at 1, in any order and with gaps. They are counted anew when a scene is
  saved. `node4` is NULL in a triangle.
- Surfaces, parts, lights and scalars are referred to by name.
- A vector is three columns: `position_x`, `position_y`, `position_z`.
- Colors are written as in scene files. A switch is 0 or 1. Lists and tables are JSON: a `mapping` is
  `'linear'` or `'[[0, 0], [1, 1]]'`, an `exposure` is `'99.5 %'` or `'{"object": [0, 1.3]}'`.
- NULL is absent, or the default. The columns of another reflection model are NULL, and so are the two colors
  of a surface with a ramp. Without a flap all its columns are NULL. In a flap, a limit that is NULL is
  infinite.
- `mesh_scalars` names the scalars of the mesh, of a 'node' or of a 'polygon'. A node or polygon without a
  row, or with NULL, has no value.
- There are no normals. Those of a mesh file are left out with a warning, and computed again.

Only `nodes` and `polygons` are required. Without `parts`, the polygons name the parts. Other missing tables
are created, as for a mesh without a scene, and a missing column has its default. A table `lights` without
rows means no lights.

## What is checked

STRICT tables check types, and that names differ. SQLite checks references only after `PRAGMA foreign_keys =
ON`. Reading a store checks every range, choice and reference, and names the place: "polygons, row 12: node 40
is not in the node table; correct it". `--write` and `open_tables` check the changed scene before they save
it. Polygons without area and parts without polygons stay.

Reading a store runs no code from it. Other tables, views and triggers are ignored. A view, a virtual table or
a computed column with a name of this page is refused. Statements may read, compute and, with `--write`,
change rows. They may not attach files, load extensions, set pragmas or change tables, and they end after 30
seconds (`--seconds`). A value has at most 128 KiB, and a file 1.1 GB (`--limit`).

## How a store is saved

- A store is changed in memory, written under another name and renamed. A kill leaves the old file or the new.
- SQLite's lock keeps other programs from changing the store meanwhile. A program that opened it before keeps
  the old file; SQLite refuses its changes (`attempt to write a readonly database`) until it opens the store
  again.
- Other tables, views, indexes and triggers stay. If one does not fit the new rows, nothing is saved.
  `--write` refuses a store with triggers, because its statement would run them.
- A `-wal` file is read with its store, and merged before the store is replaced. A store that another program
  has open in WAL mode is not replaced. In a folder without write permission, a store in WAL mode cannot be
  read.
- A `-journal` of a killed program is rolled back. If it names another file, which SQLite would delete, the
  store is refused: open it once with `sqlite3 FILE .tables` if you trust both files, or move the journal
  away.

A studio that shows a store shows the changes of other programs as one step to undo; with unsaved edits it
asks.

## The tables

"""


def document() -> str:
    """The whole reference."""
    statements = [*DEFINITIONS.values(), *INDEXES.values()]
    return f"{HEAD}```sql\n{''.join(f'{statement};{chr(10)}' for statement in statements)}```\n"


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.stdout.write(document())
