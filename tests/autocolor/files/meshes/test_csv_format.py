from __future__ import annotations

from pathlib import Path

import numpy as np

from autocolor.files.meshes.csv_format import CSV, write_csv_tables
from autocolor.files.meshes.formats import format_of_folder, read_mesh
from tests.autocolor.meshes import cube


def test_the_tables_of_a_mesh_are_a_folder_that_is_read_again(tmp_path: Path) -> None:
    write_csv_tables(tmp_path, cube())
    assert format_of_folder(tmp_path) is CSV
    again = read_mesh({"nodes": tmp_path / "nodes.csv", "polygons": tmp_path / "polygons.csv"})
    assert np.array_equal(again.mesh.coordinates, cube().coordinates)
    assert again.repairs == ()
