from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError
from autocolor.files.store import mesh_rows
from autocolor.files.store import mesh_rows as mesh_inserts
from autocolor.files.store.mesh_rows import insert_mesh
from autocolor.files.store.schema import DEFINITIONS
from autocolor.files.store.store_file import read_store
from tests.autocolor.files.store.stores import run, small_scene, small_store

LOOSE_NODES = (
    "ALTER TABLE nodes RENAME TO old",
    "CREATE TABLE nodes (node, x, y, z)",
    "INSERT INTO nodes SELECT * FROM old",
    "DROP TABLE old",
)


@pytest.mark.parametrize(
    ("statement", "problem"),
    [
        ("UPDATE nodes SET x = 'a' WHERE node = 2", "nodes, row 2: x must be a number, not 'a'; correct it"),
        ("UPDATE nodes SET y = NULL", "nodes, row 1: y must be a number, not missing; correct it"),
        (
            "UPDATE nodes SET node = 3 WHERE node = 2",
            "nodes: a number must be that of one row, not of several",
        ),
        (
            "UPDATE nodes SET node = 1.5 WHERE node = 2",
            "nodes, row 1.5: node must be a whole number, not 1.5",
        ),
        ("UPDATE nodes SET z = 9e999 WHERE node = 2", "nodes, row 2: coordinates must be finite and at most"),
    ],
)
def test_a_table_that_checks_nothing_is_checked(tmp_path: Path, statement: str, problem: str) -> None:
    path = small_store(tmp_path)
    run(path, *LOOSE_NODES, statement)
    with pytest.raises(InputError) as refused:
        read_store(path)
    assert any(each.startswith(f"small.sqlite: {problem}") for each in refused.value.problems)


def test_a_missing_node_is_named_also_where_no_table_tells_of_references(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        *LOOSE_NODES,
        "CREATE TABLE loose AS SELECT * FROM polygons",
        "DROP TABLE polygons",
        "ALTER TABLE loose RENAME TO polygons",
        "UPDATE nodes SET node = 37 WHERE node = 4",
    )
    with pytest.raises(InputError) as refused:
        read_store(path)
    problem = "polygons, row 1: node 4 is not in the node table (1 to 37); correct it"
    assert refused.value.problems == (f"small.sqlite: {problem}",)
    run(path, "UPDATE polygons SET node4 = 37 WHERE node4 = 4", "DELETE FROM node_scalars WHERE node = 4")
    assert read_store(path).scene.mesh.node_numbers.tolist() == [[0, 1, 2, 4], [0, 1, 3, 3]]


def test_a_value_of_a_node_that_is_not_there_is_refused(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "INSERT INTO node_scalars VALUES ('stress', 9, 1.0)")
    with pytest.raises(
        InputError, match="node_scalars, scalar 'stress': node 9 is not in the node table; remove"
    ):
        read_store(path)
    run(path, "DELETE FROM node_scalars WHERE node = 9", "INSERT INTO node_scalars VALUES ('heat', 1, 1.0)")
    with pytest.raises(
        InputError, match="node_scalars: a scalar is not in the mesh_scalars table; remove such"
    ):
        read_store(path)


def test_a_crease_angle_and_a_scalar_are_checked(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DROP TABLE mesh", "CREATE TABLE mesh (crease_angle)", "INSERT INTO mesh VALUES (200)")
    with pytest.raises(InputError, match="mesh, row 1: crease_angle must be a number from 0 to 180, not 200"):
        read_store(path)
    run(path, "DELETE FROM mesh", "DROP TABLE mesh_scalars", "CREATE TABLE mesh_scalars (name, 'of')")
    run(path, "INSERT INTO mesh_scalars VALUES ('stress', 'edge')")
    with pytest.raises(InputError, match="mesh_scalars, row 1: it must have a name, and be of 'node' or"):
        read_store(path)


def test_too_many_rows_are_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_rows, "MOST_MESH_ROWS", 4)
    with pytest.raises(InputError, match="nodes must have at most 4 rows, not 5; leave rows out"):
        read_store(small_store(tmp_path))


def test_values_belong_to_nodes_whose_numbers_a_double_does_not_hold(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    far = 2**53
    run(
        path,
        f"UPDATE nodes SET node = node + {far}",
        f"UPDATE node_scalars SET node = node + {far}",
        *(f"UPDATE polygons SET node{corner} = node{corner} + {far}" for corner in (1, 2, 3, 4)),
    )
    stress = read_store(path).scene.mesh.scalars[0]
    np.testing.assert_array_equal(stress.values, [1, 2, np.nan, 4, 5])


@pytest.mark.parametrize("chunk", [1, 2, 1 << 16])
def test_rows_are_counted_from_1_and_a_triangle_has_no_fourth_node(
    chunk: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_inserts, "CHUNK", chunk)
    connection = sqlite3.connect(":memory:")
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    insert_mesh(connection, small_scene().mesh)
    nodes = connection.execute("SELECT * FROM nodes").fetchall()
    assert nodes[0] == (1, 0.0, 0.0, 0.0)
    assert nodes[4] == (5, 0.5, 0.5, 1.0)
    polygons = connection.execute("SELECT * FROM polygons").fetchall()
    assert polygons == [(1, "hood", 1, 2, 3, 4), (2, "roof", 1, 2, 5, None)]
    scalars = connection.execute("SELECT * FROM mesh_scalars").fetchall()
    assert scalars == [(1, "stress", "node"), (2, "area", "polygon")]
    values = connection.execute("SELECT * FROM node_scalars WHERE node > 2").fetchall()
    assert values == [("stress", 3, None), ("stress", 4, 4.0), ("stress", 5, 5.0)]
    assert connection.execute("SELECT * FROM polygon_scalars").fetchall() == [
        ("area", 1, 1.0),
        ("area", 2, 0.5),
    ]
    connection.close()
