"""Scalars: the numbers of a mesh, such as stress, and the row that says how a scalar colors the surfaces.

Paper: "Introduction": scalar variables such as stress on the surface of an object are shown in color.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, Floats
from autocolor.checks import LARGEST_COORDINATE, Color, Vector, nearest, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable, read_only
from autocolor.scene.color_scales import COLOR_SCALES, REVERSED
from autocolor.scene.columns import BarRange, Kind, Path, Problem, Row, Tier, column_of
from autocolor.scene.kinds import (
    UNORDERED,
    ColorKind,
    ColorsKind,
    Number,
    Whole,
    boolean,
    color,
    in_digits,
    number,
    require,
    text,
    vector,
)
from autocolor.scene.row_kinds import References, table_row

MOST_COLORS: Final = 256
"""Limit: colors of a scale."""


@dataclass(frozen=True)
class LimitsKind(Kind[tuple[float, float]]):
    """Two numbers within the range of float32, the second above the first."""

    def rule(self) -> str:
        return "must be two finite numbers, the second above the first"

    def accepted(self, value: Any) -> tuple[float, float]:
        require(not isinstance(value, UNORDERED))
        low, high = map(Number(at_least=-LARGEST_SINGLE, at_most=LARGEST_SINGLE).accepted, value)
        require(low < high)
        return low, high


@dataclass(frozen=True)
class PlaceKind(Kind[tuple[float, float]]):
    """Two numbers from 0 to 1."""

    def rule(self) -> str:
        return "must be two numbers from 0 to 1"

    def accepted(self, value: Any) -> tuple[float, float]:
        require(not isinstance(value, UNORDERED))
        x, y = map(Number(at_least=0, at_most=1).accepted, value)
        return x, y


@dataclass(frozen=True)
class EndColor(ColorKind):
    """The color of values beyond a limit. It has its own band, so adding or removing it changes levels."""

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return Tier.LEVELS if one is None or other is None else super().cost(one, other, own)


@dataclass(frozen=True)
class ScaleKind(Kind[str | tuple[Color, ...]]):
    """The name of a color scale, or a list of at least two colors, also as a text with commas."""

    def rule(self) -> str:
        return "must be the name of a color scale, or a list of 2 to 256 colors"

    def accepted(self, value: Any) -> str | tuple[Color, ...]:
        if isinstance(value, str):
            require(value in COLOR_SCALES)
            return value
        return ColorsKind(MOST_COLORS).accepted(value)

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        if isinstance(value, str) and "," in value:
            return ColorsKind(MOST_COLORS).validated(value, path, problems)
        return super().validated(value, path, problems)

    def advice(self, value: object) -> str:
        if not isinstance(value, str):
            return ""
        forward = (name for name in COLOR_SCALES if not name.endswith(REVERSED))
        return nearest(value, COLOR_SCALES) or nearest(value, forward)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: value if isinstance(value, str) else [in_digits(color) for color in value]}


MOST_BANDS: Final = 256
"""Limit: bands, and levels of a band."""

UP: Final = (0.0, 0.0, 1.0)


@table_row
class Scalar(Row):
    """The scalar that colors the surfaces, its limits, bands and colors."""

    noun: ClassVar[str] = "scalar"

    name: str = text(
        tier=Tier.MIX, help="A scalar of the mesh, or a computed scalar such as 'mean curvature'."
    )
    limits: tuple[float, float] | None = column_of(
        LimitsKind(),
        default=None,
        tier=Tier.LEVELS,
        help="The start of the first band and the end of the last; if absent, the scalar's range.",
    )
    scale: str | tuple[Color, ...] = column_of(
        ScaleKind(),
        default="viridis",
        tier=Tier.ENTRIES,
        help="The color scale.",
    )
    bands: int = column_of(
        Whole(2, MOST_BANDS),
        default=16,
        bar=BarRange(2, 64, 1),
        tier=Tier.LEVELS,
        help="The number of colors.",
    )
    shades: int | None = column_of(
        Whole(1, MOST_BANDS),
        default=None,
        bar=BarRange(1, 16, 1),
        start=8,
        tier=Tier.LEVELS,
        help="The levels of each color; 1 for flat color codes. If absent, as many as fit, at most 8.",
    )
    below: Color | None = column_of(
        EndColor(),
        default=None,
        tier=Tier.ENTRIES,
        help="The color below the limits; if absent, the color of the first band.",
    )
    above: Color | None = column_of(
        EndColor(),
        default=None,
        tier=Tier.ENTRIES,
        help="The color above the limits; if absent, the color of the last band.",
    )
    missing: Color = color(default=(128, 128, 128), tier=Tier.ENTRIES, help="The color of missing values.")
    legend: bool = boolean(default=True, tier=Tier.NOTHING, help="Whether the display shows the legend.")
    legend_place: tuple[float, float] | None = column_of(
        PlaceKind(),
        default=None,
        tier=Tier.NOTHING,
        help="The place of the legend, from the left and from the top; if absent, the corner where it hides"
        " least.",
    )
    surfaces: tuple[str, ...] | None = column_of(
        References("surfaces"),
        default=None,
        tier=Tier.LEVELS,
        help="The surfaces that it colors; if absent, the surfaces of all parts but stage parts.",
    )
    direction: Vector = vector(
        default=UP,
        tier=Tier.MIX,
        help="The direction of distances, of the pull for draft angles, of up for slopes, or of stripes.",
    )
    stripes: float = number(
        default=12.0,
        at_least=1,
        at_most=1000,
        bar=BarRange(1, 60, 1),
        tier=Tier.MIX,
        help="The number of zebra stripes in half a turn.",
    )


NODE: Final = "node"
POLYGON: Final = "polygon"

MOST_SCALARS: Final = 1000
"""Limit: scalars of a mesh."""

LARGEST_SCALAR: Final = LARGEST_COORDINATE


@dataclass(frozen=True, eq=False, repr=False)
class MeshScalar(Immutable):
    """A scalar of a mesh: `values`, (n,) float64, for the rows of the table `of`, "node" or "polygon".

    NaN is a missing value; the size of all other values is at most 1e30. The values are copied unless they
    are a read-only array of this type. Raises InputError.
    """

    name: str
    values: Floats
    of: str = NODE

    def __post_init__(self) -> None:
        problems = []
        if not isinstance(self.name, str) or not self.name:
            problems.append(f"a scalar must have a name, not {shown(self.name)}; give it a name")
        label = f"scalar {shown(self.name)}"
        if self.of not in (NODE, POLYGON):
            problems.append(f"{label}: it must be of 'node' or 'polygon', not {shown(self.of)}; choose one")
        values = np.asarray(self.values)
        if values.dtype.kind not in "iuf" or values.ndim != 1:
            problems.append(
                f"{label}: its values must be numbers in one dimension, not {values.dtype} of shape"
                f" {values.shape}; convert them"
            )
        else:
            if values.dtype != np.float64 or values.flags.writeable:
                values = read_only(np.array(values, np.float64))
            # Comparisons with NaN are false, without a warning.
            is_endless = (values > LARGEST_SCALAR) | (values < -LARGEST_SCALAR)
            if is_endless.any():
                row = is_endless.argmax()
                rule = "a value must be at most 1e30 in size, or NaN if it is missing"
                problems.append(f"{label}: {rule}, not {values[row]:g} (row {row})")
        if problems:
            raise InputError(problems)
        object.__setattr__(self, "values", values)


def scalar_problems(scalars: Sequence[MeshScalar], nodes: int, polygons: int) -> Iterator[str]:
    """The problems of the scalars of a mesh; `nodes` and `polygons` are its counts."""
    names: set[str] = set()
    counts = {NODE: nodes, POLYGON: polygons}
    for scalar in scalars:
        if scalar.name in names:
            yield f"scalar {scalar.name!r}: its name must be unique, not repeated; rename one"
        names.add(scalar.name)
        if len(scalar.values) != counts[scalar.of]:
            yield (
                f"scalar {scalar.name!r}: there must be one value a {scalar.of} ({counts[scalar.of]}), not"
                f" {len(scalar.values)}"
            )


def joined_scalars(
    scalars: Sequence[Sequence[MeshScalar]], nodes: Sequence[int], polygons: Sequence[int]
) -> tuple[MeshScalar, ...]:
    """The scalars of a mesh that is joined of several meshes; `nodes` and `polygons` are the meshes' counts.

    If a mesh lacks a scalar, its values are missing. If a scalar belongs to the nodes of a mesh, and a scalar
    of the same name to the polygons of another mesh, the second gets a name like "stress of polygons".
    """
    kinds = dict.fromkeys((scalar.name, scalar.of) for of_mesh in scalars for scalar in of_mesh)
    names: dict[str, tuple[str, str]] = {}
    for name, of in kinds:
        names[name if name not in names else f"{name} of {of}s"] = (name, of)
    joined = []
    for name, key in names.items():
        counts = nodes if key[1] == NODE else polygons
        values = []
        for count, of_mesh in zip(counts, scalars, strict=True):
            present = {(scalar.name, scalar.of): scalar.values for scalar in of_mesh}
            values.append(present[key] if key in present else np.full(count, np.nan))
        joined.append(MeshScalar(name, read_only(np.concatenate(values)), key[1]))
    return tuple(joined)


COMPUTED: Final = (
    "x",
    "y",
    "z",
    "distance",
    "slope",
    "draft angle",
    "mean curvature",
    "gaussian curvature",
    "largest curvature",
    "smallest curvature",
    "zebra",
)
"""The names of the scalars that `autocolor.scalars` computes for any mesh.

Assumed: a scalar of the mesh hides a computed scalar of the same name, because a user who names it means the
numbers of the file.
"""
