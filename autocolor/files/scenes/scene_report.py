"""A scene that was read, with messages about what was repaired and created."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene, scene_of
from autocolor.scene.surfaces import MOST_SURFACES


@dataclass(frozen=True)
class SceneReport:
    """A scene, with messages about what was repaired or skipped in its files, and about what was created.

    `mesh_files` are the `[[mesh]]` tables with which a scene file can name the same mesh (see `scene_text`).
    """

    scene: Scene
    repairs: tuple[str, ...] = ()
    created: tuple[str, ...] = ()
    mesh_files: tuple[Mapping[str, str], ...] = ()


def scene_report(
    mesh: Mesh,
    *,
    repairs: tuple[str, ...] = (),
    mesh_files: tuple[Mapping[str, str], ...] = (),
    **fields: Any,
) -> SceneReport:
    """The report for a scene of a mesh; `fields` are passed to `scene_of`."""
    scene = scene_of(mesh, **fields)
    given = {surface.name for surface in fields.get("surfaces") or ()}
    names = [repr(surface.name) for surface in scene.surfaces if surface.name not in given]
    created = []
    if fields.get("view") is None:
        created.append("a view was created that frames the object")
    if fields.get("lights") is None:
        created.append(f"{len(scene.lights)} studio lights were created")
    if len(names) == 1:
        created.append(f"surface {names[0]} was created")
    elif names:
        listed = ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")
        created.append(f"{len(names)} surfaces were created: {listed}")
    asked = fields.get("surface_of_part") or {}
    sharing = sum(part.surface != asked.get(part.name, part.name) for part in scene.parts)
    if sharing:
        created.append(f"{sharing:,} parts share a surface, because a scene has at most {MOST_SURFACES}")
    return SceneReport(scene, repairs, tuple(created), mesh_files)
