"""Writing a scene in any format: the formats, which parts of a scene they can hold, and the writers.

A format is recognized by the name of the file or folder that is written, or chosen by its own name.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import underflowing
from autocolor.checks import shown
from autocolor.errors import UsageError
from autocolor.files.formats import (
    DOUBLES,
    MESH_EXTRAS,
    MESH_FORMATS,
    NODE_SCALARS,
    PARTS,
    POLYGON_SCALARS,
    QUADS,
    Format,
    MeshFormat,
    format_named,
    format_of_folder,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.obj import materials_of, mtl_text, obj_text
from autocolor.files.meshes.repair import name_of
from autocolor.files.paths import SCENE_FILE, free_path
from autocolor.files.scene_sources import STORE
from autocolor.files.scene_writing import write_scene_with_tables
from autocolor.files.store.store_file import write_store
from autocolor.files.writing import refuse_output, write_atomically
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import SHARED
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import NODE
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

SURFACES: Final = "surfaces"
LIGHTS: Final = "lights"
VIEW: Final = "view"
SETTINGS: Final = "settings"
WHOLE_SCENE: Final = frozenset((*MESH_EXTRAS, SURFACES, LIGHTS, VIEW, SETTINGS))
"""The parts of a scene, beside nodes and polygons, that a format may hold."""

SceneWriter = Callable[[Path, Scene, bool], list[Path]]
"""A function that writes a scene to a path, and overwrites existing files if that is allowed.

