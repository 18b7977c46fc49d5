"""The journal of a session: a file of JSON lines, one line a step, to which lines are only ever appended.

    {"step": "begin", "version": 2, "path": "/home/ann/coupe", "up": "z", ..., "checksum": "9f2c..."}
    {"step": "edit", "change": "with_light", "row": "key", "columns": {"on": false}, ..., "joins": true}
    {"step": "edit", "change": "replace", "row": null, "columns": {...}, "mesh": "scene-2", "joins": false}
    {"step": "open", "path": "/home/ann/car.obj", "up": "y", ..., "tables": {...}, "checksum": "03ab..."}
    {"step": "keep", "name": "A"}
    {"step": "saved", "files": {"/home/ann/car/scene.toml": "77d0...", "/home/ann/car.npz": "c1e9..."}}
    {"step": "undo", "steps": 1}

The other steps are `show` and `drop`, with the name of a variant; `rename`, with the new name `to` as well;
`redo`, `view_back` and `view_forward`, with a number of steps; and `on_disk`, which is like `saved` for files
that get a backup before they are overwritten. An edit is the call of a method of the scene; its columns have
the plain values of scene files. `mesh` is null if the mesh stays, empty for the mesh of the first scene, else
the name of a folder beside the journal that has the mesh in a scene. The line of an opened scene has all its
tables, so that only the mesh must still be in the files.

A line counts once its newline is written. If the program was killed during a line, its part is ignored. A
refused line is named by its number: remove it and the lines after it to recover the steps before.

In version 1, an edit of the view was a step to undo as well; its `undo` and `redo` have no number of steps.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, Final, NamedTuple

from autocolor.budget import allowing
from autocolor.checks import shown
from autocolor.errors import AutocolorError, InputError, MissingInputError
from autocolor.files.opening import read_scene
from autocolor.files.paths import SCENE_FILE
from autocolor.files.reading import read_bytes
from autocolor.files.scene_toml.scene_meshes import SOURCES
from autocolor.files.scene_writing import write_scene
from autocolor.journal.history import Drop, Edit, History, Keep, Move, Open, Rename, Saved, Show, Step
from autocolor.journal.places import Opened, Source, checksum_of, opened
from autocolor.journal.timeline import WAYS
from autocolor.scene.columns import difference, fields_of, to_plain
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.view import View

VERSION: Final = 2

LARGEST_JOURNAL: Final = 64 << 20
"""Limit: bytes; some hundred thousand steps."""

MOST_LINES: Final = 1_000_000

LONGEST_LINE: Final = 16 << 20
"""Limit: bytes; a step that changes all of a hundred thousand rows."""

LONGEST_PROBLEM: Final = 400


class JournalSession(NamedTuple):
    """The history of a session and the source of its first scene."""

    history: History
    source: Source


def read_journal(path: str | os.PathLike[str], *, limit: float | None = None) -> JournalSession:
    """The session of a journal: `Studio(read_journal(path).history)` goes on with it.

    Meshes are read from their files. Raises InputError if a line is no step of this version, if a step is
    refused, or if a mesh was changed since; MissingInputError if a file is missing. `limit` is a factor for
    the memory budget.
    """
    with allowing(limit):
        return _session_of(Path(path))


def _session_of(path: Path) -> JournalSession:
    data = read_bytes(path, LARGEST_JOURNAL)
    if data.startswith(b'"""'):
        raise InputError(f"{path.name}: it is the script of a session, not a journal; run it with Python")
    *lines, _ = data.split(b"\n", MOST_LINES + 1)
    if len(lines) > MOST_LINES:
        raise InputError(
            f"{path.name}: a journal must have at most {MOST_LINES:,} lines; choose another file"
        )
    if not lines or not lines[0].startswith(b'{"step": "begin", '):
        raise InputError(f"{path.name}: a journal must begin as autocolor writes it; choose another file")
    with _in_line(path.name, 1):
        begin = _record_of(lines[0])
        first, source = _opened(begin)
    history = History(*first)
    meshes = {"": history.start.mesh}
    earlier = EarlierSteps() if begin["version"] == 1 else None
    for number, line in enumerate(lines[1:], 2):
        with _in_line(path.name, number):
            record = _record_of(line, begin["version"])
            if earlier is None:
                _take(record, history, meshes, path.parent)
            else:
                earlier.take(record, history, meshes, path.parent)
    return JournalSession(history, source)


