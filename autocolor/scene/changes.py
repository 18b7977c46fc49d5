"""The keys of a change of a row, and the types of their values, for editors and type checkers.

The keys of an inline row, such as the paint of a surface, are those of its own changes. Written by
`python -m docs.generate.changes` from the columns; do not edit it by hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

from autocolor.scene.columns import Row


class FlapChanges(TypedDict, total=False):
    minimum: float
    maximum: float
    on: bool
    edge_width: float


class FlapsChanges(TypedDict, total=False):
    x: Row | FlapChanges | None
    y: Row | FlapChanges | None
    z: Row | FlapChanges | None


class HalfSpaceChanges(TypedDict, total=False):
    name: str
    point: Sequence[float]
    direction: Sequence[float]
    edge_width: float
    carried: bool
    on: bool


class LinksChanges(TypedDict, total=False):
    only_surfaces: Sequence[str] | None
    except_surfaces: Sequence[str] | None
    only_parts: Sequence[str] | None
    except_parts: Sequence[str] | None


class LightChanges(LinksChanges, total=False):
    name: str
    position: Sequence[float]
    intensity: float
    on: bool
    direction: Sequence[float] | None
    aim: Sequence[float] | None
    concentration: float
    cone_angle: float | None
    inner_angle: float | None
    flaps: Row | FlapsChanges
    half_spaces: Mapping[str, Row | HalfSpaceChanges | None] | Sequence[Row]
    falloff: Literal["none", "linear", "quadratic"]
    reach: float | None
    at_infinity: bool
    follows: str | None
    links: Row | LinksChanges


class PartChanges(TypedDict, total=False):
    name: str
    surface: str
    stage: bool


class ReflectanceChanges(TypedDict, total=False):
    diffuse: float
    specular: float
    model: str | Row
    exponent: float
    base_reflectance: float | None
    refractive_index: float | None
    fresnel_curve: Sequence[Sequence[float]] | None
    roughness: float
    normal_reflectance: float


class PaintChanges(TypedDict, total=False):
    object_color: str | Sequence[int]
    light_color: str | Sequence[int]
    blend: float
    light_percentage: float
    ramp: str | Sequence[str | Sequence[int]] | None


class SurfaceChanges(ReflectanceChanges, PaintChanges, total=False):
    name: str
    reflectance: Row | ReflectanceChanges
    paint: Row | PaintChanges
    two_sided: bool
    levels: int | None


class ViewChanges(TypedDict, total=False):
    eye: Sequence[float]
    direction: Sequence[float] | None
    target: Sequence[float] | None
    angle: float
    field_of_view: float


class NamedViewChanges(ViewChanges, total=False):
    name: str
    view: Row | ViewChanges


class ScalarChanges(TypedDict, total=False):
    name: str
    limits: Sequence[float] | None
    scale: str | Sequence[str | Sequence[int]]
    bands: int
    shades: int | None
    below: str | Sequence[int] | None
    above: str | Sequence[int] | None
    missing: str | Sequence[int]
    legend: bool
    legend_place: Sequence[float] | None
    surfaces: Sequence[str] | None
    direction: Sequence[float]
    stripes: float


class SceneFields(TypedDict, total=False):
    lights: Sequence[Row]
    view: Row | ViewChanges
    ambient: float
    scaling: Literal["surface", "object"]
    mapping: str | Sequence[Sequence[float]]
    contrast: Literal["stretch", "floor"]
    exposure: str | Mapping[str, Sequence[float]] | Sequence[tuple[str, Sequence[float]]]
    dither: Literal["off", "ordered"]
    division: Literal["covered", "equal"]
    words: Literal["levels", "normals"]
    interpolation: Literal["scan line", "invariant", "linear"]
    background: str | Sequence[int]
    stage: Literal["none", "floor", "bowl"]
    backdrop: str | Sequence[str | Sequence[int]] | None
    front: Literal["x", "-x", "y", "-y"] | None
    views: Sequence[Row]
    scalar: Row | ScalarChanges | None
    name: str


class SceneChanges(SceneFields, total=False):
    mesh: object
    parts: Sequence[Row]
    surfaces: Sequence[Row]
