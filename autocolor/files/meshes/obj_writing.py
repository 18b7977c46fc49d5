"""Writing a scene as an OBJ file, with its surfaces as the materials of a library beside it."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Final

from autocolor.files.meshes.mtl import materials_of, mtl_text
from autocolor.files.meshes.obj import obj_text
from autocolor.files.meshes.repair import different, name_of
from autocolor.files.paths import free_path
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
    refuse_output(library, overwrite=overwrite)
    # An old OBJ file may name the old library. The new OBJ file names a spare library until that is replaced.
    has_old = os.path.lexists(path) and os.path.lexists(library)
    libraries = [free_path(library), library] if has_old else [library]
    for written in libraries:
        was_there = os.path.lexists(written)
        write_atomically(written, data, overwrite=overwrite)
        try:
            write_atomically(path, obj_text(scene.mesh, materials, written.name), overwrite=overwrite)
        except BaseException:
            if not was_there:
                with suppress(OSError):
                    os.unlink(written)
            raise
    if has_old:
        os.unlink(libraries[0])
    return [path, library]


def material_names(surfaces: Iterable[str]) -> dict[str, str]:
    """Unique material names for surfaces: their own names, without characters that MTL cannot hold."""
    surfaces = list(surfaces)
    names = [name_of(surface.encode("utf-8", "replace")) or "surface" for surface in surfaces]
    return dict(zip(surfaces, different(names), strict=True))


def beyond_materials(surfaces: Iterable[Surface]) -> list[str]:
    """The names of the surfaces that a material library cannot hold whole."""
    surface_of = {str(number): surface for number, surface in enumerate(surfaces)}
    read_back, _ = materials_of(mtl_text(surface_of.items()), "", {*surface_of})
    return [
        surface.name
        for number, surface in surface_of.items()
        if read_back[number].replace(name=surface.name) != surface
    ]
