"""Converting a scene, without the arrays of its mesh, to values that JSON can hold, and back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from autocolor.arrays import AnyArray
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.scene.columns import from_plain, to_plain
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.scene import Scene


def plain_scene(scene: Scene) -> dict[str, Any]:
    """The tables of a scene as values that JSON can hold, without the arrays of the mesh.

    Keys whose value is None or infinite are omitted.
    """
    mesh = {"part_names": scene.mesh.part_names, "crease_angle": scene.mesh.crease_angle}
    return {"mesh": mesh, **to_plain(scene)}


def scene_of_plain(
    values: object,
    coordinates: AnyArray,
    node_numbers: AnyArray,
    part_numbers: AnyArray,
    scalars: tuple[MeshScalar, ...] = (),
) -> Scene:
    """The scene of values as from `plain_scene` and of the mesh's arrays and scalars. Raises InputError."""
    if not isinstance(values, Mapping) or not isinstance(values.get("mesh"), Mapping):
        raise InputError(f"scene: it must be tables, its mesh among them, not {shown(values)}")
    described = values["mesh"]
    mesh = Mesh(
        coordinates,
        node_numbers,
        part_numbers,
        described.get("part_names", ()),
        described.get("crease_angle", math.nan),
        scalars,
    )
    return from_plain(Scene, {**values, "mesh": mesh})
