"""Reading a scene from a folder, a scene file, a store, a mesh file or a picture file.

To add a format of scenes, write its reader and a row of SCENE_FORMATS below.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from autocolor.budget import allowing
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.formats import (
    MESH_FORMATS,
    Format,
    MeshFormat,
    file_formats,
    files_of_folder,
    format_of_folder,
    read_mesh,
    recognized,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.repair import SCALES, UPS, Placement
from autocolor.files.meshes.up_axis import seems_to_lie
from autocolor.files.paths import PICTURE_SUFFIX, SCENE_FILE, STORE_SUFFIXES
from autocolor.files.picture_file import read_picture
from autocolor.files.reading import status_of, table_exists
from autocolor.files.scene_report import SceneReport, scene_report
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.files.scene_toml.scene_meshes import MeshSource, keep_source
from autocolor.scene.creation import MATERIALS, PARTS, SurfaceSource
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene

PathLike = str | os.PathLike[str]

SceneReader = Callable[..., SceneReport]
"""A function that reads the scene of a path. It raises InputError.

With `outside`, the scene may name files outside its folder. Parts without a surface get the surfaces of their
materials or their own surfaces, as `surfaces` says.
"""


@dataclass(frozen=True)
class SceneFormat(Format):
    """A file format that holds a whole scene."""

    read: SceneReader


def _read_picture_scene(path: Path, **_: object) -> SceneReport:
    """The scene of a picture file, which is complete: the options have no effect. Raises InputError."""
    return SceneReport(read_picture(path).scene)


def _read_store(path: Path, *, outside: bool, surfaces: SurfaceSource) -> SceneReport:
    """The scene of a store, which names no other files: `outside` has no effect. Raises InputError."""
    # SQLite is loaded for stores alone.
    from autocolor.files.store.store_file import read_store

    return read_store(path, surfaces=surfaces)


SCENE_FILE_FORMAT: Final = SceneFormat("scene file", (".toml",), read_scene_file, in_folder=(SCENE_FILE,))

STORE: Final = SceneFormat(
    "store", STORE_SUFFIXES, _read_store, begins=lambda head: head.startswith(b"SQLite format 3\0")
)

PICTURE: Final = SceneFormat(
    "picture file",
    (PICTURE_SUFFIX,),
    _read_picture_scene,
    begins=lambda head: head.startswith(b"PK\x03\x04"),
)

SCENE_FORMATS: Final = (PICTURE, SCENE_FILE_FORMAT, STORE)
"""All formats of whole scenes."""


def read_scene(
    path: PathLike,
    *,
    strict: bool = False,
    up: str = "z",
    scale: float = 1.0,
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
    limit: float | None = None,
) -> Scene:
    """The scene of a folder, a scene file (.toml), a store (.sqlite), a mesh file or a picture file (.npz).

    A folder must contain a `scene.toml`, or the tables of a mesh such as `nodes.csv` and `polygons.csv`;
    `autocolor convert --formats` lists all that can be read. Whatever the source does not define is created
    with defaults. `up` and `scale` are the up axis of a mesh that is read without a scene file, and a factor
    for its coordinates. With `outside`, a scene file may name files outside its folder. With `strict`, a mesh
    that needs repair is refused. A part without a surface has the surface of its material; with
    `surfaces="parts"`, each such part has its own surface. `limit` is a factor for the memory budget: a file
    that needs more is refused before it is read. Raises InputError with every problem, MissingInputError if a
    file does not exist.
    """
    with allowing(limit):
        report = read_scene_with_report(path, up=up, scale=scale, outside=outside, surfaces=surfaces)
    if strict and report.repairs:
        raise InputError(
            [f"{repair}; correct the file, or read it without strict" for repair in report.repairs]
        )
    return report.scene


def read_scene_with_report(
    path: PathLike,
    *,
    up: str = "z",
    scale: float = 1.0,
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
) -> SceneReport:
    """Like `read_scene`, but also returns messages about what was repaired, skipped and created."""
    if up not in UPS:
        raise UsageError(f"up must be 'x', 'y' or 'z', not {up!r}")
    try:
        placement = Placement(up, SCALES.accepted(scale))
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"scale {SCALES.rule()}, not {shown(scale)}; give a factor such as 0.001") from None
    if surfaces not in (MATERIALS, PARTS):
        raise UsageError(f"surfaces must be {MATERIALS!r} or {PARTS!r}, not {shown(surfaces)}")
    path = Path(path)
    if not table_exists(path.parent, path.name):
        status_of(path)

    path, source = source_format(path)
    if isinstance(source, SceneFormat):
        for name, is_given in (("up", up != "z"), ("scale", scale != 1)):
            if is_given:
                raise UsageError(
                    f"{name} is for mesh files, not for {path}, which gives its own; leave it out"
                )
        report = source.read(path, outside=outside, surfaces=surfaces)
        return _with_source(report, path.parent, path)
    if path.is_dir():
        files, name = files_of_folder(path, source), path.resolve().name
        folder = next(iter(files.values())).parent
        return _with_source(_bare_mesh(files, name, placement, surfaces), folder)
    return _with_source(_bare_mesh({"file": path}, path.stem, placement, surfaces), path.parent)


def _with_source(report: SceneReport, folder: Path, scene_file: Path | None = None) -> SceneReport:
    """Remember the files of the mesh of a report; returns the report."""
    if report.mesh_files:
        path = None if scene_file is None else scene_file.resolve()
        keep_source(report.scene.mesh, MeshSource(folder.resolve(), report.mesh_files, path))
    return report


def is_picture(path: Path) -> bool:
    """Whether a path is read as a picture file. Raises InputError if it cannot be read."""
    status_of(path)
    return source_format(path)[1] is PICTURE


def source_format(path: Path) -> tuple[Path, SceneFormat | MeshFormat]:
    """The path to read for a source, and its format.

    For a folder with a scene file, the path of the scene file is returned; for a file of a mesh that is a
    folder, the path of the folder. Raises InputError if the format is unknown.
    """
    if path.is_dir():
        if (path / SCENE_FILE).exists():
            return path / SCENE_FILE, SCENE_FILE_FORMAT
        mesh_format = format_of_folder(path)
        if mesh_format is None:
            folder_formats: list[Format] = [SCENE_FILE_FORMAT, *MESH_FORMATS]
            contents = [" and ".join(each.in_folder) for each in folder_formats if each.in_folder]
            raise InputError(
                f"{path}: a scene's folder must contain a {' or '.join(contents)}, and this one does not;"
                " name a mesh file to read it alone"
            )
        return path, mesh_format
    formats: tuple[SceneFormat | MeshFormat, ...] = (*SCENE_FORMATS, *file_formats())
    file_format = recognized(path, formats)
    if file_format is not None:
        return path, file_format
    mesh_format = format_of_folder(path.parent)
    if mesh_format is not None and path.name in mesh_format.in_folder:
        return path.parent, mesh_format
    raise InputError(
        f"{path}: a scene must be a folder, or {suffix_rule(path, scene_and_mesh_suffixes())};"
        " name one of these"
    )


def hinted_up(path: PathLike, mesh: Mesh) -> str:
    """The axis that seems to be up in a file whose mesh was read with z up and seems to lie on its side.

    Empty if the mesh seems to stand, or if the file or its format says which axis is up.
    """
    try:
        _, file_format = source_format(Path(path))
    except InputError:
        # The file may have gone since.
        return ""
    prior = file_format.prior_of_y if isinstance(file_format, MeshFormat) else None
    return "y" if prior is not None and seems_to_lie(mesh, prior) else ""


def scene_and_mesh_suffixes() -> tuple[str, ...]:
    """The suffixes of all files that are scenes or meshes, sorted."""
    return suffixes_of((*SCENE_FORMATS, *file_formats()))


def _bare_mesh(
    files: Mapping[str, Path], name: str, placement: Placement, surfaces: SurfaceSource
) -> SceneReport:
    """The scene of a mesh, with everything else created from defaults."""
    read = read_mesh(files, placement)
    scale = {} if placement.scale == 1 else {"scale": placement.scale}
    entry = {**{key: file.name for key, file in files.items()}, "up": placement.up, **scale}
    return scene_report([read], mesh_files=(entry,), name=name or "scene", surfaces=surfaces)
