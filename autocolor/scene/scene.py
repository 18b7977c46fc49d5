"""The scene: mesh, parts, surfaces, lights and view, and how intensities are shown.

Scenes are immutable. An edit makes a new scene, which shares every unchanged table with the old scene. The
cost of the edit is found by comparing the two scenes (see `Tier`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import chain, islice
from typing import Any, Final, NoReturn, TypeVar, Unpack

from autocolor.arrays import Floats
from autocolor.checks import Color, Vector, nearest, shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import read_only
from autocolor.scene.changes import (
    LightChanges,
    NamedViewChanges,
    PaintChanges,
    PartChanges,
    ScalarChanges,
    SceneChanges,
    SurfaceChanges,
    ViewChanges,
)
from autocolor.scene.columns import (
    REFUSED,
    BarRange,
    Problem,
    Row,
    RowError,
    Tier,
    column_of,
    cost,
    fields_of,
    replaced,
    row_label,
    with_values,
)
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.scene.defaults import object_bounds, object_coordinates
from autocolor.scene.following import (
    Frame,
    followers_of,
    following_problems,
    frame_of,
    in_frame,
    lights_in_world,
    vector_columns,
)
from autocolor.scene.in_1983 import changes_to_1983
from autocolor.scene.kinds import ColorsKind, CurveKind, Instance, color, number, one_of, text
from autocolor.scene.lights import Light, free_name
from autocolor.scene.mesh import Mesh
from autocolor.scene.rigs import Rig, axis_number, mirrored
from autocolor.scene.row_kinds import (
    RangesByName,
    RowList,
    TableRows,
    nested,
    place_named,
    references_of,
    table_row,
)
from autocolor.scene.scalar import COMPUTED, Scalar
from autocolor.scene.stage import BACKDROP, NONE, STAGES, SURFACE, stage_part, with_stage
from autocolor.scene.surfaces import MOST_SURFACES, Paint, Part, Surface
from autocolor.scene.view import MOST_VIEWS, NamedView, View

SomeTableRow = TypeVar("SomeTableRow", Part, Surface, Light, NamedView)

SCAN_LINE: Final = "scan line"
INVARIANT: Final = "invariant"
LINEAR: Final = "linear"
INTERPOLATIONS: Final = (SCAN_LINE, INVARIANT, LINEAR)
FRONTS: Final = ("x", "-x", "y", "-y")
LEVELS: Final = "levels"
NORMALS: Final = "normals"
"""The meanings of words."""

AUTO: Final = "auto"
OBJECT: Final = "object"
"""In `exposure`, the name of the range of the whole object. A surface of this name has no fixed range."""

Exposure = str | tuple[tuple[str, tuple[float, float]], ...]
"""AUTO, a percentage, or fixed ranges: pairs (name, (minimum, maximum)); a name is OBJECT or a surface's.

