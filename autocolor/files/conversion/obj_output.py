"""Writing a scene as an OBJ file, with the surfaces of its parts as the materials of a library beside it."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Final

from autocolor.files.meshes.obj.materials import materials_of
from autocolor.files.meshes.obj.obj_text import mtl_text, obj_text
from autocolor.files.repair.names import name_of
from autocolor.files.writing import refuse_output, write_atomically
from autocolor.scene.creation import SHARED
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

LIBRARY_SUFFIX: Final = ".mtl"


def write_obj(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    """Write the mesh of a scene to an OBJ file, and its surfaces to a library beside it; returns both.

    There is no library if one surface was created for all parts. Raises OutputError or WriteError.
    """
    refuse_output(path, overwrite=overwrite)
    if [surface.name for surface in scene.surfaces] == [SHARED]:
        write_atomically(path, obj_text(scene.mesh), overwrite=overwrite)
        return [path]
    library = path.with_suffix(LIBRARY_SUFFIX)
    names = material_names(surface.name for surface in scene.surfaces)
    surface_of = {part.name: part.surface for part in scene.parts}
    materials = [names[surface_of[part]] for part in scene.mesh.part_names]
    data = mtl_text((names[surface.name], surface) for surface in scene.surfaces)
    was_there = os.path.lexists(library)
    write_atomically(library, data, overwrite=overwrite)
    try:
        write_atomically(path, obj_text(scene.mesh, materials, library.name), overwrite=overwrite)
    except BaseException:
        if not was_there:
            with suppress(OSError):
                os.unlink(library)
        raise
    return [path, library]


def material_names(surfaces: Iterable[str]) -> dict[str, str]:
    """The name of the material of each surface: its own, as far as it can be read back, and unique."""
    names: dict[str, str] = {}
    for surface in surfaces:
        name = stem = name_of(surface.encode("utf-8", "replace")) or "surface"
        number = 1
        while name in names.values():
            number += 1
            name = f"{stem} {number}"
        names[surface] = name
    return names


def beyond_materials(surfaces: Iterable[Surface]) -> list[str]:
    """The names of the surfaces of which a material library does not hold everything."""
    return [surface.name for surface in surfaces if _read_back(surface) != surface]


def _read_back(surface: Surface) -> Surface:
    found, _ = materials_of(mtl_text([("material", surface)]), "", {"material"})
    return found["material"].replace(name=surface.name)
