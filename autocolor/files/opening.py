"""Opening a path: what it is, the scene that it gives, and which files of a folder can be opened.

A path is a folder, a scene file, a store, a mesh file or a picture file; FORMATS has all of their formats. To
add a format of scenes, write its reader and a row of FORMATS below. A scene is written in one of OUTPUTS.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, NamedTuple

from autocolor.budget import allowing
from autocolor.checks import shown
from autocolor.errors import AutocolorError, InputError, UsageError, reason_of
from autocolor.files import formats
from autocolor.files.formats import (
    FILE_FORMATS,
    MESH_FORMATS,
    NORMALS,
    QUADS,
    SCALARS,
    SETTINGS,
    SURFACES,
    WHOLE_SCENE,
    Format,
    format_named,
    read_mesh,
    recognized,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.obj import beyond_materials
from autocolor.files.meshes.repair import FILE, SCALES, UPS, Placement
from autocolor.files.meshes.up_axis import seems_to_lie
from autocolor.files.palette_file import GPL
from autocolor.files.paths import PICTURE_SUFFIX, SCENE_FILE, STORE_SUFFIXES, is_within
from autocolor.files.picture_file import read_picture
from autocolor.files.reading import read_bytes, status_of
from autocolor.files.scene_report import SceneReport, scene_report
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.files.scene_toml.scene_meshes import SOURCES, MeshSource
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, parsed_toml
from autocolor.files.scene_writing import write_scene
from autocolor.files.store.store_file import read_store, write_store
from autocolor.files.writing import table_exists
from autocolor.scene.columns import REFUSED, Kind
from autocolor.scene.creation import MATERIALS, PARTS, SurfaceSource
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.kinds import OneOf
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene

PathLike = str | os.PathLike[str]


def _write_store(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    write_store(path, scene, overwrite=overwrite)
    return [path]


# A picture file and a store name no other files: `outside` has no effect. A picture file has its surfaces.

PICTURE: Final = Format(
    name="picture",
    suffixes=(PICTURE_SUFFIX,),
    read=lambda path, **_: SceneReport(read_picture(path).scene),
    keys=(),
    begins=lambda head: head.startswith(b"PK\x03\x04"),
)

SCENE: Final = Format(
    name="scene",
    suffixes=(".toml",),
    read=read_scene_file,
    keys=(),
    in_folder=(SCENE_FILE,),
    write=lambda path, scene, overwrite: write_scene(path, scene, overwrite=overwrite),
    holds=WHOLE_SCENE,
)

STORE: Final = Format(
    name="store",
    suffixes=STORE_SUFFIXES,
    read=lambda path, *, surfaces, **_: read_store(path, surfaces=surfaces),
    keys=(),
    begins=lambda head: head.startswith(b"SQLite format 3\0"),
    write=_write_store,
    holds=WHOLE_SCENE - {NORMALS},
)

FORMATS: Final = (PICTURE, SCENE, STORE, *MESH_FORMATS)
"""All formats of scenes and meshes. If several accept the first bytes of a file, the first format is used."""

FILES: Final = (PICTURE, SCENE, STORE, *FILE_FORMATS)
"""The formats of scenes and meshes that consist of a single file, or whose first file names the others."""


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
    for its coordinates; the normals of its file are used. With `outside`, a scene file may name files outside
    its folder. With `strict`, a mesh that needs repair is refused. A part without a surface has the surface
    of its material; with `surfaces="parts"`, each such part has its own surface. `limit` is a factor for the
    memory budget: a file that needs more is refused before it is read. Raises InputError with every problem,
    MissingInputError if a file does not exist.
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
    kinds: tuple[Kind[Any], ...] = (OneOf(UPS), SCALES, OneOf((MATERIALS, PARTS)))
    for name, kind, value in zip(("up", "scale", "surfaces"), kinds, (up, scale, surfaces), strict=True):
        if kind.validated(value, (), []) is REFUSED:
            raise UsageError(f"{name} {kind.rule()}, not {shown(value)}; choose another")
    path = Path(path)
    if not table_exists(path.parent, path.name):
        status_of(path)

    path, source = source_format(path)
    if source.keys:
        placement = Placement(up, float(scale), normals=FILE)
        report, scene_file = _bare_mesh(path, source, placement, surfaces), None
    else:
        if up != "z" or scale != 1:
            name = "scale" if up == "z" else "up"
            raise UsageError(f"{name} is for mesh files, not for {path}, which gives its own; leave it out")
        report, scene_file = source.read(path, outside=outside, surfaces=surfaces), path.resolve()
    if report.mesh_files:
        folder = path if path.is_dir() else path.parent
        SOURCES[report.scene.mesh] = MeshSource(folder.resolve(), report.mesh_files, scene_file)
    return report


def _bare_mesh(path: Path, mesh_format: Format, placement: Placement, surfaces: SurfaceSource) -> SceneReport:
    """The scene of a mesh file, or of a folder of tables, with everything else created from defaults."""
    files, name = {"file": path}, path.stem
    if path.is_dir():
        files = {key: path / each for key, each in zip(mesh_format.keys, mesh_format.in_folder, strict=True)}
        name = path.resolve().name
    read = read_mesh(files, placement)
    scale = {} if placement.scale == 1 else {"scale": placement.scale}
    normals = {} if read.mesh.own_normals is None else {"normals": FILE}
    entry = {**{key: file.name for key, file in files.items()}, "up": placement.up, **scale, **normals}
    return scene_report([read], mesh_files=(entry,), name=name or "scene", surfaces=surfaces)


def is_picture(path: Path) -> bool:
    """Whether a path is read as a picture file. Raises InputError if it cannot be read."""
    status_of(path)
    return source_format(path)[1] is PICTURE


def format_of_folder(folder: Path, formats: Iterable[Format] = FORMATS) -> Format | None:
    """The format of the files in a folder; None if it has no scene and no mesh."""
    having = (each for each in formats if each.in_folder)
    return next((each for each in having if all(table_exists(folder, name) for name in each.in_folder)), None)


def source_format(path: Path) -> tuple[Path, Format]:
    """The path to read for a source, and its format.

    For a folder with a scene file, the path of the scene file is returned; for a table in the folder of a
    mesh, the path of the folder. Raises InputError if the format is unknown.
    """
    if path.is_dir():
        found = format_of_folder(path)
        if found is None:
            contents = [" and ".join(each.in_folder) for each in FORMATS if each.in_folder]
            raise InputError(
                f"{path}: a scene's folder must contain a {' or '.join(contents)}, and this one does not;"
                " name a mesh file to read it alone"
            )
        return (path / SCENE_FILE if found is SCENE else path), found
    if found := recognized(path, FILES):
        return path, found
    table = format_named(path, MESH_FORMATS)
    if table is None:
        raise InputError(
            f"{path}: a scene must be a folder, or {suffix_rule(path, suffixes_of(FILES))}; name one of these"
        )
    if path.name not in table.in_folder or format_of_folder(path.parent, [table]) is None:
        raise InputError(
            f"{path}: a mesh must have a table of nodes and a table of polygons, not one of the two;"
            f" {TWO_TABLES}"
        )
    return path.parent, table


TWO_TABLES: Final = (
    "name the folder of nodes.csv and polygons.csv, or a scene.toml that names the two tables by nodes and"
    " polygons in [[mesh]]"
)
"""How the two tables of a mesh are given, as the end of a message."""


def hinted_up(path: PathLike, mesh: Mesh) -> str:
    """The axis that seems to be up in a file whose mesh was read with z up and seems to lie on its side.

    Empty if the mesh seems to stand, or if the file or its format says which axis is up.
    """
    # The file may have gone since.
    with suppress(InputError):
        prior = source_format(Path(path))[1].prior_of_y
        return "y" if prior is not None and seems_to_lie(mesh, prior) else ""
    return ""


# The files of a folder that can be opened. Kinds are recognized by names, which is quick; only TOML files are
# read. So CSV files are not listed, neither as tables of a mesh nor as paints.

FOLDER: Final = "folder"
MESH: Final = "mesh"
RIG: Final = "rig"


class Openable(NamedTuple):
    """A path, and its kind: "scene", "store", "picture", "mesh", "rig", "paints" or "folder"."""

    path: Path
    kind: str


def openables_of(folder: Path) -> list[Openable]:
    """The files of a folder that can be opened, then its folders, by name; hidden names are left out.

    Raises InputError if the folder cannot be read.
    """
    try:
        names = os.listdir(folder)
    except OSError as error:
        raise InputError(
            f"{folder.name or folder}: a folder must be readable, and is not ({reason_of(error)});"
            " choose another"
        ) from None
    # car2 comes before car10.
    names.sort(key=lambda name: re.sub(r"\d+", lambda number: number[0].zfill(20), name.casefold()))
    paths = [folder / name for name in names if not name.startswith(".")]
    openables = [Openable(path, kind) for path in paths if (kind := kind_of(path))]
    return sorted(openables, key=lambda openable: openable.kind == FOLDER)


def kind_of(path: Path) -> str:
    """The kind of a path, as in `Openable`; empty if it cannot be opened, or does not exist."""
    # Unlike the methods of Path, these functions never raise for a name that is too long.
    is_folder, is_file = os.path.isdir(path), os.path.isfile(path)
    if is_file and path.suffix.lower() == GPL:
        return "paints"
    found = format_of_folder(path) if is_folder else format_named(path, FILES) if is_file else None
    if found is None:
        return FOLDER if is_folder else ""
    if found is SCENE and is_file:
        return _kind_of_toml(path)
    return MESH if found.keys else found.name


def _kind_of_toml(path: Path) -> str:
    """The kind of a TOML file: a scene, a rig, or empty, as for pyproject.toml.

    A file that cannot be read counts as a scene, so that opening it says why.
    """
    try:
        document = parsed_toml(read_bytes(path, LARGEST_TEXT), path.name, "a scene file")
    except AutocolorError:
        return SCENE.name
    return SCENE.name if "mesh" in document else RIG if "minimum" in document else ""


def stays_within(path: Path, folder: Path) -> bool:
    """Whether a path, and the files to read first when it is opened, are in a folder, links resolved."""
    found = format_of_folder(path)
    names = () if found is None else found.in_folder
    return all(is_within(folder, file) for file in (path, *(path / name for name in names)))


# Writing a scene in another format, which may not hold all of it.

OUTPUTS: Final = tuple(
    sorted((each for each in FORMATS if each.write is not None), key=lambda each: each.name.casefold())
)
"""The formats that a scene can be written in, sorted by name."""


def output_named(name: str) -> Format:
    """The format with this name, in any capitals. Raises UsageError if no format has it."""
    for output in OUTPUTS:
        if name.casefold() == output.name.casefold():
            return output
    *names, last = [output.name for output in OUTPUTS]
    raise UsageError(f"--to must be {', '.join(names)} or {last}, not {name!r}; choose one")


def output_of(path: Path) -> Format:
    """The format for a path that is written.

    An existing folder keeps its format; an empty folder gets a scene. For a file or a new folder the suffix
    decides. A path without a suffix becomes the folder of a scene. Raises UsageError for an unknown suffix.
    """
    # Unlike `Path.is_dir`, it never raises for a name that is too long.
    is_folder = os.path.isdir(path)
    output = format_of_folder(path) if is_folder else format_named(path, OUTPUTS)
    if output is None and path.suffix and not is_folder:
        raise UsageError(
            f"OUT must {suffix_rule(path, suffixes_of(OUTPUTS))}; name another, without an ending for the"
            " folder of a scene, or choose a format with --to"
        )
    return output or SCENE


def left_out(scene: Scene, output: Format, *, is_bare: bool) -> list[str]:
    """A phrase for each part of a scene that a format cannot hold: "2 scalars ('stress', 'u')".

    If the source `is_bare`, a mesh without a scene, only parts of the mesh count: all else was created.
    """
    mesh = scene.mesh
    quads = len(mesh.node_numbers) - mesh.triangle_count
    angle = "" if mesh.crease_angle == CREASE_ANGLE else f"the crease angle of {mesh.crease_angle:g} degrees"
    phrases = [
        (formats.PARTS, _counted("part", mesh.part_names) if len(mesh.part_names) > 1 else ""),
        (SCALARS, _counted("scalar", [each.name for each in mesh.scalars])),
        (QUADS, f"the quads ({quads:,}, each written as two triangles)" if quads else ""),
        (NORMALS, "the file's own normals (they will be computed)" if mesh.own_normals is not None else ""),
        (SETTINGS, angle),
    ]
    if not is_bare:
        beyond = beyond_materials(scene.surfaces) if SURFACES in output.holds else []
        phrases += [
            (SURFACES, _counted("surface", [each.name for each in scene.surfaces])),
            (SETTINGS, f"what a material does not have of {_counted('surface', beyond)}" if beyond else ""),
            (SETTINGS, "the lights, the views and the settings of the scene"),
        ]
    return [phrase for held, phrase in phrases if phrase and held not in output.holds]


def _counted(noun: str, names: Sequence[str]) -> str:
    """The number of things, and the first of their names; empty if there are none."""
    listed = ", ".join(map(shown, names[:5])) + (f" and {len(names) - 5:,} more" if names[5:] else "")
    return f"{len(names):,} {noun}{'s' if names[1:] else ''} ({listed})" if names else ""