# Writing lines.


def first_line(start: Scene, source: Source) -> str:
    """The first line of a journal, which opens the first scene."""
    return _line({"step": "begin", "version": VERSION, **_scene_record(start, source)})


def step_line(step: Step, start: Scene, meshes: MeshesBeside) -> str:
    """The line of a step; `start` is the first scene.

    A mesh that was changed is saved with `meshes`. Raises as `MeshesBeside.folder_of`.
    """
    match step:
        case Edit():
            return _line({"step": "edit", **_edit_record(step, start, meshes)})
        case Open(scene, source):
            return _line({"step": "open", **_scene_record(scene, source)})
        case Keep(name) | Show(name) | Drop(name):
            return _line({"step": type(step).__name__.lower(), "name": name})
        case Rename():
            return _line({"step": "rename", **step._asdict()})
        case Saved():
            return _line({"step": "saved" if step.is_own else "on_disk", "files": step.files})
        case Move(way, steps):
            return _line({"step": way, "steps": steps})


def _line(record: Mapping[str, object]) -> str:
    # In ASCII, a file name that is not UTF-8 can be written, with escapes for its surrogates.
    return f"{json.dumps(record, ensure_ascii=True)}\n"


def _scene_record(scene: Scene, source: Source) -> dict[str, object]:
    absolute = source._replace(path=os.path.abspath(source.path))
    return {**absolute._asdict(), "tables": to_plain(scene), "checksum": checksum_of(scene)}


def _edit_record(edit: Edit, start: Scene, meshes: MeshesBeside) -> dict[str, object]:
    mesh = None
    if edit.before.mesh is not edit.after.mesh:
        mesh = "" if edit.after.mesh is start.mesh else meshes.folder_of(edit.after).name
    change = change_between(edit.before, edit.after)
    return {**change._asdict(), "mesh": mesh, "joins": edit.joins}


class Change(NamedTuple):
    """A call that makes another scene: the method of a scene, the row that it changes, and its keywords."""

    change: str
    row: str | None
    columns: Mapping[str, object]


ROW_METHODS: Final = {"parts": "with_part", "surfaces": "with_surface", "lights": "with_light"}
"""The methods of a scene that change one row of a table."""

CHANGES_OF_A_ROW: Final = frozenset((*ROW_METHODS.values(), "with_new_light", "without_light"))
CHANGES: Final = CHANGES_OF_A_ROW | {"replace", "with_view", "with_scalar", "without_scalar"}


def change_between(before: Scene, after: Scene) -> Change:
    """The narrowest change that makes one scene equal to another, except for its mesh."""
    tables = [name for name in fields_of(Scene) if vars(before)[name] is not vars(after)[name]]
    if tables == ["view"]:
        return Change("with_view", None, difference(before.view, after.view))
    if tables == ["scalar"] and after.scalar is None:
        return Change("without_scalar", None, {})
    if tables == ["scalar"] and after.scalar is not None:
        row = after.scalar
        return Change("with_scalar", None, difference(before.scalar, row) if before.scalar else to_plain(row))
    if len(tables) == 1 and tables[0] in ROW_METHODS:
        rows, others = vars(before)[tables[0]], vars(after)[tables[0]]
        change = _change_of_row(ROW_METHODS[tables[0]], rows, others)
        if change is None and tables == ["lights"]:
            change = _light_added_or_removed(rows, others)
        if change is not None:
            return change
    return Change("replace", None, difference(before, after))


def _change_of_row(method: str, rows: tuple[Any, ...], others: tuple[Any, ...]) -> Change | None:
    """The change of one row of a table; None if more than one row changed."""
    if len(rows) != len(others):
        return None
    changed = [(row, other) for row, other in zip(rows, others, strict=True) if row != other]
    if len(changed) != 1:
        return None
    columns = difference(*changed[0])
    return Change(method, changed[0][0].name, columns) if columns else None


