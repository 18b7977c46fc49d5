"""The scene: the tables, the lights, the ambient term and the view, and how intensities are shown.

A scene never changes. An edit is a new scene that shares all it did not change, so that comparing the
tables of two scenes tells what must be computed again.
"""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Final, TypeVar

from autocolor.checks import Color, color, field_names, finite, known_fields, nearest, with_checked
from autocolor.errors import InputError, UsageError
from autocolor.scene.defaults import default_lights, default_parts, default_surface, default_view
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import MOST_SURFACES, Part, Surface
from autocolor.scene.view import View

SCALINGS: Final = ("surface", "object")
MAPPINGS: Final = ("linear", "gamma", "logarithm", "equalize")
CONTRASTS: Final = ("stretch", "floor")

Curve = tuple[tuple[float, float], ...]
Row = TypeVar("Row", Part, Surface, Light)


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that makes a picture, and everything that colors it; `scene_of` creates what is missing.

    There is one part for each of the mesh's part names, in their order, and a surface for each name that a
    part has. `ambient` is an intensity of at least 0. `scaling` says whose minimum and maximum are mapped:
    each "surface" its own, or the whole "object". `mapping` is "linear", "gamma", "logarithm", "equalize" or
    points (x, y) of a rising curve from x = 0 to x = 1. `contrast` is "stretch" (the lowest level is black)
    or "floor" (the lowest level is as bright as its intensity). `background` is the color of word 0.

    Paper: "The Lighting Model" (ambient; mapping by surface or by object; nonlinear mappings).
    """

    mesh: Mesh
    parts: tuple[Part, ...]
    surfaces: tuple[Surface, ...]
    lights: tuple[Light, ...]
    view: View
    ambient: float = 0.1
    scaling: str = "surface"
    mapping: str | Curve = "linear"
    contrast: str = "stretch"
    background: Color = (0, 0, 0)
    name: str = "scene"

    def __post_init__(self) -> None:
        problems = self._kind_problems()
        if problems:
            raise InputError(problems)
        for table in ("parts", "surfaces", "lights"):
            object.__setattr__(self, table, tuple(getattr(self, table)))
            problems.extend(_repeated(table, [row.name for row in getattr(self, table)]))
        object.__setattr__(self, "ambient", finite(problems, "ambient", self.ambient, at_least=0.0))
        object.__setattr__(self, "background", color(problems, "background", self.background))
        for what, value, known in (
            ("scaling", self.scaling, SCALINGS),
            ("contrast", self.contrast, CONTRASTS),
        ):
            if value not in known:
                problems.append(f"{what} must be {' or '.join(map(repr, known))}, not {value!r}")
        object.__setattr__(self, "mapping", _mapping(problems, self.mapping))
        problems.extend(self._table_problems())
        if problems:
            raise InputError(problems)

    def _kind_problems(self) -> list[str]:
        problems = [
            f"{name} must be a {kind.__name__}, not {value!r}"
            for name, kind, value in (("mesh", Mesh, self.mesh), ("view", View, self.view))
            if not isinstance(value, kind)
        ]
        for table, kind in (("parts", Part), ("surfaces", Surface), ("lights", Light)):
            rows = getattr(self, table)
            if not isinstance(rows, (list, tuple)) or not all(isinstance(row, kind) for row in rows):
                problems.append(f"{table} must be a tuple of {kind.__name__}, not {rows!r}")
        return problems

    def _table_problems(self) -> list[str]:
        problems = []
        part_names = [part.name for part in self.parts]
        if part_names != list(self.mesh.part_names):
            problems.append(
                f"the part table must have the mesh's parts in their order {list(self.mesh.part_names)}, not"
                f" {part_names}"
            )
        surface_names = [surface.name for surface in self.surfaces]
        known = set(surface_names)
        for part in self.parts:
            if part.surface not in known:
                problems.append(
                    f"part {part.name!r}: surface {part.surface!r} is not in the surface table"
                    f"{nearest(part.surface, surface_names)}"
                )
        if len(self.surfaces) > MOST_SURFACES:
            problems.append(
                f"a scene must have at most {MOST_SURFACES} surfaces, not {len(self.surfaces)}; let"
                " parts share a surface"
            )
        return problems

    def replace(self, **changes: Any) -> Scene:
        """The scene with some fields changed."""
        return dataclasses.replace(self, **known_fields(Scene, changes, "scene"))

    def equals(self, other: Scene) -> bool:
        """Whether every field is equal; meshes are compared by identity."""
        return not self.differing_fields(other)

    def differing_fields(self, other: Scene) -> list[str]:
        """The names of the fields that are not equal; meshes are compared by identity."""
        mine, others = vars(self), vars(other)
        return [
            name
            for name in field_names(Scene)
            if mine[name] is not others[name] and (name == "mesh" or mine[name] != others[name])
        ]

    def light(self, name: str) -> Light:
        """The light of that name; UsageError with the nearest right name when there is none."""
        return self.lights[_place("light", self.lights, name)]

    def surface(self, name: str) -> Surface:
        """The surface of that name; UsageError with the nearest right name when there is none."""
        return self.surfaces[_place("surface", self.surfaces, name)]

    def part(self, name: str) -> Part:
        """The part of that name; UsageError with the nearest right name when there is none."""
        return self.parts[_place("part", self.parts, name)]

    def with_light(self, name: str, /, **changes: Any) -> Scene:
        """The scene with some fields of one light changed."""
        return self._with_row("lights", _place("light", self.lights, name), changes)

    def with_surface(self, name: str, /, **changes: Any) -> Scene:
        """The scene with some fields of one surface changed, its reflectance and paint among them."""
        return self._with_row("surfaces", _place("surface", self.surfaces, name), changes)

    def with_part(self, name: str, /, **changes: Any) -> Scene:
        """The scene with some fields of one part changed."""
        return self._with_row("parts", _place("part", self.parts, name), changes)

    def with_view(self, **changes: Any) -> Scene:
        """The scene with some fields of the view changed."""
        return with_checked(self, {"view": self.view.replace(**changes)})

    def only_lights(self, *names: str) -> Scene:
        """The scene with the named lights on and all others off (Paper: Figure 8)."""
        wanted = [self.light(name).name for name in names]
        return self.replace(lights=tuple(light.replace(on=light.name in wanted) for light in self.lights))

    def _with_row(self, table: str, place: int, changes: dict[str, Any]) -> Scene:
        rows = getattr(self, table)
        rows = (*rows[:place], rows[place].replace(**changes), *rows[place + 1 :])
        # Only names lead from table to table: without a new one there is nothing to check again.
        if "name" in changes or "surface" in changes:
            return self.replace(**{table: rows})
        return with_checked(self, {table: rows})

    @cached_property
    def surface_number_of_part(self) -> tuple[int, ...]:
        """The surface number, counted from 1, of each part."""
        number = {surface.name: row + 1 for row, surface in enumerate(self.surfaces)}
        return tuple(number[part.surface] for part in self.parts)

    def __repr__(self) -> str:
        return (
            f"Scene({self.name!r}: {self.mesh!r}, surfaces {len(self.surfaces)}, lights {len(self.lights)})"
        )  # fmt: skip


def scene_of(
    mesh: Mesh,
    *,
    surface_of_part: dict[str, str] | None = None,
    surfaces: Sequence[Surface] | None = None,
    lights: Sequence[Light] | None = None,
    view: View | None = None,
    **fields: Any,
) -> Scene:
    """A scene of a mesh, with every table that is not given created.

    A part takes the surface that `surface_of_part` names, else the surface of its own name, else one that
    is created for it. Where that would be more surfaces than numbers, the parts past them share the last.
    `fields` are the other fields of Scene. Raises InputError.
    """
    missing = [name for name in surface_of_part or {} if name not in mesh.part_names]
    if missing:
        raise InputError(
            f"there is no part {name!r} to take a surface{nearest(name, mesh.part_names)}" for name in missing
        )
    given = list(surfaces or ())
    parts = list(default_parts(mesh, surface_of_part or {}))
    names = {surface.name: None for surface in given} | {part.surface: None for part in parts}
    kept = list(names)[:MOST_SURFACES]
    if len(names) > MOST_SURFACES and len(given) < MOST_SURFACES:
        shown = set(kept)
        parts = [part if part.surface in shown else Part(part.name, kept[-1]) for part in parts]
    table = {surface.name: surface for surface in given}
    # A part that names a surface of another name than its own must name one that is given.
    named = set((surface_of_part or {}).values())
    for number, name in enumerate(kept):
        if name not in table and (name not in named or name in mesh.part_names):
            table[name] = default_surface(name, number)
    view = default_view(mesh) if view is None else view
    return Scene(
        mesh,
        tuple(parts),
        tuple(table.values()) if len(given) == len({surface.name for surface in given}) else tuple(given),
        default_lights(mesh, view) if lights is None else tuple(lights),
        view,
        **known_fields(Scene, fields, "scene"),
    )


def _place(kind: str, rows: Sequence[Row], name: str) -> int:
    """Where the row of that name is."""
    for place, row in enumerate(rows):
        if row.name == name:
            return place
    raise UsageError(f"there is no {kind} {name!r}{nearest(str(name), [row.name for row in rows])}")


def _repeated(table: str, names: list[str]) -> list[str]:
    repeated = [name for name, count in Counter(names).items() if count > 1]
    return [f"{table}: a name must stand once, not repeated: {name!r}; rename one" for name in repeated]


def _mapping(problems: list[str], mapping: object) -> str | Curve:
    """The mapping, when it is a known name or points of a curve that never falls."""
    rule = f"mapping must be {', '.join(map(repr, MAPPINGS))}, or rising points [x, y] from x = 0 to x = 1"
    if isinstance(mapping, str):
        if mapping not in MAPPINGS:
            problems.append(f"{rule}, not {mapping!r}{nearest(mapping, MAPPINGS)}")
        return mapping
    try:
        points = tuple((float(x), float(y)) for x, y in mapping)  # type: ignore[attr-defined]
    except (TypeError, ValueError, OverflowError):
        points = ()
    across, up = [x for x, _ in points], [y for _, y in points]
    rising = all(a < b for a, b in pairwise(across)) and up == sorted(up)
    if len(points) < 2 or across[0] != 0 or across[-1] != 1 or not rising or not 0 <= up[0] <= up[-1] <= 1:
        problems.append(f"{rule}, not {mapping!r}")
        return "linear"
    return points
