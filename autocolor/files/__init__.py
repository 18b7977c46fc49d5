"""Readers of scenes and meshes, and writing that leaves the old or the new file whole.

`read_scene` reads everything that a scene can come from; the readers themselves are imported when needed.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport
    from autocolor.scene.scene import Scene

__all__ = ["read_scene", "read_scene_with_report"]

PathLike = str | os.PathLike[str]


def read_scene(path: PathLike, *, strict: bool = False, up: str = "z", outside: bool = False) -> Scene:
    """The scene of a folder, a scene file (.toml), a mesh file (.obj) or a picture file (.npz).

    A folder has a `scene.toml`, or `nodes.csv` and `polygons.csv`. What is missing is created. `up` is the up
    axis of a mesh that is read without a scene file; `outside` allows a scene file to name files outside its
    folder; `strict` refuses what would otherwise be repaired.
    Raises InputError with every problem, MissingInputError where there is no such file.
    """
    report = read_scene_with_report(path, up=up, outside=outside)
    if strict and report.repairs:
        from autocolor.errors import InputError

        raise InputError([f"{repair}; strict reading repairs nothing" for repair in report.repairs])
    return report.scene


def read_scene_with_report(path: PathLike, *, up: str = "z", outside: bool = False) -> SceneReport:
    """As `read_scene`, with sentences for what was repaired, skipped and created."""
    from autocolor.errors import InputError, UsageError
    from autocolor.files.meshes.formats import MESH_SUFFIXES, read_mesh, read_tables
    from autocolor.files.reading import unnameable, unreadable
    from autocolor.files.repair.polygons import UPS

    if up not in UPS:
        raise UsageError(f"up must be 'x', 'y' or 'z', not {up!r}")
    path = Path(path)
    try:
        os.stat(path)
    except OSError as error:
        raise unreadable(path, error) from None
    except ValueError:
        raise unnameable(path) from None
    suffix = path.suffix.lower()

    if os.path.isdir(path):
        if (path / "scene.toml").exists():
            path, suffix = path / "scene.toml", ".toml"
        elif (path / "nodes.csv").exists() and (path / "polygons.csv").exists():
            from autocolor.files.scenes.scene_report import scene_report

            tables = read_tables(path / "nodes.csv", path / "polygons.csv", up=up)
            entry = {"nodes": "nodes.csv", "polygons": "polygons.csv", "up": up}
            name = path.resolve().name or "scene"
            return scene_report(tables.mesh, repairs=tables.repairs, mesh_files=(entry,), name=name)
        else:
            raise InputError(
                f"{path}: a scene's folder must have a scene.toml, or nodes.csv and polygons.csv, not"
                " neither; name the mesh file to read that alone"
            )
    if up != "z" and suffix in (".toml", ".npz"):
        raise UsageError(f"up must go with a mesh, not with {path}, which says its own; leave it out")
    if suffix == ".toml":
        from autocolor.files.scenes.scene_file import read_scene_file

        return read_scene_file(path, outside=outside)
    if suffix in MESH_SUFFIXES:
        from autocolor.files.scenes.scene_report import scene_report

        read = read_mesh(path, up=up)
        entry = {"file": path.name, "up": up}
        return scene_report(read.mesh, repairs=read.repairs, mesh_files=(entry,), name=path.stem)
    if suffix == ".npz":
        from autocolor.files.picture_file import read_picture_scene
        from autocolor.files.scenes.scene_report import SceneReport

        return SceneReport(read_picture_scene(path))
    raise InputError(
        f"{path}: a scene must be a folder, or a file that ends in .toml, {', '.join(MESH_SUFFIXES)} or .npz,"
        f" not in {suffix!r}; name one of these"
    )
