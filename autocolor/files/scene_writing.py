"""Writing a scene to a store, or to a `scene.toml` with its mesh beside it unless files there hold it.

A file that is there already is changed in place, so that its comments and its order stay, if it is a scene
file of the same object. First the mesh is written, under a name that no file has, then the scene file: if
that fails, the mesh is removed again, and the old scene file still names the old mesh.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, OutputError, UsageError, reason_of
from autocolor.files.formats import mesh_suffixes, suffixes_of
from autocolor.files.mesh_writing import Meshes, entries_of, meshes_there, reports_of, written_mesh
from autocolor.files.paths import SCENE_FILE
from autocolor.files.reading import read_bytes
from autocolor.files.scene_sources import SCENE_FORMATS
from autocolor.files.scenes.scene_edit import (
    completed,
    edited_to,
    with_crease_angle,
    with_meshes,
    without_parts,
)
from autocolor.files.scenes.scene_file import report_of_text
from autocolor.files.scenes.scene_meshes import source_of
from autocolor.files.scenes.toml_text import LARGEST_TEXT, parsed_toml, scene_text
from autocolor.files.store.store_file import STORE_SUFFIXES, write_store
from autocolor.files.writing import refuse_output, write_atomically
from autocolor.logs import logger_of
from autocolor.scene.columns import Row, row_label, to_plain
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.scene import Scene, check_scene

LOG: Final = logger_of(__name__)


def write_scene(path: str | os.PathLike[str], scene: Scene, *, overwrite: bool = False) -> None:
    """Write a scene so that `read_scene` gives it back: its tables as TOML, and its mesh.

    `path` is a store (.sqlite, .db; see `write_store`), a scene file (.toml), or a folder, for a `scene.toml`
    in it; a folder that does not exist is made in one that does. Mesh files that the scene was read from are
    named if they are in that folder and still hold its mesh; else the mesh is written beside the scene file,
    under a name that is free. The scene's name is that of its folder or file, and is written to stores alone.

    With `overwrite`, a scene file may exist. If it is one of the same object, its comments, its order and the
    way in which it is written stay, and only what differs is changed. Mesh files are never overwritten.

    Raises OutputError if the file exists and `overwrite` is false, or if nothing can be created there;
    WriteError if writing fails; UsageError for a path that is that of another kind of file. Nothing is
    changed then.
    """
    write_scene_with_tables(path, scene, overwrite=overwrite, complete=False)


def write_scene_with_tables(
    path: str | os.PathLike[str], scene: Scene, *, overwrite: bool, complete: bool = True
) -> list[Path]:
    """Like `write_scene`; returns the files that were written, the scene file last.

    If `complete`, all keys are written, also those whose values are their defaults.
    """
    if Path(path).suffix.lower() in STORE_SUFFIXES and not os.path.isdir(path):
        write_store(path, scene, overwrite=overwrite)
        return [Path(path)]
    target = _target(path)
    check_scene(scene)
    refuse_names((*scene.parts, *scene.surfaces, *scene.lights))
    with _folder_made(target.parent), _removed_on_failure() as written:
        refuse_output(target, overwrite=overwrite)
        old = _existing(target)
        meshes = meshes_there(target.parent, scene.mesh, old)
        if meshes is None:
            meshes = written_mesh(target.parent, scene.mesh, written)
        data = None if old is None else _edited(old, target, scene, meshes, complete)
        if data is None:
            if old is not None:
                LOG.warning("%s: written anew; what it held, comments included, is not kept", target)
            data = _fresh(target, scene, meshes, complete)
        write_atomically(target, data, overwrite=overwrite)
        return [*written, target]


def _target(path: str | os.PathLike[str]) -> Path:
    """The scene file to write for a path. Raises UsageError for a path that none is written to."""
    if not os.fspath(path):
        raise UsageError("a scene must have a place, not an empty name; for the current folder write '.'")
    target = Path(path)
    suffix = target.suffix.lower()
    try:
        if target.is_dir():
            return target / SCENE_FILE
        is_other = target.exists() and suffix != ".toml"
    except (OSError, ValueError):
        is_other = False
    if is_other or suffix in {*suffixes_of(SCENE_FORMATS), *mesh_suffixes()} - {".toml"}:
        raise UsageError(
            f"a scene must be written to a folder or to a file that ends in .toml,"
            f" {' or '.join(STORE_SUFFIXES)}, not to {target}; choose another name"
        )
    return target if suffix == ".toml" else target / SCENE_FILE


def refuse_names(rows: Iterable[Row]) -> None:
    """Raise InputError if a name in a row, its own or another, has a character that UTF-8 does not."""
    for row in rows:
        if any(0xD800 <= ord(letter) < 0xE000 for text in _texts_in(to_plain(row)) for letter in text):
            raise InputError(f"{row_label(row)}: a name in a file must be text in UTF-8; rename it")


def _texts_in(value: object) -> Iterator[str]:
    """The texts in a plain value, also those inside, and the keys of tables."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, tuple, Mapping)):
        inner = value.values() if isinstance(value, Mapping) else value
        yield from value if isinstance(value, Mapping) else ()
        for each in inner:
            yield from _texts_in(each)