It returns the files that it wrote. It raises OutputError or WriteError, and leaves no file half written."""


@dataclass(frozen=True)
class OutputFormat(Format):
    """A format that a scene can be written in.

    Its suffixes are for a file or a folder. `holds` are the parts of WHOLE_SCENE that can be read back.
    """

    write: SceneWriter
    holds: frozenset[str] = WHOLE_SCENE


def outputs() -> tuple[OutputFormat, ...]:
    """All formats that a scene can be written in, sorted by name without regard to capitals."""
    meshes = [_mesh_output(each) for each in MESH_FORMATS if each.written or each.write]
    return tuple(sorted([*meshes, SCENE, STORE_OUTPUT], key=lambda each: each.name.casefold()))


def _mesh_output(mesh_format: MeshFormat) -> OutputFormat:
    name, suffixes = mesh_format.name, mesh_format.suffixes
    if mesh_format.written is obj_text:
        return OutputFormat(name, suffixes, write_obj, mesh_format.holds | {SURFACES})
    if mesh_format.written is not None:
        return OutputFormat(name, suffixes, partial(_write_file, mesh_format), mesh_format.holds)
    write = partial(_write_files, mesh_format)
    return OutputFormat(name, suffixes, write, mesh_format.holds, in_folder=mesh_format.in_folder)


def output_named(name: str) -> OutputFormat:
    """The format with this name, in any capitals. Raises UsageError if no format has it."""
    formats = {output.name.casefold(): output for output in outputs()}
    if name.casefold() in formats:
        return formats[name.casefold()]
    near = difflib.get_close_matches(name.casefold(), formats, 1)
    *names, last = [output.name for output in formats.values()]
    raise UsageError(
        f"--to must be {', '.join(names)} or {last}, not {name!r}"
        + (f"; did you mean {formats[near[0]].name}?" if near else "; choose one")
    )


def output_of(path: Path) -> OutputFormat:
    """The format for a path that is written.

    An existing folder keeps its format; an empty folder gets a scene. The name of a file decides if it is the
    name of a file in a mesh folder, such as nodes.csv; otherwise the suffix decides. A path without a suffix
    becomes the folder of a scene. Raises UsageError for an unknown suffix.
    """
    formats = outputs()
    # Unlike `Path.is_dir`, it never raises for a name that is too long.
    if os.path.isdir(path):
        if (path / SCENE_FILE).exists():
            return SCENE
        mesh_format = format_of_folder(path)
        of_folder = next((each for each in formats if mesh_format and each.name == mesh_format.name), None)
        return of_folder or format_named(path, [each for each in formats if each.in_folder]) or SCENE
    output = next((each for each in formats if path.name in each.in_folder), None)
    output = output or format_named(path, formats)
    if output is not None:
        return output
    if not path.suffix:
        return SCENE
    raise UsageError(
        f"OUT must {suffix_rule(path, suffixes_of(formats))}; name another, without an ending for the folder"
        " of a scene, or choose a format with --to"
    )


# The parts of a scene that a format cannot hold.

MOST_NAMED: Final = 5


def left_out(scene: Scene, output: OutputFormat, *, is_bare: bool) -> list[str]:
    """A phrase for each part of a scene that a format cannot hold: "2 node scalars ('stress', 'u')".

    If the source `is_bare`, a mesh without a scene, only parts of the mesh count: all else was created.
    """
    phrases = list(_of_mesh(scene, output))
    if not is_bare:
        phrases.extend(_of_scene(scene, output))
    return phrases


def _of_mesh(scene: Scene, output: OutputFormat) -> Iterator[str]:
    mesh = scene.mesh
    if PARTS not in output.holds and len(mesh.part_names) > 1:
        yield f"{len(mesh.part_names):,} parts ({_named(mesh.part_names)})"
    for extra, noun in ((NODE_SCALARS, "node scalar"), (POLYGON_SCALARS, "polygon scalar")):
        names = [each.name for each in mesh.scalars if (each.of == NODE) == (extra == NODE_SCALARS)]
        if extra not in output.holds and names:
            yield f"{len(names):,} {noun}{'s' if len(names) > 1 else ''} ({_named(names)})"
    quads = len(mesh.node_numbers) - mesh.triangle_count
    if QUADS not in output.holds and quads:
        yield f"{quads:,} quad{'s' if quads > 1 else ''} (each is written as two triangles)"
    if DOUBLES not in output.holds and (rounded := _rounded_nodes(mesh)):
        yield f"the double precision of {rounded:,} node{'s' if rounded > 1 else ''} (rounded to single)"
    if SETTINGS not in output.holds and mesh.crease_angle != CREASE_ANGLE:
        yield f"the crease angle of {mesh.crease_angle:g} degrees"


@underflowing
def _rounded_nodes(mesh: Mesh) -> int:
    """The number of nodes with a coordinate that float32 does not hold."""
    return int((mesh.coordinates.astype(np.float32) != mesh.coordinates).any(axis=1).sum())


def _of_scene(scene: Scene, output: OutputFormat) -> Iterator[str]:
    count = len(scene.surfaces)
    if SURFACES not in output.holds and count:
        named = _named([each.name for each in scene.surfaces])
        yield f"{count:,} surface{'s' if count > 1 else ''} ({named})"
    elif LIGHTS not in output.holds and (names := beyond_materials(scene.surfaces)):
        yield f"what a material does not have of {len(names):,} of {count:,} surfaces ({_named(names)})"
    if LIGHTS not in output.holds and scene.lights:
        count = len(scene.lights)
        yield f"{count:,} light{'s' if count > 1 else ''} ({_named([each.name for each in scene.lights])})"
    if VIEW not in output.holds:
        count = len(scene.views)
        yield f"the view and {count} named view{'s' if count > 1 else ''}" if count else "the view"
    if SETTINGS not in output.holds and (names := _settings(scene)):
        yield f"{len(names)} setting{'s' if len(names) > 1 else ''} ({_named(names)})"


def _settings(scene: Scene) -> list[str]:
    """The names of the fields of a scene, without its tables, that differ from their defaults."""
    return [
        name
        for name, field in fields_of(Scene).items()
        if name not in ("name", "view", "views", "lights", "parts", "surfaces")
        and field.default is not None
        and vars(scene)[name] != field.default()
    ]


def _named(names: Sequence[str]) -> str:
    more = f" and {len(names) - MOST_NAMED:,} more" if len(names) > MOST_NAMED else ""
    return ", ".join(shown(name) for name in names[:MOST_NAMED]) + more


# The writers.


def _write_scene(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    return write_scene_with_tables(path, scene, overwrite=overwrite, complete=False)


def _write_store(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    write_store(path, scene, overwrite=overwrite)
    return [path]


def _write_file(mesh_format: MeshFormat, path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    assert mesh_format.written is not None
    write_atomically(path, mesh_format.written(scene.mesh), overwrite=overwrite)
    return [path]


def _write_files(mesh_format: MeshFormat, path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    assert mesh_format.write is not None
    folder = path.parent if path.name in mesh_format.in_folder else path
    return mesh_format.write(folder, scene.mesh, overwrite=overwrite)


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
    """The names of the surfaces that a material library cannot hold whole."""

    def read_back(surface: Surface) -> Surface:
        materials, _ = materials_of(mtl_text([("material", surface)]), "", {"material"})
        return materials["material"].replace(name=surface.name)

    return [surface.name for surface in surfaces if read_back(surface) != surface]


STORE_OUTPUT: Final = OutputFormat(STORE.name, STORE.suffixes, _write_store)
SCENE: Final = OutputFormat("scene", (".toml",), _write_scene, in_folder=(SCENE_FILE,))
