"""Places: the files that scenes are opened from and saved to, and what the session knows of these files.

A place is one opening of a file: opening a file twice makes two places. Edits belong to the place that was
opened last. `FilesOnDisk` has the scene and the stamp of every file that the session read or wrote, so that a
file that another program changed since is never saved over.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.errors import InputError, OutputError
from autocolor.files.opening import read_scene_with_report
from autocolor.files.paths import PACKAGE, PICTURE_SUFFIX, SCENE_FILE, STORE_SUFFIXES
from autocolor.files.picture_file import plain_scene
from autocolor.files.stamps import numbers_of, stamp_of
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import SurfaceSource
from autocolor.scene.mesh import has_same_tables
from autocolor.scene.scene import Scene
from autocolor.scene.stage import NONE

NO_STAMP: Final = ""
"""The stamp of a file that holds another scene by now: no file has it."""


class Source(NamedTuple):
    """The path of a scene, and how it is read (see `read_scene`)."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class ScenePlace:
    """The place of a scene; `source` is None for a scene that was made in memory.

    `stamp` is the stamp of the file when the scene was opened (see `stamp_of`), or NO_STAMP if the file holds
    another scene by now. With None, the scene is never saved to the file. `repairs` say what was repaired and
    skipped when the file was read.
    """

    source: Source | None = None
    stamp: str | None = None
    repairs: tuple[str, ...] = ()

    @cached_property
    def file(self) -> str | None:
        """The absolute path of the file to save to; None if the scene is never saved to the file."""
        path = None if self.source is None or self.stamp is None else file_of(self.source)
        return None if path is None else os.path.abspath(path)


class Opened(NamedTuple):
    """A scene with the place that it belongs to."""

    scene: Scene
    place: ScenePlace


class OnDisk(NamedTuple):
    """A file as a session read or wrote it last: its scene and its stamp.

    `is_own` is whether `save_session` wrote the file. Other files get a backup before it overwrites them.
    `is_outdated` is whether the file holds another scene by now.
    """

    scene: Scene
    stamp: str
    is_own: bool
    is_outdated: bool = False


class FilesOnDisk:
    """The files that a session read or wrote, by their paths."""

    def __init__(self) -> None:
        self._files: dict[str, OnDisk] = {}
        self._real_paths: dict[str, str] = {}
        """The file that each path led to: a link may lead to another file since."""

    def __getitem__(self, path: str) -> OnDisk | None:
        """The file at a path as it was last; None if the session neither read nor wrote it."""
        return self._files.get(self._real_paths.get(path) or _real_path(path))

    def note(self, path: str, file: OnDisk) -> None:
        """Note that the session read or wrote a file."""
        self._real_paths[path] = _real_path(path)
        self._files[self._real_paths[path]] = file

    @property
    def scenes(self) -> tuple[Scene, ...]:
        """The scenes that the files hold."""
        return tuple(file.scene for file in self._files.values() if not file.is_outdated)

    def scene_of(self, source: Source) -> Scene | None:
        """The scene that a source's file held when the session read or wrote it last; None if unknown."""
        path = file_of(source)
        file = None if path is None else self[os.path.abspath(path)]
        return None if file is None else file.scene

    def was_changed(self, path: str) -> bool:
        """Whether another program changed a file since; False for a missing or an unknown file."""
        file = self[path]
        return file is not None and os.path.lexists(path) and stamp_of(Path(path)) != file.stamp

    def guard(self, path: Path) -> Callable[[], None]:
        """Refuse to overwrite a file that another program changed since (see `Guard`). Raises OutputError."""
        refusal = OutputError(
            f"an output must be as last read or saved, and another program changed {path}; read it by"
            " reopen() or open(), or choose another name"
        )
        numbers, name = numbers_of(path), os.path.abspath(path)

        def check() -> None:
            if self[name] is not None and numbers_of(path) != numbers:
                raise refusal

        if self.was_changed(name):
            raise refusal
        return check


def _real_path(path: str) -> str:
    """The path without links. A path that cannot be one, as in a damaged journal, stays."""
    try:
        return os.path.realpath(path)
    except (OSError, ValueError):
        return path


def opened(
    source: Source,
    tables: Mapping[str, Any] | None = None,
    checksum: str | None = None,
    known: Iterable[Scene | None] = (),
) -> Opened:
    """The scene of a source and its place. If one of the `known` scenes has an equal mesh, that is shared.

    A journal gives the `tables` that the scene had when it was opened, because the file may have been saved
    over since. Only the mesh must still be the same. If the file has other tables now, the scene will not be
    saved to it. Raises InputError if the scene does not have the checksum, and as `read_scene`.
    """
    place = place_of(source)
    report = read_scene_with_report(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    present, place = report.scene, replace(place, repairs=report.repairs)
    for mesh in [scene.mesh for scene in known if scene is not None]:
        if mesh.crease_angle == present.mesh.crease_angle and has_same_tables(mesh, present.mesh):
            present = present.replace(mesh=mesh)
    scene = present
    if tables is not None:
        # Tables leave out what a scene does not have, and the file may have it since.
        absent = {name: None for name, column in fields_of(Scene).items() if column.is_optional}
        scene = present.replace(**{**absent, **tables})
    if checksum is not None and checksum != checksum_of(scene):
        raise InputError(
            f"{source.path} must hold the mesh that it held when it was opened, and it was changed since;"
            " bring the old file back"
        )
    if place.stamp is not None and not scene.equals(present):
        place = replace(place, stamp=NO_STAMP)
    return Opened(scene, place)


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


def resolved(source: Source) -> Source:
    """The source with the absolute path of its file."""
    return source._replace(path=os.path.abspath(file_of(source) or source.path))


def checksum_of(scene: Scene) -> str:
    """The SHA-256 of all values of a scene, its mesh and scalars included, in hexadecimal digits."""
    plain = plain_scene(scene)
    if scene.stage == NONE:
        # The scenes of journals that know no stage keep their checksums.
        del plain["stage"]
    digest = hashlib.sha256(json.dumps(plain, sort_keys=True).encode())
    mesh = scene.mesh
    for array, kind in ((mesh.coordinates, "<f8"), (mesh.node_numbers, "<i8"), (mesh.part_numbers, "<i8")):
        digest.update(np.ascontiguousarray(array, kind).tobytes())
    if mesh.own_normals is not None:
        digest.update(np.ascontiguousarray(mesh.own_normals.vectors, "<f4").tobytes())
        digest.update(np.ascontiguousarray(mesh.own_normals.numbers, "<i8").tobytes())
    for scalar in mesh.scalars:
        digest.update(json.dumps([scalar.name, scalar.of]).encode())
        digest.update(np.ascontiguousarray(scalar.values, "<f8").tobytes())
    return digest.hexdigest()
