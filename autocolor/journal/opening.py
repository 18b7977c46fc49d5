"""Opening a scene in a session, and opening it again as it was then."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from autocolor.errors import InputError
from autocolor.files.picture_file import plain_scene
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import Opened
from autocolor.journal.places import Place, Source, place_of
from autocolor.scene.mesh import Mesh, has_same_tables
from autocolor.scene.scene import Scene


def opened(source: Source, tables: Mapping[str, Any] | None = None, checksum: str | None = None) -> Opened:
    """The scene of a source, with the tables that it had then, and its place.

    Only the mesh must still be in the files: the tables may have been saved over since. Raises InputError if
    the scene is not that of the checksum, and as `read_scene`.
    """
    place = place_of(source)
    read = read_scene(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    scene = read if tables is None else read.replace(**tables)
    if checksum is not None:
        check_sum(scene, checksum, source)
    return Opened(scene, place_again(place, scene, read))


def opened_again(source: Source, present: Scene) -> Opened:
    """The scene of a source as it is now, and its place; it shares the mesh of the present one if that is it.

    Raises InputError as `read_scene`.
    """
    found = opened(source)
    if not is_same_mesh(found.scene.mesh, present.mesh):
        return found
    return Opened(found.scene.replace(mesh=present.mesh), found.place)


def is_same_mesh(one: Mesh, other: Mesh) -> bool:
    """Whether all of two meshes is equal, their crease angles too."""
    return one.crease_angle == other.crease_angle and has_same_tables(one, other)


def place_again(place: Place, then: Scene, now: Scene) -> Place:
    """The place of a scene that was opened again: a file that holds another one now is not saved to."""
    return place if then.equals(now) else Place(place.source)


def check_sum(scene: Scene, checksum: object, source: Source) -> None:
    """Raise InputError if the checksum of a scene that was opened again is not that of then."""
    if checksum != checksum_of(scene):
        raise InputError(
            f"{source.path} must hold the mesh that it held when it was opened, and it was changed since;"
            " bring the old file back"
        )


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
