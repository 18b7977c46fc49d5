"""The notes beside .npy tables, `tables.json`: names of parts, crease angle, scalars, and whether planes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NoReturn

from autocolor.errors import InputError
from autocolor.files.reading import read_bytes
from autocolor.scene.columns.problems import Problem
from autocolor.scene.mesh import CREASE_ANGLES
from autocolor.scene.scalars.mesh_scalars import MOST_SCALARS, NODE, POLYGON

NOTES: Final = "tables.json"

FORMAT: Final = "autocolor npy tables 1"

LARGEST_NOTES: Final = 4 << 20
MOST_VALUES: Final = 200_000

KEYS: Final = frozenset(("format", "part_names", "crease_angle", "scalars", "planes"))


@dataclass(frozen=True)
class TableNotes:
    """What `tables.json` says.

    `scalars` are names, each with "node" or "polygon", in the order of their files. `planes` tells whether
    the planes that polygons share are known: True where files hold them, False where there are none.
    """

    part_names: tuple[str, ...]
    crease_angle: float
    scalars: tuple[tuple[str, str], ...] = ()
    planes: bool | None = None


def notes_text(notes: TableNotes) -> bytes:
    """The content of `tables.json`."""
    content = {
        "format": FORMAT,
        "part_names": notes.part_names,
        "crease_angle": notes.crease_angle,
        "scalars": [{"name": name, "of": of} for name, of in notes.scalars],
        "planes": notes.planes,
    }
    return (json.dumps(content, indent=1, allow_nan=False) + "\n").encode()


def read_notes(path: Path) -> TableNotes:
    """The notes of a file. Raises InputError."""
    content = _parsed(path)
    if not isinstance(content, dict) or set(content) != KEYS or content["format"] != FORMAT:
        _refuse(path, f"its format must be {FORMAT!r}, with the keys {', '.join(sorted(KEYS))}, not another")
    names, scalars = content["part_names"], content["scalars"]
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        _refuse(path, "part_names must be strings, one for each part, not others")
    if len(set(names)) != len(names):
        _refuse(path, "part_names must differ, not repeat")
    found: list[Problem] = []
    angle = CREASE_ANGLES.held(content["crease_angle"], ("crease_angle",), found)
    if not isinstance(angle, float):
        _refuse(path, found[0].sentence.partition(";")[0])
    if not isinstance(scalars, list) or len(scalars) > MOST_SCALARS or not all(map(_is_scalar, scalars)):
        _refuse(
            path, f"scalars must be at most {MOST_SCALARS} names, each of 'node' or 'polygon', not others"
        )
    if not (content["planes"] is None or isinstance(content["planes"], bool)):
        _refuse(path, "planes must be true, false or null, not another")
    return TableNotes(
        tuple(names), angle, tuple((each["name"], each["of"]) for each in scalars), content["planes"]
    )


def _is_scalar(entry: object) -> bool:
    return (
        isinstance(entry, dict)
        and set(entry) == {"name", "of"}
        and isinstance(entry["name"], str)
        and bool(entry["name"])
        and entry["of"] in (NODE, POLYGON)
    )


def _parsed(path: Path) -> Any:
    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    data = read_bytes(path, LARGEST_NOTES)
    try:
        if sum(map(data.count, (b",", b"[", b"{"))) > MOST_VALUES:
            raise ValueError("more of them")
        return json.loads(data.decode("utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        reason = str(error)[:100]
        _refuse(path, f"it must be JSON of at most {MOST_VALUES:,} values, not wrong ({reason})")


def _refuse(path: Path, sentence: str) -> NoReturn:
    raise InputError(f"{path.name}: {sentence}; convert the mesh again, or correct it")