@contextmanager
def _folder_made(folder: Path) -> Iterator[None]:
    """Make a folder if there is none; remove it if what follows fails. Raises OutputError."""
    try:
        os.mkdir(folder)
    except FileExistsError:
        yield
        return
    except (OSError, ValueError) as error:
        raise OutputError(
            f"a scene must have a folder to be in, and {str(folder)!r} cannot be made ({reason_of(error)});"
            " choose another place"
        ) from None
    try:
        yield
    except BaseException:
        with suppress(OSError):
            os.rmdir(folder)
        raise


@contextmanager
def _removed_on_failure() -> Iterator[list[Path]]:
    """A list of files to remove again if what follows fails."""
    written: list[Path] = []
    try:
        yield written
    except BaseException:
        for path in written:
            with suppress(OSError):
                os.unlink(path)
        raise


def _existing(target: Path) -> bytes | None:
    """The text of the scene file that is there; None if there is none that is valid TOML."""
    try:
        data = read_bytes(target, LARGEST_TEXT)
        parsed_toml(data, target.name)
    except InputError:
        return None
    return data


def _edited(old: bytes, target: Path, scene: Scene, meshes: Meshes, complete: bool) -> bytes | None:
    """The old text, changed to give the scene; None if it is of another object, or cannot be changed to."""
    mesh, document = scene.mesh, parsed_toml(old, target.name)
    given = document.get("parts")
    parts = set(given) if isinstance(given, dict) else set()
    source = source_of(mesh)
    is_kept = tuple(document.get("mesh", ())) == meshes.entries
    is_source = source is not None and source.scene_file == target.resolve()
    if not (is_kept or is_source or parts & set(mesh.part_names)):
        before = {
            name for report in reports_of(target.parent, entries_of(old)) for name in report.mesh.part_names
        }
        if before.isdisjoint(mesh.part_names):
            return None
    data = without_parts(old, parts - set(mesh.part_names))
    if not is_kept:
        data = with_meshes(data, meshes.entries)
    if complete or mesh.crease_angle != (meshes.reports[0].mesh.crease_angle if is_kept else CREASE_ANGLE):
        data = with_crease_angle(data, mesh.crease_angle)
    found = _giving(data, target, scene, meshes)
    return _giving(completed(found, scene), target, scene, meshes) if complete and found else found


def _fresh(target: Path, scene: Scene, meshes: Meshes, complete: bool) -> bytes:
    """A new text that gives the scene. Raises OutputError if there is none."""
    entries = [{key: entry[key] for key in entry if key != "crease_angle"} for entry in meshes.entries]
    text = scene_text(scene, entries, without_defaults=not complete).encode()
    data = _giving(text, target, scene, meshes)
    if data is None:
        raise OutputError(
            f"{target}: a scene file must have at most {LARGEST_TEXT:,} bytes and give the same scene, and"
            f" this one of {len(text):,} does not; save the scene with its picture instead"
        )
    return data


def _giving(data: bytes, target: Path, scene: Scene, meshes: Meshes) -> bytes | None:
    """The text, changed until it gives the scene; None if it cannot be."""

    def read(text: bytes) -> Scene:
        return report_of_text(text, target, meshes=meshes.reports).scene

    found = edited_to(data, scene, read)
    return found if found is not None and len(found) <= LARGEST_TEXT else None
