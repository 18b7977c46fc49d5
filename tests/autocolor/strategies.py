"""Random meshes, lights, surfaces, views and scenes, small enough for a slow twin.

The coordinates are short binary fractions, so that polygons often meet: in the same place, in the same
plane, in the eye's plane, at a pixel's center.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    HalfSpace,
    Light,
    Mesh,
    NamedView,
    Paint,
    Part,
    Reflectance,
    Scene,
    Surface,
    View,
)
from autocolor.scene.curves import CURVES
from autocolor.scene.lights import Links
from autocolor.scene.reflection_models import MODELS, BlinnPhong, CookTorrance, Phong, SpecularGrowth
from autocolor.scene.scalar import MeshScalar, Scalar

Vector = tuple[float, float, float]

short = st.integers(-32, 32).map(lambda number: number / 16)
"""Numbers from -2 to 2 that meet often."""


def numbers(least: float, most: float) -> st.SearchStrategy[float]:
    """Numbers within the bounds, with no tiny ones around 0."""
    return st.integers(0, 1 << 20).map(lambda step: least + (most - least) * step / (1 << 20))


def vectors(component: st.SearchStrategy[float] = short) -> st.SearchStrategy[Vector]:
    """Points, or directions that may be zero."""
    return st.tuples(component, component, component)


directions = vectors().filter(any)
colors = st.tuples(*[st.integers(0, 255)] * 3)


@st.composite
def meshes(draw: st.DrawFn, parts: int = 2, least_polygons: int = 1) -> Mesh:
    """Polygons among a few nodes: warped, crossing themselves and each other, without area, repeated."""
    coordinates = draw(st.lists(vectors(), min_size=3, max_size=9))
    node = st.integers(0, len(coordinates) - 1)
    if draw(st.booleans()):
        # A mesh of a file that repeats its nodes.
        coordinates = coordinates + coordinates
        node = st.integers(0, len(coordinates) - 1)
    quads = st.tuples(node, node, node, node)
    triangles = st.tuples(node, node, node).map(lambda three: (*three, three[2]))
    polygons = draw(st.lists(quads | triangles, min_size=least_polygons, max_size=8))
    part_numbers = draw(st.lists(st.integers(0, parts - 1), min_size=len(polygons), max_size=len(polygons)))
    return Mesh(
        np.array(coordinates),
        np.array(polygons, np.intp).reshape(-1, 4),
        np.array(part_numbers, np.intp),
        tuple(f"part {number}" for number in range(parts)),
        crease_angle=draw(st.sampled_from([0.0, 40.0, 90.0, 180.0])),
    )


@st.composite
def soups(draw: st.DrawFn) -> Mesh:
    """Triangles of nowhere else used nodes, in general position: they pass through each other."""
    seed = draw(st.integers(0, 1 << 32))
    count = draw(st.integers(1, 10))
    coordinates = np.random.default_rng(seed).uniform(-1, 1, (3 * count, 3))
    return Mesh(coordinates, np.arange(3 * count).reshape(-1, 3), np.zeros(count, np.intp), ("soup",))


@st.composite
def views(draw: st.DrawFn) -> View:
    """Views from within, before and behind the polygons."""
    eye = draw(vectors())
    return View(
        eye,
        direction=draw(directions),
        angle=draw(st.sampled_from([0.0, 30.0, 90.0, -45.0])),
        field_of_view=draw(st.sampled_from([20.0, 60.0, 120.0])),
    )


@st.composite
def outside_views(draw: st.DrawFn) -> View:
    """Views of the whole from around it."""
    eye = draw(directions)
    far = 6.0 / float(np.linalg.norm(eye))
    return View((eye[0] * far, eye[1] * far, eye[2] * far), target=(0.0, 0.0, 0.0), field_of_view=40.0)


named_views = st.lists(
    st.builds(NamedView, st.sampled_from(["hood", "view 1", 'a "b".c']), views() | outside_views()),
    max_size=2,
    unique_by=lambda row: row.name,
).map(tuple)

interpolations = st.sampled_from(["scan line", "invariant"])

rasters = st.tuples(st.integers(1, 24), st.integers(1, 24))


edge_widths = st.just(0.0) | numbers(0.01, 2)
"""Sharp edges, and soft ones that begin and end among the polygons."""


@st.composite
def flaps(draw: st.DrawFn) -> Flaps:
    """Flaps in any of the directions, some of them switched off."""

    def one() -> Flap | None:
        if draw(st.booleans()):
            return None
        ends = sorted((draw(numbers(-1.5, 1.5)), draw(numbers(-1.5, 1.5))))
        return Flap(ends[0], ends[1], draw(st.booleans()), draw(edge_widths))

    return Flaps(one(), one(), one())


half_spaces = st.lists(
    st.builds(
        HalfSpace,
        st.sampled_from(["left", "right", "door 3"]),
        vectors(),
        directions,
        edge_widths,
        st.booleans(),
        st.booleans(),
    ),
    max_size=3,
    unique_by=lambda each: each.name,
).map(tuple)
"""Half-spaces in any direction, some of them soft, carried or switched off."""


@st.composite
def lights(draw: st.DrawFn, /, name: str = "light", **given: Any) -> Light:
    """A light with any of the controls."""
    position = given.pop("position", None) or draw(vectors(numbers(-3, 3)))
    fields: dict[str, Any] = {"intensity": draw(numbers(0, 3)), "on": draw(st.booleans())}
    if draw(st.booleans()):
        fields["direction"] = draw(directions)
        fields["concentration"] = draw(st.sampled_from([0.0, 1.0, 2.5, 10.0, 40.0]))
        fields["cone_angle"] = draw(st.none() | numbers(1, 180))
        if fields["cone_angle"] is not None:
            fields["inner_angle"] = draw(st.none() | numbers(0, fields["cone_angle"]))
    if draw(st.booleans()):
        fields["flaps"] = draw(flaps())
    fields["at_infinity"] = "direction" in fields and draw(st.booleans())
    if not fields["at_infinity"]:
        fields["falloff"] = draw(st.sampled_from(["none", "none", "linear", "quadratic"]))
        fields["reach"] = draw(numbers(0.5, 9)) if fields["falloff"] != "none" else None
    if draw(st.booleans()):
        fields["half_spaces"] = draw(half_spaces)
    return Light(name, position, **{**fields, **given})


@st.composite
def angle_curves_of(draw: st.DrawFn) -> tuple[tuple[float, float], ...]:
    """Points (angle in degrees, share) of a curve, which need not rise."""
    inner = draw(st.lists(st.integers(1, 89), max_size=4, unique=True))
    angles = [0.0, *sorted(map(float, inner)), 90.0]
    return tuple((angle, draw(numbers(0, 1) if angle else numbers(0.001, 1))) for angle in angles)


angle_curves = angle_curves_of()
growths = (
    st.just(SpecularGrowth())
    | st.builds(SpecularGrowth, base_reflectance=st.sampled_from([0.001, 0.04, 1.0]) | numbers(0.001, 1))
    | st.builds(SpecularGrowth, refractive_index=st.sampled_from([1.07, 1.5, 10.0]) | numbers(1.07, 10))
    | st.builds(SpecularGrowth, fresnel_curve=angle_curves)
)


def some_of(names: list[str]) -> st.SearchStrategy[tuple[str, ...]]:
    """Some of the names, perhaps none."""
    return st.lists(st.sampled_from(names), unique=True).map(tuple)


@st.composite
def links(draw: st.DrawFn, surfaces: list[str], parts: list[str]) -> Links:
    """Links to any of these surfaces and parts; half of the lights have none."""
    fields: dict[str, Any] = {}
    if draw(st.booleans()):
        for what, names in (("surfaces", surfaces), ("parts", parts)):
            which = draw(st.sampled_from(["", "only", "except"]))
            if which:
                fields[f"{which}_{what}"] = draw(some_of(names))
    return Links(**fields)


exponents = st.sampled_from([0.0, 1.0, 5.0, 20.0, 50.0])
models = (
    st.builds(Phong, exponents, growths)
    | st.builds(BlinnPhong, exponents, growths)
    | st.builds(CookTorrance, st.sampled_from([0.1, 0.3, 1.0]), st.sampled_from([0.04, 0.5, 1.0]))
    | st.sampled_from([model() for model in MODELS.values()])
)
reflectances = st.builds(Reflectance, numbers(0, 2), numbers(0, 2), exponents)
"""Phong's, as in the paper."""