def _light_added_or_removed(lights: tuple[Any, ...], others: tuple[Any, ...]) -> Change | None:
    """The change that adds a light after the others, or removes one; None if it is another change."""
    if others[:-1] == lights:
        columns = to_plain(others[-1])
        return Change("with_new_light", str(columns.pop("name")), columns)
    removed = [light for light in lights if light not in others]
    if len(removed) == 1 and tuple(light for light in lights if light is not removed[0]) == others:
        return Change("without_light", removed[0].name, {})
    return None


class MeshesBeside:
    """The meshes that a session changed. Each mesh is saved with its scene, in a folder beside the journal.

    `folder` is the folder of the journal; None if nothing may be written.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._folders: dict[Mesh, Path] = {}

    def folder_of(self, scene: Scene) -> Path:
        """The folder with the mesh of a scene; the first call for a mesh writes it.

        Raises InputError if nothing may be written; OutputError or WriteError if writing fails.
        """
        if self._folder is None:
            raise InputError(
                "a mesh that a session changed must be saved beside its journal, and no folder is named for"
                " it; name one with beside="
            )
        if scene.mesh not in self._folders:
            self._folders[scene.mesh] = _folder_beside(self._folder, scene.mesh) or _written(
                self._folder, scene
            )
        return self._folders[scene.mesh]


def _folder_beside(folder: Path, mesh: Mesh) -> Path | None:
    """The folder beside the journal that a mesh was read from; None if it was read elsewhere."""
    source = SOURCES.get(mesh)
    if source is None or source.scene_file is None or source.folder.parent != folder.resolve():
        return None
    return folder / source.folder.name


def _written(folder: Path, scene: Scene) -> Path:
    """Write a scene to a new folder; returns the folder."""
    os.makedirs(folder, exist_ok=True)
    for number in count(2):
        path = folder / f"scene-{number}"
        if not os.path.lexists(path):
            break
    write_scene(path / SCENE_FILE, scene)
    return path


# Reading lines.

SCENE_FIELDS: Final = {
    "path": (str,),
    "up": (str,),
    "surfaces": (str,),
    "scale": (float, int),
    "tables": (dict,),
    "checksum": (str,),
}
STEPS: Final[Mapping[str, Mapping[str, tuple[type, ...]]]] = {
    "begin": {"version": (int,), **SCENE_FIELDS},
    "edit": {
        "change": (str,),
        "row": (str, type(None)),
        "columns": (dict,),
        "mesh": (str, type(None)),
        "joins": (bool,),
    },
    "open": SCENE_FIELDS,
    "keep": {"name": (str,)},
    "show": {"name": (str,)},
    "drop": {"name": (str,)},
    "rename": {"name": (str,), "to": (str,)},
    "saved": {"files": (dict,)},
    "on_disk": {"files": (dict,)},
    **{way: {"steps": (int,)} for way in WAYS},
}
"""The required fields of the kinds of steps, with the types of their values."""

NO_STEP: Final = "there must be a step to {}, and there is none; remove the line"

Record = dict[str, Any]
"""The fields of a step with values of the right types."""


def _record_of(line: bytes, version: int = VERSION) -> Record:
    """The step of a line. Raises InputError if neither this version nor an earlier one writes such a line."""
    if len(line) > LONGEST_LINE:
        raise InputError(f"it must be at most {LONGEST_LINE:,} bytes, not {len(line):,}; remove it")
    try:
        record = json.loads(line.decode())
    except (ValueError, RecursionError):
        record = None
    if version == 1 and record in ({"step": "undo"}, {"step": "redo"}):
        record["steps"] = 1
    if not isinstance(record, dict) or not _is_step(record):
        text = shown(line.decode(errors="replace"))
        raise InputError(
            f"it must be a step that this version of autocolor writes, not {text}; recover the session with"
            " the version that left it"
        )
    return record


def _is_step(record: Record) -> bool:
    """Whether a record is a step with all of its fields and no others."""
    kind = record.get("step")
    fields = STEPS.get(kind) if isinstance(kind, str) else None
    if fields is None or record.keys() != {"step", *fields}:
        return False
    if not all(type(record[name]) in types for name, types in fields.items()):
        return False
    if kind == "begin":
        return record["version"] in (1, VERSION)
    if kind in ("saved", "on_disk"):
        return all(isinstance(stamp, str) for stamp in record["files"].values())
    if kind == "edit":
        change, has_row = record["change"], record["row"] is not None
        has_right_row = change in CHANGES and has_row == (change in CHANGES_OF_A_ROW)
        has_right_mesh = record["mesh"] is None or change == "replace"
        return has_right_row and has_right_mesh and not (change.startswith("without") and record["columns"])
    return True


def _take(record: Record, history: History, meshes: dict[str, Mesh], folder: Path) -> None:
    """Take a step in a history. Raises AutocolorError if the step is refused.

    `folder` is the folder of the journal. `meshes` caches the meshes of the folders beside the journal.
    """
    kind = record["step"]
    match kind:
        case "edit":
            columns, mesh = record["columns"], record["mesh"]
            if mesh is not None and mesh not in meshes:
                meshes[mesh] = read_scene(folder / mesh).mesh
            if mesh is not None:
                columns = {**columns, "mesh": meshes[mesh]}
            rows = [] if record["row"] is None else [record["row"]]
            scene = getattr(history.scene, record["change"])(*rows, **columns)
            history.take(scene, record["joins"])
        case "open":
            history.open(*_opened(record, history))
        case "keep" | "drop":
            getattr(history, kind)(record["name"])
        case "rename":
            history.rename(record["name"], record["to"])
        case "show":
            history.go(history.shown(record["name"]), Show(record["name"]))
        case "saved" | "on_disk":
            history.mark_saved(record["files"], is_own=kind == "saved")
        case "begin":
            raise InputError("a journal must begin once; remove the line")
        case way:
            try:
                history.move(way, record["steps"])
            except IndexError:
                raise InputError(NO_STEP.format(way)) from None


class EarlierSteps:
    """The steps to undo and to redo of a journal of version 1, where an edit of the view was a step as well.

    The scene after each line is the scene that version 1 showed. Its views are edits of the view now.
    """

    def __init__(self) -> None:
        self._befores: list[tuple[View, int]] = []
        """The view before each step of version 1, and how many steps there were to undo."""
        self._afters: list[tuple[View, int]] = []

    def take(self, record: Record, history: History, meshes: dict[str, Mesh], folder: Path) -> None:
        """Take a step in a history, as `_take` does."""
        kind, view = record["step"], history.scene.view
        now = view, len(history.to_undo)
        if kind in ("undo", "redo"):
            ways = self._befores, self._afters
            there, here = ways if kind == "undo" else reversed(ways)
            if not there:
                raise InputError(NO_STEP.format(kind))
            here.append(now)
            view, steps = there.pop()
            for _ in range(abs(steps - now[1])):
                history.move(kind)
        else:
            _take(record, history, meshes, folder)
            if kind in ("open", "show") or not record.get("joins", True):
                self._befores.append(now)
                self._afters.clear()
            view = history.scene.view
            if kind == "show":
                view = history.variants[record["name"]].scene.view
        if view != history.scene.view:
            history.take(history.scene.replace(view=view))


def _opened(record: Record, history: History | None = None) -> tuple[Opened, Source]:
    """The scene that a step opens, with its tables at that time, and its source."""
    source = Source(*(record[name] for name in Source._fields))
    known = () if history is None else (history.on_disk.scene_of(source),)
    return opened(source, record["tables"], record["checksum"], known), source


@contextmanager
def _in_line(name: str, number: int) -> Iterator[None]:
    """Raise errors as InputError with the number of the line."""
    try:
        yield
    except AutocolorError as error:
        kind = MissingInputError if isinstance(error, MissingInputError) else InputError
        problem = str(error).replace("\n", "; ")
        raise kind(f"{name}, line {number}: {problem[:LONGEST_PROBLEM]}") from None
    except RecursionError:
        raise InputError(f"{name}, line {number}: its values must not be nested so deep; remove it") from None
