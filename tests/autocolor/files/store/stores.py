"""Stores for the tests: small ones, and what is done to them with SQLite alone, as outside tools do."""

from __future__ import annotations

import os
import sqlite3
import struct
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from autocolor import Light, Mesh, Scene, Surface, scene_of
from autocolor.files.store.store_file import write_store
from autocolor.scene.scalar import MeshScalar


def small_scene() -> Scene:
    """A quad and a triangle of two parts, with two surfaces, two lights and two scalars."""
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]]),
        np.array([[0, 1, 2, 3], [0, 1, 4, 4]]),
        np.array([0, 1]),
        ("hood", "roof"),
    ).with_scalars(
        MeshScalar("stress", np.array([1.0, 2.0, np.nan, 4.0, 5.0])),
        MeshScalar("area", np.array([1.0, 0.5]), "polygon"),
    )
    return scene_of(
        mesh,
        surfaces=[Surface("body"), Surface("glass")],
        parts={"hood": {"surface": "body"}, "roof": {"surface": "glass", "stage": True}},
        lights=[Light("key", (2, -3, 4), aim=(0, 0, 0)), Light("rim", (-2, 3, 4))],
        name="small",
    )


def small_store(folder: Path, name: str = "small.sqlite") -> Path:
    """A store with the small scene."""
    path = folder / name
    write_store(path, small_scene())
    return path


def run(path: Path, *statements: str) -> list[tuple[Any, ...]]:
    """Run statements on a store as an outside tool does, without checks of keys; the rows of the last."""
    with closing(sqlite3.connect(path)) as connection, connection:
        for statement in statements:
            rows = connection.execute(statement).fetchall()
    return rows


def loosen(path: Path, table: str) -> None:
    """Make a table of a store one that checks nothing, as another tool would make it."""
    copy = f"CREATE TABLE loose AS SELECT * FROM {table}"
    run(path, copy, f"DROP TABLE {table}", f"ALTER TABLE loose RENAME TO {table}")


def is_equal(one: Scene, other: Scene) -> bool:
    """Whether two scenes are equal in all tables, those of the mesh included."""
    meshes = one.mesh, other.mesh
    a, b = ([m.coordinates, m.node_numbers, m.part_numbers, *(s.values for s in m.scalars)] for m in meshes)
    c, d = ([m.part_names, m.crease_angle, *((s.name, s.of) for s in m.scalars)] for m in meshes)
    are_close = c == d and all(np.array_equal(x, y, equal_nan=True) for x, y in zip(a, b, strict=True))
    return are_close and one.replace(mesh=other.mesh).equals(other)


def tables_of(path: Path) -> dict[str, list[tuple[Any, ...]]]:
    """All rows of all tables of a store."""
    names = [name for (name,) in run(path, "SELECT name FROM sqlite_master WHERE type = 'table'")]
    return {name: run(path, f'SELECT * FROM "{name}"') for name in names}


def hostile_journal(path: Path, named: Path, *, has_header: bool = True) -> Path:
    """A journal beside a store that changes no page and has a file as its super-journal.

    A program that opens the store for writing rolls the journal back, and SQLite then deletes the named file.
    Without a header, the file is deleted when a change of that program is rolled back.
    """
    magic = bytes.fromhex("d9d505f920a163d7")
    (size_of_page,) = struct.unpack(">H", path.read_bytes()[16:18])
    pages = path.stat().st_size // size_of_page
    header = magic + struct.pack(">5I", 0, 1, pages, 512, size_of_page) if has_header else bytes(200_000)
    name = os.fsencode(named.resolve())
    lock_page = (1 << 30) // size_of_page + 1
    end = struct.pack(">I", lock_page) + name + struct.pack(">Ii", len(name), sum(name)) + magic
    journal = Path(f"{path}-journal")
    journal.write_bytes(header.ljust(512, b"\0") + end)
    return journal


def contents(folder: Path) -> dict[str, bytes]:
    """The bytes of the files of a folder and its folders, by their paths in it."""
    files = (each for each in folder.rglob("*") if each.is_file())
    return {str(each.relative_to(folder)): each.read_bytes() for each in files}
