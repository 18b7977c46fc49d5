"""Places: the files that scenes are opened from, and whether a scene may be saved to its file again.

A place is one opening of a file: opening a file twice makes two places. Edits belong to the place that was
opened last. A place has the stamp of its file, so a file that another program changed is never saved over.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.errors import InputError
from autocolor.files.paths import PICTURE_SUFFIX, SCENE_FILE, STORE_SUFFIXES
from autocolor.files.picture_file import plain_scene
from autocolor.files.scene_sources import read_scene
from autocolor.scene.creation import SurfaceSource
from autocolor.scene.mesh import has_same_tables
from autocolor.scene.scene import Scene

PACKAGE: Final = Path(__file__).resolve().parents[1]
"""The folder of this package, with the built-in demo; nothing is saved there."""


class Source(NamedTuple):
    """The path of a scene, and how it is read (see `read_scene`)."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class ScenePlace:
    """The place of a scene; `source` is None for a scene that was made in memory.

    `stamp` is the stamp of the file when the scene was opened (see `stamp_of`). Without a stamp, the scene is
    never saved to the file.
    """

    source: Source | None = None
    stamp: str | None = None


class Opened(NamedTuple):
    """A scene with the place that it belongs to."""

    scene: Scene
    place: ScenePlace


def opened(source: Source, tables: Mapping[str, Any] | None = None, checksum: str | None = None) -> Opened:
    """The scene of a source and its place.

    A journal gives the `tables` that the scene had when it was opened, because the file may have been saved
    over since. Only the mesh must still be the same. If the file has other tables now, the scene will not be
    saved to it. Raises InputError if the scene does not have the checksum, and as `read_scene`.
    """
    place = place_of(source)
    present = read_scene(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    scene = present if tables is None else present.replace(**tables)
    if checksum is not None and checksum != checksum_of(scene):
        raise InputError(
            f"{source.path} must hold the mesh that it held when it was opened, and it was changed since;"
            " bring the old file back"
        )
    return Opened(scene, place if scene.equals(present) else ScenePlace(source))


def opened_again(source: Source, present: Scene) -> Opened:
    """The scene of a source as it is now, and its place. An equal mesh is shared with the present scene.

    Raises InputError as `read_scene`.
    """
    again = opened(source)
    mesh, present_mesh = again.scene.mesh, present.mesh
    if mesh.crease_angle == present_mesh.crease_angle and has_same_tables(mesh, present_mesh):
        return Opened(again.scene.replace(mesh=present_mesh), again.place)
    return again


def place_of(source: Source) -> ScenePlace:
    """The place of a source as it is now. Files of this package, and mesh files, are never saved to."""
    path = file_of(source)
    stamp = None if path is None else stamp_of(path)
    if path is None or stamp is None or Path(os.path.realpath(path)).is_relative_to(PACKAGE):
        return ScenePlace(source)
    return ScenePlace(source, stamp)


def file_of(source: Source) -> Path | None:
    """The scene file, the store or the picture file of a source; None for a mesh."""
    path = Path(source.path)
    # Unlike Path.is_dir, this raises no error for a name that cannot be one.
    path = path / SCENE_FILE if os.path.isdir(path) else path
    return path if path.suffix.lower() in (".toml", PICTURE_SUFFIX, *STORE_SUFFIXES) else None


def stamp_of(path: Path) -> str | None:
    """The SHA-256 of the bytes of a file, in hexadecimal digits; None if it cannot be read.

    The stamp of a store includes its write-ahead log, the changes that are not yet in the store file.
    """
    try:
        with open(path, "rb") as file:
            digest = hashlib.file_digest(file, "sha256")
        log = Path(f"{path}-wal")
        if path.suffix.lower() in STORE_SUFFIXES and log.exists():
            digest.update(log.read_bytes())
    except (OSError, ValueError):
        return None
    return digest.hexdigest()


def checksum_of(scene: Scene) -> str:
    """The SHA-256 of all values of a scene, its mesh and scalars included, in hexadecimal digits."""
    digest = hashlib.sha256(json.dumps(plain_scene(scene), sort_keys=True).encode())
    mesh = scene.mesh
    for array, kind in ((mesh.coordinates, "<f8"), (mesh.node_numbers, "<i8"), (mesh.part_numbers, "<i8")):
        digest.update(np.ascontiguousarray(array, kind).tobytes())
    for scalar in mesh.scalars:
        digest.update(json.dumps([scalar.name, scalar.of]).encode())
        digest.update(np.ascontiguousarray(scalar.values, "<f8").tobytes())
    return digest.hexdigest()
