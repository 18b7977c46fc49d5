"""The formats that a scene can be written in, found by the name of what is written or by their own."""

from __future__ import annotations

import difflib
import os
from functools import partial
from pathlib import Path
from typing import Final

from autocolor.errors import UsageError
from autocolor.files.conversion.folder_output import write_folder
from autocolor.files.conversion.obj_output import write_obj
from autocolor.files.conversion.output import SURFACES, Output
from autocolor.files.meshes.formats import MeshFormat, format_of_folder, mesh_formats
from autocolor.files.meshes.obj.obj_file import OBJ
from autocolor.files.paths import SCENE_FILE
from autocolor.files.registry import format_named, suffix_rule, suffixes_of
from autocolor.files.scene_writing import write_scene_with_tables
from autocolor.files.scenes.store_scene import STORE
from autocolor.files.writing import write_atomically
from autocolor.scene.scene import Scene


def _write_scene(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    return write_scene_with_tables(path, scene, overwrite=overwrite, complete=False)


def _write_store(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    from autocolor.files.store.store_file import write_store

    write_store(path, scene, overwrite=overwrite)
    return [path]


STORE_OUTPUT: Final = Output(STORE.name, STORE.suffixes, _write_store)
SCENE: Final = Output("scene", (".toml",), _write_scene, in_folder=(SCENE_FILE,))


def outputs() -> tuple[Output, ...]:
    """All formats that a scene can be written in, sorted by name without regard to capitals."""
    meshes = [_mesh_output(each) for each in mesh_formats() if each.written or each.write]
    return tuple(sorted([*meshes, SCENE, STORE_OUTPUT], key=lambda each: each.name.casefold()))


def _mesh_output(mesh_format: MeshFormat) -> Output:
    name, suffixes = mesh_format.name, mesh_format.suffixes
    if mesh_format is OBJ:
        return Output(name, suffixes, write_obj, mesh_format.holds | {SURFACES})
    if mesh_format.written is not None:
        return Output(name, suffixes, partial(_write_file, mesh_format), mesh_format.holds)
    return Output(
        name, suffixes, partial(_write_files, mesh_format), mesh_format.holds, mesh_format.in_folder
    )


def _write_file(mesh_format: MeshFormat, path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    assert mesh_format.written is not None
    write_atomically(path, mesh_format.written(scene.mesh), overwrite=overwrite)
    return [path]


def _write_files(mesh_format: MeshFormat, path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    assert mesh_format.write is not None
    folder = path.parent if path.name in mesh_format.in_folder else path
    return write_folder(folder, scene.mesh, mesh_format.write, overwrite=overwrite)


def output_named(name: str) -> Output:
    """The format of a name, in any capitals. Raises UsageError if there is none."""
    known = {each.name.casefold(): each for each in outputs()}
    if name.casefold() in known:
        return known[name.casefold()]
    near = difflib.get_close_matches(name.casefold(), known, 1)
    raise UsageError(
        f"--to must be {_listed([each.name for each in outputs()])}, not {name!r}"
        + (f"; did you mean {known[near[0]].name}?" if near else "; choose one")
    )


def output_of(path: Path) -> Output:
    """The format of what is written to a path.

    A folder that is there keeps its format, and has a scene if it has none; a file has that of its suffix,
    or of its name if it is one of several; what has no suffix becomes the folder of a scene. Raises
    UsageError for any other suffix.
    """
    every = outputs()
    # Unlike `Path.is_dir`, it never raises for a name that is too long.
    if os.path.isdir(path):
        if not (path / SCENE_FILE).exists():
            mesh_format = format_of_folder(path)
            found = next((each for each in every if mesh_format and each.name == mesh_format.name), None)
            if found is not None:
                return found
            named = format_named(path, [each for each in every if each.in_folder])
            return SCENE if named is None else named
        return SCENE
    by_name = next((each for each in every if path.name in each.in_folder), None)
    found = by_name or format_named(path, every)
    if found is not None:
        return found
    if not path.suffix:
        return SCENE
    raise UsageError(
        f"OUT must {suffix_rule(path, suffixes_of(every))}; name another, without an ending for the folder of"
        " a scene, or choose a format with --to"
    )


def _listed(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}"
