from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor.files.store import rows as module
from autocolor.files.store.store_file import read_store
from tests.autocolor.files.store.stores import run, small_scene, small_store, tables_of


def test_rows_and_columns_that_a_scene_file_may_lack_a_store_may_lack(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(
        path,
        "INSERT INTO lights (name, position_x, position_y, position_z) VALUES ('fill', 1, 2, 3)",
        "INSERT INTO surfaces (name, model, roughness) VALUES ('metal', 'cook-torrance', 0.2)",
        "UPDATE lights SET flaps_z_maximum = 0.5 WHERE name = 'rim'",
        "ALTER TABLE lights DROP COLUMN falloff",
        "UPDATE surfaces SET fresnel_curve = '[[0, 0.04], [90, 1]]' WHERE name = 'glass'",
    )
    scene = read_store(path).scene
    expected = small_scene().with_new_light("fill", position=(1, 2, 3))
    assert scene.lights == expected.with_light("rim", flaps={"z": {"maximum": 0.5}}).lights
    assert scene.surfaces["metal"].reflectance.model.roughness == 0.2  # type: ignore[attr-defined]
    assert (
        scene.surfaces["glass"]
        == expected.with_surface("glass", fresnel_curve=[(0, 0.04), (90, 1)]).surfaces["glass"]
    )


def test_tables_that_are_missing_are_created_and_told(tmp_path: Path) -> None:
    path = small_store(tmp_path)
    run(path, "DROP TABLE surfaces", "DROP TABLE lights", "DROP TABLE view")
    report = read_store(path)
    assert [part.surface for part in report.scene.parts] == ["body", "glass"]
    assert [surface.name for surface in report.scene.surfaces] == ["body", "glass"]
    assert report.is_view_created
    assert report.are_lights_created
    run(path, "DROP TABLE parts")
    own = read_store(path, surfaces="parts").scene
    assert [(part.name, part.surface) for part in own.parts] == [("hood", "hood"), ("roof", "roof")]


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
    tmp_path: Path, chunk: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "CHUNK", chunk)
    tables = tables_of(small_store(tmp_path))
    assert tables["nodes"][::4] == [(1, 0.0, 0.0, 0.0), (5, 0.5, 0.5, 1.0)]
    assert tables["polygons"] == [(1, "hood", 1, 2, 3, 4), (2, "roof", 1, 2, 5, None)]
    assert tables["mesh_scalars"] == [(1, "stress", "node"), (2, "area", "polygon")]
    assert tables["node_scalars"][2:] == [("stress", 3, None), ("stress", 4, 4.0), ("stress", 5, 5.0)]
    assert tables["polygon_scalars"] == [("area", 1, 1.0), ("area", 2, 0.5)]
