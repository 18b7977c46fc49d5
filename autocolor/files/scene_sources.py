"""Reading a scene from a folder, a scene file, a store, a mesh file or a picture file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.mesh_sources import MeshSource, keep_source
from autocolor.files.meshes.formats import (
    MeshFormat,
    format_of,
    format_of_folder,
    mesh_suffixes,
    read_mesh,
)
from autocolor.files.reading import unnameable, unreadable
from autocolor.files.repair.placement import UPS, Placement
from autocolor.files.scenes.formats import (
    SceneFormat,
    scene_format_named,
    scene_format_within,
    scene_formats,
    scene_suffixes,
)
from autocolor.files.scenes.scene_report import SceneReport, scene_report
from autocolor.scene.creation import MATERIALS, PARTS, SurfaceSource
from autocolor.scene.scene import Scene

PathLike = str | os.PathLike[str]


def read_scene(
    path: PathLike,
    *,
    strict: bool = False,
    up: str = "z",
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
) -> Scene:
    """The scene of a folder, a scene file (.toml), a store (.sqlite), a mesh file or a picture file (.npz).

    A folder must contain a `scene.toml`, or `nodes.csv` and `polygons.csv`. Whatever the source does not
    define is created with defaults. `up` is the up axis of a mesh that is read without a scene file. With
    `outside`, a scene file may name files outside its folder. With `strict`, a mesh that needs repair is
    refused. Parts that are given no surface have that of their material; with `surfaces="parts"`, each has
    one of its own. Raises InputError with every problem, MissingInputError if a file does not exist.
    """
    report = read_scene_with_report(path, up=up, outside=outside, surfaces=surfaces)
    if strict and report.repairs:
        raise InputError(
            [f"{repair}; correct the file, or read it without strict" for repair in report.repairs]
        )
    return report.scene


def read_scene_with_report(
    path: PathLike,
    *,
    up: str = "z",
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
) -> SceneReport:
    """Like `read_scene`, but also returns messages about what was repaired, skipped and created."""
    if up not in UPS:
        raise UsageError(f"up must be 'x', 'y' or 'z', not {up!r}")
    if surfaces not in (MATERIALS, PARTS):
        raise UsageError(f"surfaces must be {MATERIALS!r} or {PARTS!r}, not {shown(surfaces)}")
    path = Path(path)
    try:
        os.stat(path)
    except OSError as error:
        raise unreadable(path, error) from None
    except ValueError:
        raise unnameable(path) from None

    path, found = _format(path)
    if isinstance(found, SceneFormat):
        if up != "z":
            raise UsageError(f"up is for mesh files, not for {path}, which gives its own; leave it out")
        report = found.read(path, outside=outside, surfaces=surfaces)
        return _with_source_kept(report, path.parent, path)
    if path.is_dir():
        names = dict(zip(found.keys, found.in_folder, strict=True))
        files = {key: path / name for key, name in names.items()}
        return _with_source_kept(_bare_mesh(files, path.resolve().name, up, surfaces), path)
    return _with_source_kept(_bare_mesh({"file": path}, path.stem, up, surfaces), path.parent)


def _with_source_kept(report: SceneReport, folder: Path, scene_file: Path | None = None) -> SceneReport:
    """The report, after noting where its mesh was read from."""
    if report.mesh_files:
        path = None if scene_file is None else scene_file.resolve()
        keep_source(report.scene.mesh, MeshSource(folder.resolve(), report.mesh_files, path))
    return report


def _format(path: Path) -> tuple[Path, SceneFormat | MeshFormat]:
    """The path to read and its format; the path of a folder with a scene file is that of the scene file."""
    found: SceneFormat | MeshFormat | None
    if path.is_dir():
        for each in scene_formats():
            if each.in_folder is not None and (path / each.in_folder).exists():
                return path / each.in_folder, each
        found = format_of_folder(path)
        rule = (
            "a scene's folder must contain a scene.toml, or nodes.csv and polygons.csv, not neither; name a"
            " mesh file to read it alone"
        )
    else:
        found = scene_format_named(path) or format_of(path) or scene_format_within(path)
        *others, last = (*scene_suffixes(), *mesh_suffixes())
        rule = (
            f"a scene must be a folder, or a file that ends in {', '.join(others)} or {last}, not in"
            f" {path.suffix!r}; name one of these"
        )
    if found is None:
        raise InputError(f"{path}: {rule}")
    return path, found


def _bare_mesh(files: Mapping[str, Path], name: str, up: str, surfaces: SurfaceSource) -> SceneReport:
    """The scene of a mesh, with everything else created from defaults."""
    read = read_mesh(files, Placement(up))
    entry = {**{key: file.name for key, file in files.items()}, "up": up}
    return scene_report([read], mesh_files=(entry,), name=name or "scene", surfaces=surfaces)
