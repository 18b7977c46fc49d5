"""The scene: the tables, the lights, the ambient term and the view, and how intensities are shown.

A scene never changes. An edit is a new scene that shares all it did not change, so that comparing the
tables of two scenes tells what must be computed again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import islice
from typing import Annotated, Any, Final, TypeVar, Unpack

from autocolor.checks import Color, nearest, shown
from autocolor.errors import InputError, UsageError
from autocolor.scene.changes import (
    LightChanges,
    PartChanges,
    SceneChanges,
    SceneFields,
    SurfaceChanges,
    ViewChanges,
)
from autocolor.scene.column_kinds import (
    Choice,
    ColorKind,
    CurveKind,
    Instance,
    Nested,
    Number,
    Referring,
    Rows,
    Text,
    references_of,
)
from autocolor.scene.columns import (
    REFUSED,
    Column,
    Problem,
    Row,
    Tier,
    changed,
    cost,
    fields_of,
    row_label,
)
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.scene.defaults import default_lights, default_parts, default_surface, default_view
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import MOST_SURFACES, Part, Surface
from autocolor.scene.view import View

SomeTableRow = TypeVar("SomeTableRow", Part, Surface, Light)

SCALINGS: Final = ("surface", "object")
CONTRASTS: Final = ("stretch", "floor")

MOST_PROBLEMS: Final = 100


@dataclass(frozen=True, eq=False)
class Scene(Row):
    """Everything that makes a picture, and everything that colors it; `scene_of` creates what is missing.

    There is one part for each of the mesh's part names, in their order, and a surface for each name that a
    part has. Paper: "The Lighting Model" (ambient; mapping by surface or by object; nonlinear mappings).
    """

    mesh: Annotated[Mesh, Column(Instance(Mesh), Tier.FRAME, "The node table and the polygon table.")]
    parts: Annotated[
        tuple[Part, ...], Column(Rows(Part, by_name=True), Tier.FRAME, "The groups of polygons.")
    ]
    surfaces: Annotated[
        tuple[Surface, ...], Column(Rows(Surface, by_name=True), Tier.FRAME, "The kinds of finish.")
    ]
    lights: Annotated[tuple[Light, ...], Column(Rows(Light), Tier.MIX, "The lights of the studio.")]
    view: Annotated[View, Column(Nested(View), Tier.FRAME, "The eye and where it looks.")]
    ambient: Annotated[
        float, Column(Number(at_least=0), Tier.MIX, "The intensity that every point has without any light.")
    ] = 0.1
    scaling: Annotated[
        str,
        Column(
            Choice(SCALINGS), Tier.LEVELS, "Whose minimum and maximum are mapped: each surface's, or all."
        ),
    ] = "surface"
    mapping: Annotated[
        str | CurvePoints,
        Column(CurveKind(CURVES), Tier.LEVELS, "How intensities are mapped to levels."),
    ] = "linear"
    contrast: Annotated[
        str,
        Column(
            Choice(CONTRASTS),
            Tier.ENTRIES,
            "Whether the lowest level is black, or as bright as its intensity beside the highest.",
        ),
    ] = "stretch"
    background: Annotated[Color, Column(ColorKind(), Tier.ENTRIES, "The color where nothing is seen.")] = (
        0,
        0,
        0,
    )
    name: Annotated[
        str, Column(Text(may_be_empty=True), Tier.NOTHING, "What the scene is called: its folder or file.")
    ] = "scene"

    def rules(self) -> Iterator[Problem]:
        """The parts are those of the mesh, names lead to rows, and every surface has a number."""
        if self.mesh is not REFUSED and self.parts is not REFUSED:
            names = [part.name for part in self.parts]
            if names != list(self.mesh.part_names):
                rule = "the part table must have the mesh's parts in their order"
                yield Problem((), f"{rule} {list(self.mesh.part_names)}, not {names}")
        # The nearest right name takes its time; a file may have very many wrong ones.
        yield from islice(self._reference_problems(), MOST_PROBLEMS)
        if self.surfaces is not REFUSED and len(self.surfaces) > MOST_SURFACES:
            yield Problem(
                ("surfaces",),
                f"must be at most {MOST_SURFACES}, not {len(self.surfaces)}; let parts share a surface",
            )

    def _reference_problems(self) -> Iterator[Problem]:
        """The names of rows of other tables that are not there."""
        for table, field in fields_of(Scene).items():
            kind, rows = field.column.kind, vars(self)[table]
            if isinstance(kind, Rows) and rows is not REFUSED:
                for name, referring in references_of(kind.row_class).items():
                    others = vars(self)[referring.table]
                    if others is not REFUSED:
                        yield from _missing_names(rows, name, referring, [row.name for row in others])

    def replace(self, **changes: Unpack[SceneChanges]) -> Scene:
        """The scene with some fields changed."""
        return changed(self, changes)

    def equals(self, other: Scene) -> bool:
        """Whether every column is equal; meshes are compared by identity."""
        return cost_of_edit(other, self) is None

    def light(self, name: str) -> Light:
        """The light of that name; UsageError with the nearest right name when there is none."""
        return self.lights[_place("light", self.lights, name)]

    def surface(self, name: str) -> Surface:
        """The surface of that name; UsageError with the nearest right name when there is none."""
        return self.surfaces[_place("surface", self.surfaces, name)]

    def part(self, name: str) -> Part:
        """The part of that name; UsageError with the nearest right name when there is none."""
        return self.parts[_place("part", self.parts, name)]

    def with_light(self, name: str, /, **changes: Unpack[LightChanges]) -> Scene:
        """The scene with some fields of one light changed."""
        return self._with_row("lights", _place("light", self.lights, name), changes)

    def with_surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> Scene:
        """The scene with some fields of one surface changed, its reflectance and paint among them."""
        return self._with_row("surfaces", _place("surface", self.surfaces, name), changes)

    def with_part(self, name: str, /, **changes: Unpack[PartChanges]) -> Scene:
        """The scene with some fields of one part changed."""
        return self._with_row("parts", _place("part", self.parts, name), changes)

    def with_view(self, **changes: Unpack[ViewChanges]) -> Scene:
        """The scene with some fields of the view changed."""
        return self._with_checked({"view": self.view.replace(**changes)})

    def only_lights(self, *names: str) -> Scene:
        """The scene with the named lights on and all others off (Paper: Figure 8)."""
        wanted = [self.light(name).name for name in names]
        return self.replace(lights=tuple(light.replace(on=light.name in wanted) for light in self.lights))

    def _with_row(self, table: str, place: int, changes: Mapping[str, Any]) -> Scene:
        rows = vars(self)[table]
        row = rows[place]
        rows = (*rows[:place], changed(row, changes), *rows[place + 1 :])
        # Only names lead from table to table: without a new one there is nothing to check again.
        if "name" in changes or not references_of(type(row)).keys().isdisjoint(changes):
            return changed(self, {table: rows})
        return self._with_checked({table: rows})

    def _with_checked(self, values: Mapping[str, object]) -> Scene:
        """The scene with other values of some fields, which were checked and lead to no other rows.

        What the scene computed of itself and keeps goes along: it depends on names only.
        """
        copy = object.__new__(Scene)
        vars(copy).update(vars(self))
        vars(copy).update(values)
        return copy

    @cached_property
    def surface_number_of_part(self) -> tuple[int, ...]:
        """The surface number, counted from 1, of each part."""
        number = {surface.name: row + 1 for row, surface in enumerate(self.surfaces)}
        return tuple(number[part.surface] for part in self.parts)

    def __repr__(self) -> str:
        return (
            f"Scene({self.name!r}: {self.mesh!r}, surfaces {len(self.surfaces)}, lights {len(self.lights)})"
        )  # fmt: skip


def _missing_names(
    rows: Sequence[Row], name: str, referring: Referring, known: Sequence[str]
) -> Iterator[Problem]:
    """What rows name in a column and the other table has not."""
    found = set(known)
    for row in rows:
        for wanted in referring.names_in(vars(row)[name]):
            if wanted not in found:
                table = f"the {referring.table.removesuffix('s')} table"
                text = f"{row_label(row)}: {name} {shown(wanted)} is not in {table}{nearest(wanted, known)}"
                yield Problem((), text)


@lru_cache(maxsize=1)
def cost_of_edit(old: Scene, new: Scene) -> Tier | None:
    """What an edit costs that changes one scene to another, None where they are equal.

    The answer is kept, for whoever takes part in an edit asks for it: the studio, the renderer, the mapping.
    """
    return cost(old, new)


def costs_at_least(old: Scene, new: Scene, tier: Tier) -> bool:
    """Whether an edit that changes one scene to another costs a tier or more."""
    costs = cost_of_edit(old, new)
    return costs is not None and costs >= tier


def scene_of(
    mesh: Mesh, *, surface_of_part: Mapping[str, str] | None = None, **fields: Unpack[SceneFields]
) -> Scene:
    """A scene of a mesh, with every table that is not given created.

    A part takes the surface that `surface_of_part` names, else the surface of its own name, else one that
    is created for it. Where that would be more surfaces than numbers, the parts past them share the last.
    `fields` are the other fields of Scene. Raises InputError.
    """
    missing = [name for name in surface_of_part or {} if name not in mesh.part_names]
    if missing:
        raise InputError(
            f"there is no part {shown(name)} to take a surface{nearest(name, mesh.part_names)}"
            for name in missing
        )
    tables: dict[str, Any] = dict(fields)
    given, view, lights = (tables.pop(name, None) for name in ("surfaces", "view", "lights"))
    parts, surfaces = _with_default_surfaces(mesh, surface_of_part or {}, tuple(given or ()))
    if view is None:
        view = default_view(mesh)
    if lights is None:
        lights = default_lights(mesh, view)
    return Scene(mesh, parts, surfaces, lights, view, **tables)


def _with_default_surfaces(
    mesh: Mesh, surface_of_part: Mapping[str, str], given: tuple[Surface, ...]
) -> tuple[tuple[Part, ...], tuple[Surface, ...]]:
    """The parts, and the given surfaces with those that are created for parts, while there are numbers."""
    parts = default_parts(mesh, surface_of_part)
    names = {surface.name: None for surface in given} | {part.surface: None for part in parts}
    kept = list(names)[:MOST_SURFACES]
    if len(names) > MOST_SURFACES and len(given) < MOST_SURFACES:
        shared = set(kept)
        parts = tuple(part if part.surface in shared else Part(part.name, kept[-1]) for part in parts)
    table = {surface.name: surface for surface in given}
    if len(table) < len(given):
        # Names that are repeated are refused where the scene is made.
        return parts, given
    # A part that names a surface of another name than its own must name one that is given.
    named = set(surface_of_part.values())
    own = set(mesh.part_names)
    for number, name in enumerate(kept):
        if name not in table and (name not in named or name in own):
            table[name] = default_surface(name, number)
    return parts, tuple(table.values())


def _place(kind: str, rows: Sequence[SomeTableRow], name: str) -> int:
    """Where the row of that name is."""
    for place, row in enumerate(rows):
        if row.name == name:
            return place
    raise UsageError(f"there is no {kind} {name!r}{nearest(str(name), [row.name for row in rows])}")
