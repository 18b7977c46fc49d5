from __future__ import annotations

from pathlib import Path

import numpy as np

from autocolor.files.meshes.formats import format_of_files, format_of_folder, mesh_formats
from tests.autocolor.meshes import cube


def test_tables_are_known_by_the_names_of_their_files_or_how_they_begin(tmp_path: Path) -> None:
    for name in ("nodes", "polygons"):
        np.save(tmp_path / f"{name}.npy", cube().coordinates)
    found = format_of_folder(tmp_path)
    assert found is not None
    assert found.name == "npy"
    (tmp_path / "nodes.npy").rename(tmp_path / "corners")
    for nodes, name in (("corners", "npy"), ("a.NPY", "npy"), ("nodes.csv", "CSV"), ("nodes.txt", "CSV")):
        files = {"nodes": tmp_path / nodes, "polygons": tmp_path / "polygons"}
        recognized = format_of_files(files)
        assert recognized is not None
        assert recognized.name == name


def test_the_format_is_written_too_and_holds_all_that_a_mesh_has(tmp_path: Path) -> None:
    npy = next(each for each in mesh_formats() if each.name == "npy")
    assert npy.write is not None
    npy.write(tmp_path, cube())
    mesh = npy.read(tmp_path / "nodes.npy", tmp_path / "polygons.npy").mesh
    assert mesh.node_numbers.tolist() == cube().node_numbers.tolist()
