from __future__ import annotations

import sqlite3

import pytest

from autocolor.files.store import mesh_inserts
from autocolor.files.store.mesh_inserts import insert_mesh
from autocolor.files.store.schema import DEFINITIONS
from tests.autocolor.files.store.stores import small_scene


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
