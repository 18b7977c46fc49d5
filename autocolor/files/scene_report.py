"""The report of reading a scene: the scene, what was repaired in its files, and what was created for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from autocolor.checks import shown
from autocolor.files.meshes.repair import MeshReport
from autocolor.scene.columns import fields_of
from autocolor.scene.creation import scene_of
from autocolor.scene.defaults import MAPPING_FIELDS
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import MOST_SURFACES, Surface

OMITTED: Final = {name: field.default for name, field in fields_of(Scene).items() if name in MAPPING_FIELDS}
"""The values of omitted keys that are created for a bare mesh."""


@dataclass(frozen=True)
class SceneReport:
    """A scene, with messages about repairs and skipped parts of its files, and about what was created.

    `mesh_files` are the `[[mesh]]` tables with which a scene file can name the same mesh (see `scene_text`).
    `is_view_created` and `are_lights_created` are true if the source has no view, and no lights.
    """

    scene: Scene
    repairs: tuple[str, ...] = ()
    created: tuple[str, ...] = ()
    mesh_files: tuple[Mapping[str, Any], ...] = ()
    is_view_created: bool = False
    are_lights_created: bool = False


def scene_report(
    reports: Sequence[MeshReport], *, mesh_files: tuple[Mapping[str, Any], ...] = (), **fields: Any
) -> SceneReport:
    """The report for a scene of the meshes that were read; `fields` are passed to `scene_of`.

    If two files describe a material of the same name differently, the material of the later file is renamed.
    A part that is in several meshes has the material of the first mesh that gives it a material.
    """
    material_of_part: dict[str, str] = {}
    materials: dict[str, Surface] = {}
    repairs = [repair for report in reports for repair in report.repairs]
    for report in reports:
        renamed = {}
        for surface in report.materials:
            name, number = surface.name, 1
            while name in materials and materials[name].replace(name=surface.name) != surface:
                number += 1
                name = f"{surface.name} {number}"
            renamed[surface.name] = name
            materials.setdefault(name, surface.replace(name=name))
        for part, material in report.material_of_part.items():
            name = renamed.get(material, material)
            first = material_of_part.setdefault(part, name)
            if first != name:
                repairs.append(f"part {shown(part)} is in several meshes: it has material {shown(first)}")
    mesh = Mesh.joined([report.mesh for report in reports])
    scene = scene_of(mesh, material_of_part=material_of_part, materials=tuple(materials.values()), **fields)
    no_view, no_lights = fields.get("view") is None, fields.get("lights") is None
    created = ["a view was created that frames the object"] if no_view else []
    created += [f"{len(scene.lights)} studio lights were created"] if no_lights else []
    surfaces = fields.get("surfaces", ())
    given = set() if isinstance(surfaces, str) else {surface.name for surface in surfaces}
    names = [surface.name for surface in scene.surfaces if surface.name not in given]
    if len(names) == 1:
        created.append(f"surface {names[0]!r} was created")
    elif names:
        more = f" and {len(names) - 12} more" if len(names) > 12 else ""
        created.append(f"{len(names)} surfaces were created: {', '.join(map(repr, names[:12]))}{more}")
    last = scene.surfaces[-1].name if len(scene.surfaces) == MOST_SURFACES else ""
    sharing = sum(part.surface == last for part in scene.parts)
    if last and sharing > 1:
        rule = f"because a scene has at most {MOST_SURFACES}"
        created.append(f"{sharing:,} parts share surface {last!r}, {rule}")
    return SceneReport(scene, tuple(repairs), tuple(created), mesh_files, no_view, no_lights)