With a percentage such as "99.5 %", the brightest pixels beyond this share do not set a range.
"""

MOST_PROBLEMS: Final = 100
"""Limit: problems of references in a message, and of lights that follow each other."""


@table_row
class Scene(Row):
    """Everything needed to render and color a picture. `scene_of` makes a scene of a mesh.

    The part table has the part names of the mesh in the same order, and every part's surface is in the
    surface table. Paper: "The Lighting Model" (ambient; mapping by surface or by object; nonlinear mappings).
    """

    mesh: Mesh = column_of(Instance(Mesh), tier=Tier.FRAME, help="The node table and the polygon table.")
    parts: TableRows[Part] = column_of(
        RowList(Part, by_name=True), tier=Tier.FRAME, help="The parts, which are groups of polygons."
    )
    surfaces: TableRows[Surface] = column_of(
        RowList(Surface, by_name=True), tier=Tier.FRAME, help="The surface types."
    )
    lights: TableRows[Light] = column_of(RowList(Light), tier=Tier.MIX, help="The lights.")
    view: View = nested(View, tier=Tier.FRAME, help="The eye position and the view direction.")
    ambient: float = number(
        default=0.1,
        at_least=0,
        bar=BarRange(0, 1, 0.01),
        tier=Tier.MIX,
        help="The intensity of every point without any light.",
    )
    scaling: str = one_of(
        ("surface", "object"),
        default="surface",
        tier=Tier.LEVELS,
        help="Whether each surface has its own intensity range, or all surfaces share a range.",
    )
    mapping: str | CurvePoints = column_of(
        CurveKind(CURVES), default="linear", tier=Tier.LEVELS, help="How intensities are mapped to levels."
    )
    contrast: str = one_of(
        ("stretch", "floor"),
        default="stretch",
        tier=Tier.ENTRIES,
        help="Whether the lowest level is black, or in proportion to the minimum intensity.",
    )
    exposure: Exposure = column_of(
        RangesByName("surfaces", OBJECT, AUTO),
        default=AUTO,
        unit="intensity",
        tier=Tier.LEVELS,
        help="Whether intensity ranges follow the picture, leave out its brightest pixels, or are fixed.",
    )
    dither: str = one_of(
        ("off", "ordered"),
        default="off",
        tier=Tier.LEVELS,
        help="Whether levels are rounded, or dithered by an ordered pattern.",
    )
    division: str = one_of(
        ("covered", "equal"),
        default="covered",
        tier=Tier.LEVELS,
        help="Whether surfaces that cover more of the picture get more levels, or all the same number.",
    )
    words: str = one_of(
        (LEVELS, NORMALS),
        default=LEVELS,
        tier=Tier.LEVELS,
        help="Whether words stand for levels, or for normals: lights then change entries only.",
    )
    interpolation: str = one_of(
        INTERPOLATIONS,
        default=SCAN_LINE,
        tier=Tier.FRAME,
        help="How normals are interpolated: along scan lines, in triangles (the same if the camera rolls), or"
        " linearly, as in 1983.",
    )
    background: Color = color(
        default=(0, 0, 0), tier=Tier.ENTRIES, help="The color where nothing is visible."
    )
    stage: str = one_of(
        STAGES,
        default=NONE,
        tier=Tier.FRAME,
        help="Whether the object stands on a floor, or in a bowl; the dark pool below it is painted, not"
        " computed.",
    )
    backdrop: tuple[Color, ...] | None = column_of(
        ColorsKind(2),
        default=None,
        tier=Tier.LEVELS,
        help="Two colors behind everything, from the top of the picture down; if absent, a stage has grays.",
    )
    front: str | None = one_of(
        FRONTS,
        default=None,
        tier=Tier.NOTHING,
        help="The axis toward which the object faces; it names the views from the sides.",
    )
    views: TableRows[NamedView] = column_of(
        RowList(NamedView),
        default=TableRows(),
        tier=Tier.NOTHING,
        help="The named views, which can become the view.",
    )
    scalar: Scalar | None = nested(
        Scalar, default=None, tier=Tier.MIX, help="The scalar that colors the surfaces, if any."
    )
    name: str = text(
        default="scene",
        may_be_empty=True,
        tier=Tier.NOTHING,
        help="The name of the scene, from its folder or file.",
    )

    def complete(self) -> None:
        """Add the surface of the stage, if the scene has a stage and no surface of that name."""
        if self.stage != NONE and self.parts is not REFUSED and self.surfaces is not REFUSED:
            name = stage_part(self.parts).surface
            if name not in [row.name for row in self.surfaces]:
                vars(self)["surfaces"] = TableRows((*self.surfaces, SURFACE.replace(name=name)))

    def rules(self) -> Iterator[Problem]:
        """The parts match the mesh, all references are valid, and there are few enough surfaces and views.

        If a scalar colors surfaces, words cannot stand for normals: the color of a point depends on its
        position, too.
        """
        if self.mesh is not REFUSED and self.parts is not REFUSED:
            names = [part.name for part in self.parts]
            if names != list(self.mesh.part_names):
                rule = "the part table must have the mesh's parts in their order"
                yield Problem((), f"{rule} {list(self.mesh.part_names)}, not {names}")
        if self.mesh is not REFUSED and isinstance(self.scalar, Scalar):
            name, scalars = self.scalar.name, self.scalar_names
            if name not in scalars:
                rule = "must be a scalar of the mesh or a computed scalar"
                yield Problem(("scalar", "name"), f"{rule}, not {shown(name)}{nearest(name, scalars)}")
        if self.words == NORMALS and self.scalar is not None:
            rule = "must be 'levels' where a scalar colors surfaces, not 'normals'; change it, or remove the"
            yield Problem(("words",), f"{rule} scalar")
        # Finding the closest valid name is slow, and a file may contain many invalid names.
        yield from islice(self._reference_problems(), MOST_PROBLEMS)
        if self.lights is not REFUSED:
            yield from islice(following_problems(self.lights), MOST_PROBLEMS)
        for table, most, advice in (
            ("surfaces", MOST_SURFACES, "let parts share a surface"),
            ("views", MOST_VIEWS, "remove named views"),
        ):
            rows = vars(self)[table]
            if rows is not REFUSED and len(rows) > most:
                yield Problem((table,), f"must be at most {most}, not {len(rows)}; {advice}")

    def _reference_problems(self) -> Iterator[Problem]:
        """The problems of references to rows that are not in their tables."""
        tables = {
            name: vars(self)[name]
            for name, column in fields_of(Scene).items()
            if isinstance(column.kind, RowList) and vars(self)[name] is not REFUSED
        }
        names = {table: {row.name: None for row in rows} for table, rows in tables.items()}
        scalars = (self.scalar,) if isinstance(self.scalar, Scalar) else ()
        for row in chain[Any]((self,), *tables.values(), scalars):
            for key, at in references_of(type(row)).items():
                kind: Any = at.column.kind
                value = vars(row)[at.field]
                if at.field != key:
                    value = vars(value)[key] if isinstance(value, Row) else REFUSED
                if value is REFUSED or value is None or kind.table not in names:
                    continue
                for name in kind.names_in(value):
                    if name not in names[kind.table]:
                        where = f"is not in the {kind.table.removesuffix('s')} table"
                        close = nearest(name, [*kind.words, *names[kind.table]])
                        label = f"{row_label(row)}: " if row_label(row) else ""
                        yield Problem((), f"{label}{key} {shown(name)} {where}{close}")

    # A scene is equal to itself only; `equals` compares the columns.
    __eq__, __hash__ = object.__eq__, object.__hash__

    def replace(self, /, **changes: Unpack[SceneChanges]) -> Scene:
        """The scene with some fields changed."""
        return replaced(self, changes)

    def as_in_1983(self) -> Scene:
        """The scene with what the paper describes, and nothing since; see `in_1983`."""
        return replaced(self, changes_to_1983(self.surfaces, self.lights))

    def equals(self, other: Scene) -> bool:
        """Whether all columns are equal. Meshes are compared by identity."""
        return cost_of_edit(other, self) is None

    @property
    def lights_in_world(self) -> TableRows[Light]:
        """The lights in object coordinates, whatever they follow."""
        return TableRows(lights_in_world(self.lights, self.view))

    def with_light_in_world(self, name: str, /, **changes: Unpack[LightChanges]) -> Scene:
        """The scene with some fields of a light changed; positions and directions are in object coordinates.

        They are converted to the frame that the light follows. Changing `follows` alone leaves the light
        where it is in the object. Raises UsageError or InputError.
        """
        if "follows" in changes:
            followed = self.with_light_following(name, changes.pop("follows"))
            return followed.with_light_in_world(name, **changes)
        frame = self._frame_of(name)
        if frame is None:
            return self.with_light(name, **changes)
        moved: dict[str, Any] = frame.from_world(self.lights_in_world[name].replace(**changes))
        return self.with_light(name, **{**changes, **{each: moved[each] for each in moved.keys() & changes}})

    def with_light_following(self, name: str, follows: str | None) -> Scene:
        """The scene in which a light follows "eye", another light or nothing, and stays where it is now.

        Raises UsageError if no light has that name, InputError if the light cannot follow `follows`.
        """
        world = vars(self.lights_in_world[name])
        followed = self.with_light(name, follows=follows)
        return followed.with_light_in_world(name, **{each: world[each] for each in vector_columns(Light)})

    def _frame_of(self, name: str) -> Frame | None:
        world = {light.name: light for light in self.lights_in_world}
        return frame_of(self.lights[name], world, self.view)

    def with_light(self, name: str, /, **changes: Unpack[LightChanges]) -> Scene:
        """The scene with some fields of a light changed."""
        return self._with_row("lights", place_named(self.lights, name, "light"), changes)

    def with_surface(self, name: str, /, **changes: Unpack[SurfaceChanges]) -> Scene:
        """The scene with some fields of a surface changed, also fields of its reflectance and its paint."""
        return self._with_row("surfaces", place_named(self.surfaces, name, "surface"), changes)

    def with_paint(self, name: str, /, *colors: NoReturn, **changes: Unpack[PaintChanges]) -> Scene:
        """The scene with some fields of a surface's paint changed; the same scene if all values are equal."""
        if colors:
            raise UsageError(
                f"a recoloring must name its fields, not give {shown(colors[0])} alone; write it as in"
                f" recolor({name!r}, object_color={shown(colors[0])})"
            )
        place = place_named(self.surfaces, name, "surface")
        surface = self.surfaces[place]
        try:
            paint = replaced(surface.paint, changes)
        except RowError as error:
            raise RowError(error.row_problems, row_label(surface)) from None
        if paint == surface.paint:
            return self
        row = with_values(surface, {"paint": paint})
        rows = TableRows((*self.surfaces[:place], row, *self.surfaces[place + 1 :]))
        return with_values(self, {"surfaces": rows})

    def with_part(self, name: str, /, **changes: Unpack[PartChanges]) -> Scene:
        """The scene with some fields of a part changed."""
        return self._with_row("parts", place_named(self.parts, name, "part"), changes)

    def with_view(self, /, **changes: Unpack[ViewChanges]) -> Scene:
        """The scene with some fields of the view changed."""
        return with_values(self, {"view": self.view.replace(**changes)})

    def with_named_view(self, name: str, /, **changes: Unpack[NamedViewChanges]) -> Scene:
        """The scene with some fields of a named view changed; the view itself stays."""
        return self._with_row("views", place_named(self.views, name, "named view"), changes)

    def with_saved_view(self, name: str | None = None) -> Scene:
        """The scene with its view under a name: of a new named view at the end, or in place of an old one.

        Without a name it is a new one, like "view 1".
        """
        if name is None:
            name = free_name("view 1", [row.name for row in self.views])
        rows = {row.name: row for row in self.views}
        return replaced(self, {"views": tuple({**rows, name: NamedView(name, self.view)}.values())})

    def with_taken_view(self, name: str) -> Scene:
        """The scene with a named view as its view. Raises UsageError if the named view does not exist."""
        return with_values(self, {"view": self.views[place_named(self.views, name, "named view")].view})

    def without_named_view(self, name: str) -> Scene:
        """The scene without a named view. Raises UsageError if the named view does not exist."""
        place = place_named(self.views, name, "named view")
        return with_values(self, {"views": TableRows((*self.views[:place], *self.views[place + 1 :]))})

    def with_scalar(self, /, **changes: Unpack[ScalarChanges]) -> Scene:
        """The scene with some fields of its scalar changed. A new scalar must have a name."""
        return replaced(self, {"scalar": changes})

    def without_scalar(self) -> Scene:
        """The scene without its scalar, in the colors of its surfaces."""
        return with_values(self, {"scalar": None})

    def with_new_light(self, name: str, /, **fields: Unpack[LightChanges]) -> Scene:
        """The scene with a new light at the end of its lights; `fields` must have a position.

        Raises InputError if a field is invalid or a light has that name already.
        """
        new: dict[str, Any] = {**fields, "name": name}
        return replaced(self, {"lights": (*self.lights, new)})

    def without_light(self, name: str) -> Scene:
        """The scene without a light.

        Raises UsageError if the light does not exist, InputError if another light follows it.
        """
        place = place_named(self.lights, name, "light")
        if followers := followers_of(name, self.lights):
            first = repr(followers[0])
            raise InputError(
                f"light {name!r} must stay while {first} follows it; let {first} follow something else"
            )
        return replaced(self, {"lights": (*self.lights[:place], *self.lights[place + 1 :])})

    def with_copied_light(self, name: str, new_name: str | None = None) -> Scene:
        """The scene with a copy of a light at the end of its lights, named like "key 2" without `new_name`.

        Raises UsageError if the light does not exist, InputError if the new name is taken.
        """
        light = self.lights[name]
        if new_name is None:
            new_name = self._free_light_name(name)
        return replaced(self, {"lights": (*self.lights, light.replace(name=new_name))})

    def with_mirrored_light(
        self, name: str, axis: str = "x", about: float | None = None, new_name: str | None = None
    ) -> Scene:
        """The scene with a mirrored copy of a light at the end of its lights.

        The mirror is the plane where the coordinate of `axis`, "x", "y" or "z", is `about`; by default it
        goes through the middle of the object. Position, aim or direction, half-spaces, and the flap of that
        axis are mirrored in object coordinates. The copy follows the same thing as the light. Without
        `new_name` its name is like "key mirrored". Raises UsageError for an unknown light or axis, InputError
        if the new name is taken.
        """
        light, number = self.lights_in_world[name], axis_number(axis)
        if about is None:
            low, high = self.object_bounds
            about = (low[number] + high[number]) / 2
        if new_name is None:
            new_name = self._free_light_name(f"{name} mirrored")
        copy = mirrored(light, new_name, axis, about)
        copy = in_frame(copy, self._frame_of(name), self.lights[name].follows)
        return replaced(self, {"lights": (*self.lights, copy)})

    def with_all_lights_on(self) -> Scene:
        """The scene with all lights switched on."""
        return self.replace(lights=tuple(light.replace(on=True) for light in self.lights))

    def with_rig(self, rig: Rig) -> Scene:
        """The scene with the lights of a rig instead of its own, fitted to the size of its object.

        Links to unknown surfaces and parts are left out (see `Links.within`). Raises UsageError for any other
        value, InputError if the lights cannot be fitted (see `Rig.fitted`).
        """
        if not isinstance(rig, Rig):
            raise UsageError(f"a rig must be a Rig, not {shown(rig)}; read one from a file with `read_rig`")
        surfaces, parts = ({row.name for row in rows} for rows in (self.surfaces, self.parts))
        lights = [
            light.replace(links=light.links.within(surfaces, parts))
            for light in rig.fitted(*self.object_bounds)
        ]
        return self.replace(lights=lights)

    @property
    def rig(self) -> Rig:
        """The lights, with the size of their object."""
        return Rig(*self.object_bounds, self.lights)

    def _free_light_name(self, name: str) -> str:
        return free_name(name, [light.name for light in self.lights])

    def only_lights(self, *names: str) -> Scene:
        """The scene with the named lights on and all others off (Paper: Figure 8)."""
        wanted = [self.lights[name].name for name in names]
        return self.replace(lights=tuple(light.replace(on=light.name in wanted) for light in self.lights))

    def _with_row(self, table: str, place: int, changes: Mapping[str, Any]) -> Scene:
        rows = vars(self)[table]
        row = rows[place]
        rows = TableRows((*rows[:place], replaced(row, changes), *rows[place + 1 :]))
        # Tables refer to each other by name, so references stay valid unless a name or a reference changes.
        # A light must keep the aim that another light follows. Cached properties depend on the parts.
        is_followed = table == "lights" and any(light.follows is not None for light in self.lights)
        is_referring = any(
            key in changes or at.field in changes for key, at in references_of(type(row)).items()
        )
        if table == "parts" or "name" in changes or is_referring or is_followed:
            return replaced(self, {table: rows})
        return with_values(self, {table: rows})

    @property
    def backdrop_colors(self) -> tuple[Color, ...]:
        """The colors of the backdrop from the top of the picture; none if there is only the background."""
        return self.backdrop or (BACKDROP if self.stage != NONE else ())

    @property
    def has_backdrop(self) -> bool:
        """Whether there is a backdrop where nothing is visible."""
        return bool(self.backdrop_colors)

    @property
    def stage_surface(self) -> str:
        """The name of the surface of the stage that is made; empty if `stage` is "none"."""
        return stage_part(self.parts).surface if self.stage != NONE else ""

    @property
    def staged(self) -> Scene:
        """The scene as it is rendered: a stage that is made is a part of the mesh.

        It is the scene itself if there is none to make, or if the eye is not above the floor.
        """
        mesh = with_stage(self.mesh, self.parts, self.stage, self.view.eye) if self.stage != NONE else None
        if mesh is None:
            return self
        # Cached properties depend on the mesh and the parts, so they are not copied.
        parts = TableRows((*self.parts, stage_part(self.parts)))
        copy, values = object.__new__(Scene), {name: vars(self)[name] for name in fields_of(Scene)}
        vars(copy).update({**values, "mesh": mesh, "parts": parts, "stage": NONE})
        return copy

    @cached_property
    def surface_number_of_part(self) -> tuple[int, ...]:
        """The surface number, counted from 1, of each part."""
        number = {surface.name: row + 1 for row, surface in enumerate(self.surfaces)}
        return tuple(number[part.surface] for part in self.parts)

    @cached_property
    def object_coordinates(self) -> Floats:
        """The coordinates of the nodes of all parts that are not stage, (nodes, 3)."""
        return read_only(object_coordinates(self.mesh, self.parts))

    @property
    def scalar_names(self) -> tuple[str, ...]:
        """The names of the scalars that can color surfaces: the mesh's, then the computed scalars."""
        return tuple(dict.fromkeys([*(scalar.name for scalar in self.mesh.scalars), *COMPUTED]))

    @cached_property
    def object_bounds(self) -> tuple[Vector, Vector]:
        """The least and the largest coordinates of the object; zeros if it has no nodes."""
        low, high = (tuple(corner.tolist()) for corner in object_bounds(self.mesh, self.parts))
        return low, high

    def __repr__(self) -> str:
        counts = f"surfaces {len(self.surfaces)}, lights {len(self.lights)}"
        return f"Scene({self.name!r}: {self.mesh!r}, {counts})"


