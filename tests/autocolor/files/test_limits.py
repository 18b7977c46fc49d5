"""The limits of files, as numbers. The tests of each reader hold it, mostly with a smaller limit."""

from __future__ import annotations

from importlib import import_module

import pytest

from autocolor.files.picture_file import PICTURE_FILE

LIMITS: dict[str, dict[str, float]] = {
    "array_file": {"LARGEST_HEADER": 16 << 20, "MOST_VALUES": 1_000_000, "LARGEST_ARRAY_HEADER": 1024},
    "conversion": {"MOST_NAMED": 5},
    "meshes.byu": {"MOST_OVERLAP": 100},
    "meshes.foreign": {"MOST_VALUES": 2_000_000, "MOST_MEMBERS": 10_000, "LARGEST_GROWTH": 200},
    "meshes.foreign_worker": {"MOST_PLACED": 100_000},
    "meshes.npy_tables": {
        "MOST_ROWS": 200_000_000, "LARGEST_HEADER": 1024, "LARGEST_NOTES": 4 << 20, "MOST_VALUES": 200_000,
        "MOST_PARTS": 1 << 16,
    },
    "meshes.number_text": {"MOST_PROBLEMS": 20, "MOST_DIGITS": 18},
    "meshes.obj": {"LONGEST_LINE": 1 << 20, "LARGEST_LIBRARIES": 4 << 20, "MOST_LIBRARIES": 100},
    "meshes.ply": {"MOST_UNNAMED_PARTS": 10_000, "LARGEST_INDEX": 1 << 53},
    "meshes.ply_elements": {"LARGEST_HEADER": 16 << 20, "LONGEST_ROW": 1 << 20, "LONGEST_TEXT_LINE": 1 << 20},
    "meshes.repair": {"LONGEST_NAME": 200},
    "meshes.stl": {"LONGEST_FACET": 1 << 16},
    "meshes.vtk": {
        "LONGEST_LINE": 4096, "LONGEST_METADATA": 10_000, "MOST_NODES": 4_000_000, "MOST_ARRAYS": 100_000,
    },
    "paths": {"LONGEST_STEM": 100},
    "picture_file": {"MOST_PROBLEMS": 20, "LONGEST_PROBLEM": 400},
    "scene_files": {"MOST_LISTED": 1000},
    "scene_toml.scene_meshes": {"MOST_MESHES": 1000},
    "scene_toml.toml_text": {"LARGEST_TEXT": 1 << 20, "MOST_PROBLEMS": 100, "LONGEST_SENTENCE": 400},
    "state": {"MOST_COLORS": 12, "MOST_FILES": 10, "LONGEST_PATH": 4096},
    "store.connections": {"LARGEST_STORE": 1 << 31, "LONGEST_TEXT": 1 << 20},
    "store.rows": {"MOST_MESH_ROWS": 32_000_000, "MOST_PROBLEMS": 100, "MOST_MESH_PROBLEMS": 20},
    "store.schema": {"MOST_TABLES": 10_000, "MOST_ROWS": 100_000, "LARGEST_FLOAT": 1.7976931348623157e308},
    "store.tables": {"LONGEST_COMPUTED": 1 << 17},
}  # fmt: skip


def test_a_picture_file_has_at_most_4_gigabytes() -> None:
    assert PICTURE_FILE.largest == 4 << 30


@pytest.mark.parametrize("module", LIMITS)
def test_the_limits_of_files_are_as_told(module: str) -> None:
    found = import_module(f"autocolor.files.{module}")
    assert {name: getattr(found, name) for name in LIMITS[module]} == LIMITS[module]
