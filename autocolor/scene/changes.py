"""What a change of a row may say: its keys and their types, for editors and type checkers.

Written by `python -m docs.generate.changes` from the columns; do not edit it by hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

from autocolor.scene.columns import Row


class FlapChanges(TypedDict, total=False):
    """Changes of a Flap."""

    minimum: float
    maximum: float
    on: bool
    edge_width: float


class FlapsChanges(TypedDict, total=False):
    """Changes of a Flaps."""

    x: Row | FlapChanges | None
    y: Row | FlapChanges | None
    z: Row | FlapChanges | None


class HalfSpaceChanges(TypedDict, total=False):
    """Changes of a HalfSpace."""

    name: str
    point: Sequence[float]
    direction: Sequence[float]
    edge_width: float
    carried: bool
    on: bool


class LinksChanges(TypedDict, total=False):
    """Changes of a Links."""

    only_surfaces: Sequence[str] | None
    except_surfaces: Sequence[str] | None
    only_parts: Sequence[str] | None
    except_parts: Sequence[str] | None


class LightChanges(TypedDict, total=False):
    """Changes of a Light."""

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
    only_surfaces: Sequence[str] | None
    except_surfaces: Sequence[str] | None
    only_parts: Sequence[str] | None
    except_parts: Sequence[str] | None


class PartChanges(TypedDict, total=False):
    """Changes of a Part."""

    name: str
    surface: str
    stage: bool


class ReflectanceChanges(TypedDict, total=False):
    """Changes of a Reflectance."""

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
    """Changes of a Paint."""

    object_color: str | Sequence[int]
    light_color: str | Sequence[int]
    blend: float
    light_percentage: float
    ramp: str | Sequence[str | Sequence[int]] | None


class SurfaceChanges(TypedDict, total=False):
    """Changes of a Surface."""

    name: str
    reflectance: Row | ReflectanceChanges
    paint: Row | PaintChanges
    two_sided: bool
    levels: int | None
    diffuse: float
    specular: float
    model: str | Row
    exponent: float
    base_reflectance: float | None
    refractive_index: float | None
    fresnel_curve: Sequence[Sequence[float]] | None
    roughness: float
    normal_reflectance: float
    object_color: str | Sequence[int]
    light_color: str | Sequence[int]
    blend: float
    light_percentage: float
    ramp: str | Sequence[str | Sequence[int]] | None


class ViewChanges(TypedDict, total=False):
    """Changes of a View."""

    eye: Sequence[float]
    direction: Sequence[float] | None
    target: Sequence[float] | None
    angle: float
    field_of_view: float


class NamedViewChanges(TypedDict, total=False):
    """Changes of a NamedView."""

    name: str
    view: Row | ViewChanges
    eye: Sequence[float]
    direction: Sequence[float] | None
    target: Sequence[float] | None
    angle: float
    field_of_view: float


class ScalarChanges(TypedDict, total=False):
    """Changes of a Scalar."""

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
    """Fields of a Scene besides its mesh, parts and surfaces."""

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
    front: Literal["x", "-x", "y", "-y"] | None
    views: Sequence[Row]
    scalar: Row | ScalarChanges | None
    name: str


class SceneChanges(SceneFields, total=False):
    """Changes of a Scene."""

    mesh: object
    parts: Sequence[Row]
    surfaces: Sequence[Row]