def check_scene(value: object) -> None:
    """Raise UsageError if a value is no Scene."""
    if not isinstance(value, Scene):
        raise UsageError(
            f"a scene must be a Scene, not {shown(value)}; read a scene from files with `read_scene`, or make"
            " a scene of a mesh with `scene_of`"
        )


def cost_of_edit(old: Scene, new: Scene) -> Tier | None:
    """The cost of an edit from one scene to another; None if they are equal."""
    return cost(old, new)


def costs_at_least(old: Scene, new: Scene, tier: Tier) -> bool:
    """Whether an edit from one scene to another costs at least a tier."""
    edit_cost = cost(old, new)
    return edit_cost is not None and edit_cost >= tier


def unseen_recoloring(old: Scene, new: Scene, surface: str) -> str:
    """Why no picture shows the recoloring of a surface by `with_paint`; empty if one can show it."""
    if new is old:
        return f"surface {shown(surface)} has these colors already; the recoloring changes nothing"
    in_use = {new.parts[part].surface for part in new.mesh.parts_in_use}
    if surface not in (*in_use, new.stage_surface):
        return f"surface {shown(surface)} has no polygons; no picture shows its colors"
    return ""


def unset_paints(old: Scene, new: Scene) -> list[str]:
    """A sentence for each surface whose two colors an edit replaces by a ramp, or whose ramp by two colors.

    Two colors that are the defaults are not lost, so they give no sentence.
    """
    sentences = []
    paints = {surface.name: surface.paint for surface in old.surfaces}
    for surface in new.surfaces:
        before, now = paints.get(surface.name, surface.paint), surface.paint
        if before.ramp is None and now.ramp is not None and before != Paint():
            sentences.append(f"{surface.name}: the ramp replaces its two colors and their blend")
        elif before.ramp is not None and now.ramp is None:
            sentences.append(f"{surface.name}: two colors and their blend replace its ramp")
    return sentences
