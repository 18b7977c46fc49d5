"""Scenes of bare meshes, whose missing tables are created, and new lights at free places.

Paper: "Introduction": tables with the part, surface and lighting parameters can be supplied as input or
created automatically by the system as they are needed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final, Literal, Unpack

from autocolor.checks import nearest, shown
from autocolor.errors import InputError, UsageError
from autocolor.logs import logger_of
from autocolor.scene.changes import PartChanges, SceneFields
from autocolor.scene.columns import Problem, Row, RowError, fields_of, from_plain, unknown_key
from autocolor.scene.defaults import (
    MAPPING_FIELDS,
    color_in_turn,
    created_surface,
    default_lights,
    default_view,
    object_bounds,
    object_coordinates,
    sphere_around,
    studio_axes,
)
from autocolor.scene.lights import Light, free_name
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import MOST_PROBLEMS, Scene
from autocolor.scene.stage import NONE, STAGE
from autocolor.scene.surfaces import MOST_SURFACES, Part, Surface

LOG: Final = logger_of(__name__)

SHARED: Final = "surface"
"""The name of the created surface that all parts without a surface share."""

UNASSIGNED: Final = "\0"
"""The surface of a part without a surface. No name contains this character."""

SurfaceSource = Literal["materials", "parts"]
"""The source of missing surfaces: the materials of the mesh, or one surface for each part."""

MATERIALS: Final = "materials"
PARTS: Final = "parts"


def scene_of(
    mesh: object,
    polygons: object = None,
    *,
    surfaces: Sequence[Row] | SurfaceSource = MATERIALS,
    parts: Mapping[str, PartChanges] | None = None,
    surface_of_part: Mapping[str, str] | None = None,
    material_of_part: Mapping[str, str] | None = None,
    materials: Sequence[Surface] = (),
    **fields: Unpack[SceneFields],
) -> Scene:
    """A scene of a mesh; missing tables and fields are created with defaults.

    `mesh` is anything that `Mesh.of` takes: a Mesh, a mesh of trimesh, PyVista or meshio, or an array of
    nodes with an array of `polygons`.

    A part gets the first of these surfaces that exists: the surface that `parts` or `surface_of_part` names;
    the given surface with the part's name; with `surfaces="parts"`, a new surface like its material; the
    surface of its material (`material_of_part`), from `materials` or created; the only given surface, if no
    part has it yet; a created surface that all other parts share. Beyond MOST_SURFACES, the remaining parts
    share the last surface.

    `parts` has fields of parts by name, such as `{"floor": {"stage": True}}`; `fields` are the other fields
    of Scene. Raises InputError, or UsageError for any word but "materials" and "parts".

    Assumed: the mapping belongs to the lights. If the lights are created, then ambient, scaling, mapping,
    contrast and interpolation are chosen so that the form of the mesh is visible. With given lights they have
    Scene's defaults.
    """
    mesh = Mesh.of(mesh, polygons)
    if isinstance(surfaces, str) and surfaces not in (MATERIALS, PARTS):
        raise UsageError(f"surfaces must be rows, {MATERIALS!r} or {PARTS!r}, not {shown(surfaces)}")
    problems = [unknown_key(name, fields_of(Scene)) for name in fields if name not in fields_of(Scene)]
    given = () if isinstance(surfaces, str) else _validated("surfaces", surfaces, problems)
    rows = _part_rows(mesh, parts or {}, surface_of_part or {}, problems)
    tables: dict[str, Any] = {**(MAPPING_FIELDS if fields.get("lights") is None else {}), **fields}
    # Check the view here, because created lights depend on it.
    view, lights = tables.pop("view", None), tables.pop("lights", None)
    view = None if view is None else _validated("view", view, problems)
    if problems:
        raise RowError(problems)
    material_of_part = material_of_part or {}
    used = set(material_of_part.values())
    names = {row.name for row in rows} | used
    shared = SHARED
    while shared in used:
        shared += " for all others"
    own = {surface.name for surface in given}
    of_parts = own if tables.get("stage", NONE) == NONE else own - {STAGE}
    if len(of_parts) == 1 and of_parts.isdisjoint(names.union(row.surface for row in rows)):
        (shared,) = of_parts
    of_material = {surface.name: surface for surface in materials if surface.name != shared}
    if surfaces == PARTS:
        # A part's own surface is like that of its material.
        of_part = {name: of_material.get(material_of_part.get(name, "")) for name in mesh.part_names}
        others = {name: surface for name, surface in of_material.items() if name not in of_part}
        of_own = {name: surface.replace(name=name) for name, surface in of_part.items() if surface}
        of_material = {**others, **of_own}
        material_of_part = {name: name for name in mesh.part_names}
    rows = tuple(
        row.replace(surface=row.name if row.name in own else material_of_part.get(row.name, shared))
        if row.surface == UNASSIGNED
        else row
        for row in rows
    )
    rows, table = _with_created(rows, given, of_material, names, shared)
    coordinates = object_coordinates(mesh, rows)
    if view is None:
        view = default_view(coordinates)
        LOG.info("created a view from (%.4g, %.4g, %.4g)", *view.eye)
    if lights is None:
        lights = default_lights(coordinates, view)
        LOG.info("created %d lights: %s", len(lights), ", ".join(light.name for light in lights))
    created = [surface.name for surface in table if surface.name not in own]
    if created:
        LOG.info("created surfaces: %s", ", ".join(created))
    return Scene(mesh, rows, table, lights, view, **tables)


def _validated(name: str, value: object, problems: list[Problem]) -> Any:
    return fields_of(Scene)[name].kind.validated(value, (name,), problems)


def _part_rows(
    mesh: Mesh,
    parts: Mapping[str, PartChanges],
    surface_of_part: Mapping[str, str],
    problems: list[Problem],
) -> tuple[Part, ...]:
    """The part table; the surface of a part is UNASSIGNED unless it is given."""
    names = set(mesh.part_names)
    if missing := [name for name in (*parts, *surface_of_part) if name not in names]:
        raise InputError(
            f"there is no part {shown(name)}{nearest(name, mesh.part_names)}"
            for name in missing[:MOST_PROBLEMS]
        )
    rows = []
    for name in mesh.part_names:
        table = {"surface": UNASSIGNED, **parts.get(name, {}), "name": name}
        if name in surface_of_part:
            table["surface"] = surface_of_part[name]
        try:
            rows.append(from_plain(Part, table))
        except RowError as error:
            problems.extend(problem.under((PARTS, name)) for problem in error.row_problems)
    return tuple(rows)


def _with_created(
    rows: tuple[Part, ...],
    given: tuple[Surface, ...],
    of_material: Mapping[str, Surface],
    names: set[str],
    shared: str,
) -> tuple[tuple[Part, ...], tuple[Surface, ...]]:
    """The parts, and the surface table: the given surfaces and created surfaces, up to MOST_SURFACES.

    Surfaces are created for `names`, the names of parts and materials, and for `shared`. The checks of Scene
    refuse other names.
    """
    table = {surface.name: surface for surface in given}
    wanted = dict.fromkeys(row.surface for row in rows if row.surface in names or row.surface == shared)
    missing = [name for name in wanted if name not in table]
    for name in missing[: max(MOST_SURFACES - len(given), 0)]:
        color = None if name == shared else color_in_turn(len(table))
        table[name] = of_material.get(name) or created_surface(name, color)
    if len(table) == MOST_SURFACES:
        # Further parts share the last surface.
        last = next(reversed(table))
        rows = tuple(
            row.replace(surface=last) if row.surface in wanted and row.surface not in table else row
            for row in rows
        )
    return rows, tuple(table.values())


DISTANCE: Final = 4.0
"""Assumed: distance of a new light from the middle of the object, in radii of the sphere around it."""

ELEVATION: Final = 40.0
"""Assumed: the elevation of a new light, in degrees as seen from the middle of the object."""

TURNS: Final = (0, 35, -35, 70, -70, 105, -105, 140, -140, 180)
"""Assumed: angles of a new light around the object, in degrees from the side of the eye, by preference."""

NAME: Final = "light"


def new_light_of(scene: Scene) -> Light:
    """A light to add to a scene: above the side of the eye, and aimed at the middle of the object.

    Its name is not taken. No other light is closer to it than the radius of the object, unless every place
    around the object is taken.
    """
    center, radius = sphere_around(*object_bounds(scene.mesh, scene.parts))
    right, up, away = studio_axes(scene.view)
    elevation = math.radians(ELEVATION)
    places = []
    for turn in map(math.radians, TURNS):
        outward = math.sin(turn) * right - math.cos(turn) * away
        toward = math.cos(elevation) * outward + math.sin(elevation) * up
        places.append(center + DISTANCE * radius * toward)
    taken = [light.position for light in scene.lights_in_world]
    free = [place for place in places if all(math.dist(place, other) >= radius for other in taken)]
    return Light(
        free_name(NAME, [light.name for light in scene.lights]),
        tuple((free or places)[0].tolist()),
        aim=tuple(center.tolist()),
    )
