from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.cases import Spread
from benchmarks.reading import FILES, OURS, absence, case_of, counts, memory_here, read, text, written


@pytest.mark.parametrize("name", FILES)
def test_the_files_hold_the_polygons_that_are_told(name: str, tmp_path: Path) -> None:
    path = written(tmp_path, 200)[name]
    mesh = read(OURS, path)
    assert (
        counts(mesh) == {"nodes": 121, "polygons": 200}
        if FILES[name] == 3
        else {"nodes": 225, "polygons": 196}
    )
    assert mesh.triangle_count == (200 if FILES[name] == 3 else 0)


def test_all_formats_hold_the_same_places(tmp_path: Path) -> None:
    paths = written(tmp_path, 200)
    ply, stl, obj = (read(OURS, paths[f"triangles.{suffix}"]) for suffix in ("ply", "stl", "obj"))
    assert np.array_equal(ply.coordinates[ply.node_numbers], stl.coordinates[stl.node_numbers])
    assert np.allclose(ply.coordinates[ply.node_numbers], obj.coordinates[obj.node_numbers], atol=1e-6)


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("reader", ["trimesh", "meshio"])
def test_peers_find_the_same(name: str, reader: str, tmp_path: Path) -> None:
    pytest.importorskip(reader)
    path = written(tmp_path, 200)[name]
    ours, theirs = counts(read(OURS, path)), counts(read(reader, path))
    assert theirs["nodes"] == ours["nodes"]
    halves = 2 if reader == "trimesh" and FILES[name] == 4 else 1
    assert theirs["polygons"] == halves * ours["polygons"]


def test_a_peer_that_is_not_there_says_what_would_help() -> None:
    assert absence("no_such_package") == "No module named 'no_such_package'; pip install '.[peers]'"
    assert absence("json") == ""


def test_memory_is_counted_over_the_imports(tmp_path: Path) -> None:
    path = written(tmp_path, 20_000)["triangles.ply"]
    assert 0 <= memory_here(OURS, path) < 100


def test_the_table_has_a_row_for_each_case() -> None:
    name = case_of(OURS, "triangles.ply")
    table = text(
        {
            "cases ms": {name: Spread(1, 2, 3)._asdict()},
            "best ms": {name: 1.0},
            "memory MB": {name: 1234.5},
            "found": {name: {"nodes": 5, "polygons": 6}},
            "targets": [],
        }
    )
    assert "triangles.ply: autocolor           2       1   1,234           5           6" in table