reflectances_of_any_model = st.builds(Reflectance, numbers(0, 2), numbers(0, 2), models)
blended_paints = st.builds(
    Paint, colors, colors, st.sampled_from([0.0, 0.25, 0.6, 1.0]) | numbers(0, 1), numbers(0, 100)
)
ramps = st.lists(colors, min_size=2, max_size=9).map(tuple)
paints = blended_paints | st.builds(Paint, ramp=ramps)


def surfaces(name: str) -> st.SearchStrategy[Surface]:
    """A surface with any reflectance and paint; few ask for a number of levels."""
    return st.builds(
        Surface,
        st.just(name),
        reflectances_of_any_model,
        paints,
        st.booleans(),
        st.none() | st.integers(2, 300),
    )


MAPPINGS: list[Any] = [*CURVES, ((0, 0.1), (0.4, 0.8), (1, 1))]

held_ranges = st.tuples(numbers(0, 2), numbers(0.01, 3)).map(lambda pair: (pair[0], pair[0] + pair[1]))
exposures = st.sampled_from(["auto", "99.5 %", "60 %"]) | st.dictionaries(
    st.sampled_from(["body", "glass", "object"]), held_ranges, min_size=1
)


@st.composite
def mesh_scalars(draw: st.DrawFn, mesh: Mesh) -> tuple[MeshScalar, ...]:
    """A scalar of the nodes and one of the polygons, each with a few values, some of them missing."""
    value = st.integers(-8, 8).map(float) | st.just(float("nan"))

    def of(name: str, kind: str, count: int) -> MeshScalar:
        return MeshScalar(name, np.array(draw(st.lists(value, min_size=count, max_size=count)), float), kind)

    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    return of("stress", "node", nodes), of("load case 2", "polygon", polygons)


