from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.npy.table_notes import FORMAT, TableNotes, notes_text, read_notes

RIGHT: dict[str, Any] = {
    "format": FORMAT,
    "part_names": ["hood", "roof"],
    "crease_angle": 30,
    "scalars": [{"name": "stress", "of": "node"}],
    "planes": None,
}


@pytest.mark.parametrize("planes", [True, False, None])
def test_notes_are_read_as_they_were_written(tmp_path: Path, planes: bool | None) -> None:
    notes = TableNotes(("hood", "Türe \n"), 12.5, (("stress", "node"), ("load", "polygon")), planes)
    (tmp_path / "tables.json").write_bytes(notes_text(notes))
    assert read_notes(tmp_path / "tables.json") == notes


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"format": "another"}, "its format must be 'autocolor npy tables 1'"),
        ({"more": 1}, "with the keys crease_angle, format, part_names, planes, scalars, not another"),
        ({"part_names": "hood"}, "part_names must be strings, one for each part, not others"),
        ({"part_names": [""]}, "part_names must be strings, one for each part, not others"),
        ({"part_names": ["a", "a"]}, "part_names must differ, not repeat"),
        ({"crease_angle": 181}, "crease_angle must be a number from 0 to 180, not 181"),
        ({"crease_angle": "wide"}, "not 'wide'"),
        ({"scalars": [{"name": "x", "of": "edge"}]}, "each of 'node' or 'polygon', not others"),
        ({"scalars": [{"name": "x", "of": []}]}, "each of 'node' or 'polygon', not others"),
        ({"scalars": 3}, "scalars must be at most 1000 names"),
        ({"planes": 1}, "planes must be true, false or null, not another"),
    ],
)
def test_notes_that_say_something_else_are_refused(
    tmp_path: Path, change: dict[str, object], rule: str
) -> None:
    path = tmp_path / "tables.json"
    path.write_text(json.dumps({**RIGHT, **change}))
    with pytest.raises(InputError) as refusal:
        read_notes(path)
    assert rule in str(refusal.value)
    assert str(refusal.value).startswith("tables.json: ")
    assert str(refusal.value).endswith("; convert the mesh again, or correct it")


@pytest.mark.parametrize(
    "data", [b"", b"{", b"\xff\xfe", b"[" * 100_000, b"3", b'{"crease_angle": NaN}', b"9" * 5000]
)
def test_bytes_that_are_no_notes_are_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "tables.json"
    path.write_bytes(data)
    with pytest.raises(InputError, match="convert the mesh again, or correct it"):
        read_notes(path)
