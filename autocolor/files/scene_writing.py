"""Writing a scene to a store, or to a `scene.toml` with its mesh beside it.

Mesh files that hold the mesh are named again; otherwise the mesh is written first, under a new name, and the
scene file then. If that fails, the mesh is removed, and the old scene file still names the old mesh. An old
scene file of the same object is edited, so that its comments and its order stay.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, OutputError, UsageError
from autocolor.files.formats import MESH_FORMATS, suffixes_of
from autocolor.files.paths import PICTURE_SUFFIX, SCENE_FILE, STORE_SUFFIXES
from autocolor.files.reading import read_bytes
from autocolor.files.scene_toml.scene_meshes import (
    SOURCES,
    Meshes,
    entries_of,
    meshes_there,
    reports_of,
    written_mesh,
)
from autocolor.files.scene_toml.scene_text import edited_to, tables_of, with_crease_angle
from autocolor.files.scene_toml.toml_edit import edited_toml
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, parsed_toml
from autocolor.files.store.store_file import write_store
from autocolor.files.writing import Guard, new_folder, no_guard, refuse_output, write_atomically
from autocolor.logs import logger_of
from autocolor.scene.scene import Scene, check_scene

LOG: Final = logger_of(__name__)


def write_scene(
    path: str | os.PathLike[str],
    scene: Scene,
    *,
    overwrite: bool = False,
    complete: bool = False,
    guard: Guard = no_guard,
) -> list[Path]:
    """Write a scene so that `read_scene` gives it back: its tables as TOML, and its mesh.

    `path` is a store (.sqlite, .db; see `write_store`), a scene file (.toml), or a folder, for a `scene.toml`
    in it. A missing folder is created in an existing one. Mesh files that the scene was read from are named
    if they are in that folder and still hold its mesh; otherwise the mesh is written beside the scene file,
    to a new file. The scene's name is the name of its folder or file, and is written to stores alone.

    With `overwrite`, a scene file may exist. If it is a file of the same object, only the differences are
    changed, and its comments, its order and its style stay. Mesh files are never overwritten. If `complete`,
    all keys are written, also those whose values are their defaults. `guard` checks the scene file or store
    before it is overwritten.

    Returns the files that were written, the scene file last. Raises OutputError if the file exists and
    `overwrite` is false, or if nothing can be created there; WriteError if writing fails; UsageError for a
    path of another kind of file. Nothing is changed then.
    """
    if Path(path).suffix.lower() in STORE_SUFFIXES and not os.path.isdir(path):
        if scene.mesh.own_normals is not None:
            LOG.warning("%s: a store has no normals: those of the mesh file will be computed", path)
        write_store(path, scene, overwrite=overwrite, guard=guard)
        return [Path(path)]
    target = _target(path)
    check_scene(scene)
    written: list[Path] = []
    with new_folder(target.parent, "a scene"):
        try:
            refuse_output(target, overwrite=overwrite)
            check = guard(target)
            old = b""
            with suppress(InputError):
                # A file that is no valid TOML is written anew.
                present = read_bytes(target, LARGEST_TEXT)
                entries_of(present)
                old = present
            meshes = meshes_there(target.parent, scene.mesh, old)
            meshes = meshes or written_mesh(target.parent, scene.mesh, written)
            is_same = not old or _is_of_same_object(old, target, scene, meshes)
            data = _text(old, target, scene, meshes, complete) if is_same else None
            if data is None and old:
                LOG.warning("%s: written anew; its old content and comments are lost", target)
                data = _text(b"", target, scene, meshes, complete)
            if data is None:
                raise OutputError(
                    f"{target}: a scene file must have at most {LARGEST_TEXT:,} bytes and give the same"
                    " scene; save it with its picture instead"
                )
            check()
            write_atomically(target, data, overwrite=overwrite)
        except BaseException:
            for mesh_file in written:
                with suppress(OSError):
                    os.unlink(mesh_file)
            raise
    return [*written, target]


def _target(path: str | os.PathLike[str]) -> Path:
    """The scene file to write for a path. Raises UsageError for a path of another kind of file."""
    if not os.fspath(path):
        raise UsageError("a scene must have a place, not an empty name; for the current folder write '.'")
    target = Path(path)
    suffix = target.suffix.lower()
    if os.path.isdir(target):
        return target / SCENE_FILE
    is_other = os.path.exists(target) and suffix != ".toml"
    if is_other or suffix in {PICTURE_SUFFIX, *STORE_SUFFIXES, *suffixes_of(MESH_FORMATS)}:
        raise UsageError(
            f"a scene must be written to a folder or to a file that ends in .toml,"
            f" {' or '.join(STORE_SUFFIXES)}, not to {target}; choose another name"
        )
    return target if suffix == ".toml" else target / SCENE_FILE


def _is_of_same_object(old: bytes, target: Path, scene: Scene, meshes: Meshes) -> bool:
    """Whether a scene's mesh was read by the old text of its scene file, or has a part of its meshes."""
    source = SOURCES.get(scene.mesh)
    if entries_of(old) == meshes.entries or (source and source.scene_file == target.resolve()):
        return True
    reports = reports_of(target.parent, entries_of(old))
    return any(set(report.mesh.part_names) & set(scene.mesh.part_names) for report in reports)


def _text(old: bytes, target: Path, scene: Scene, meshes: Meshes, complete: bool) -> bytes | None:
    """The old text, which may be empty, edited until it gives the scene; None if no edit succeeds."""
    mesh, document = scene.mesh, parsed_toml(old, target.name)
    if isinstance(parts := document.get("parts"), dict):
        document["parts"] = {name: part for name, part in parts.items() if name in mesh.part_names}
    if complete or not old:
        document |= tables_of(scene, sparse=not complete)
    is_angle_written = complete or mesh.crease_angle != meshes.reports[0].mesh.crease_angle
    entries = with_crease_angle(meshes.entries, mesh.crease_angle) if is_angle_written else meshes.entries
    return edited_to(edited_toml(old, {**document, "mesh": entries}), scene, target, meshes.reports)