limits = st.tuples(st.integers(-8, 0), st.integers(1, 8)).map(lambda pair: (float(pair[0]), float(pair[1])))
short_lists = st.lists(colors, min_size=2, max_size=3).map(tuple)
scales = st.sampled_from(["viridis", "zebra", "coolwarm_r"]) | short_lists


def scalars() -> st.SearchStrategy[Scalar]:
    """A scalar of the mesh or a computed one, with any limits, bands and colors."""
    return st.builds(
        Scalar,
        st.sampled_from(["stress", "load case 2", "z"]),
        limits=st.none() | limits,
        scale=scales,
        bands=st.integers(2, 20),
        shades=st.none() | st.integers(1, 12),
        below=st.none() | colors,
        above=st.none() | colors,
        missing=colors,
        legend=st.booleans(),
        legend_place=st.none() | st.tuples(st.floats(0, 1), st.floats(0, 1)),
        surfaces=st.none() | st.sampled_from([("body",), ("glass", "body"), ()]),
        direction=directions,
        stripes=st.sampled_from([1.0, 12.0]),
    )


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """A scene with everything in it."""
    mesh = draw(meshes())
    mesh = mesh.with_scalars(*draw(mesh_scalars(mesh)))
    names, parts = ["body", "glass"], list(mesh.part_names)
    return Scene(
        mesh,
        tuple(Part(name, draw(st.sampled_from(names)), draw(st.booleans())) for name in mesh.part_names),
        tuple(draw(surfaces(name)) for name in names),
        tuple(
            draw(lights(name, links=draw(links(names, parts))))
            for name in draw(st.sampled_from([(), ("key",), ("key", "fill", "rim")]))
        ),
        draw(views() | outside_views()),
        ambient=draw(numbers(0, 1)),
        scaling=draw(st.sampled_from(["surface", "object"])),
        mapping=draw(st.sampled_from(MAPPINGS)),
        contrast=draw(st.sampled_from(["stretch", "floor"])),
        exposure=draw(exposures),  # type: ignore[arg-type]
        dither=draw(st.sampled_from(["off", "ordered"])),
        division=draw(st.sampled_from(["covered", "equal"])),
        interpolation=draw(interpolations),
        background=draw(colors),
        front=draw(st.sampled_from([None, "x", "-x", "y", "-y"])),
        views=draw(named_views),
        scalar=draw(st.none() | scalars()),
    )


def of_mesh(scene: Scene, mesh: Mesh) -> Scene:
    """The scene with another mesh, colored by a scalar that any mesh has."""
    row = scene.scalar and dataclasses.replace(scene.scalar, name="z")
    return scene.replace(mesh=mesh, scalar=row)
