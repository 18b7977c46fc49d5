"""Scalars: the numbers of a mesh, such as stress, and the row that says how one of them is shown in color.

Paper: "Introduction": scalar variables such as stress on the surface of an object are shown in color.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, Floats
from autocolor.checks import LARGEST_COORDINATE, Color, Vector, nearest, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable, read_only
from autocolor.scene.color_scales import COLOR_SCALES, REVERSED
from autocolor.scene.columns import BarRange, Column, Kind, Problem, Row, Tier
from autocolor.scene.kinds import (
    UNORDERED,
    Boolean,
    ColorKind,
    Number,
    Text,
    VectorKind,
    Whole,
    in_digits,
    require,
)
from autocolor.scene.row_kinds import References

MOST_COLORS: Final = 256
"""Limit: colors of a scale."""


@dataclass(frozen=True)
class LimitsKind(Kind):
    """Two numbers of float32, the second above the first."""

    def rule(self) -> str:
        return "must be two finite numbers, the second above the first"

    def accepts(self) -> str:
        return "Sequence[float]"

    def accepted(self, value: Any) -> tuple[float, float]:
        require(not isinstance(value, UNORDERED))
        low, high = map(Number(at_least=-LARGEST_SINGLE, at_most=LARGEST_SINGLE).accepted, value)
        require(low < high)
        return low, high

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: list(value)}


@dataclass(frozen=True)
class EndColor(ColorKind):
    """The color of values beyond a limit. It is a band of its own: with it, or without it, levels change."""

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return Tier.LEVELS if one is None or other is None else super().cost(one, other, own)


@dataclass(frozen=True)
class ScaleKind(Kind):
    """The name of a color scale, or a list of at least two colors."""

    def rule(self) -> str:
        return "must be the name of a color scale, or a list of 2 to 256 colors"

    def accepts(self) -> str:
        return "str | Sequence[str | Sequence[int]]"

    def accepted(self, value: Any) -> str | tuple[Color, ...]:
        if isinstance(value, str):
            require(value in COLOR_SCALES)
            return value
        require(not isinstance(value, UNORDERED))
        colors = tuple(ColorKind().accepted(each) for each in value)
        require(2 <= len(colors) <= MOST_COLORS)
        return colors

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


@dataclass(frozen=True, repr=False)
class Scalar(Row):
    """The scalar that colors the surfaces, its limits, bands and colors."""

    noun: ClassVar[str] = "scalar"

    name: Annotated[
        str,
        Column(Text(), Tier.MIX, "A scalar of the mesh, or a computed scalar such as 'mean curvature'."),
    ]
    limits: Annotated[
        tuple[float, float] | None,
        Column(
            LimitsKind(),
            Tier.LEVELS,
            "The start of the first band and the end of the last; if absent, the scalar's range.",
        ),
    ] = None
    scale: Annotated[
        str | tuple[Color, ...],
        Column(ScaleKind(), Tier.ENTRIES, "The color scale: a name, or a list of colors."),
    ] = "viridis"
    bands: Annotated[
        int, Column(Whole(2, MOST_BANDS), Tier.LEVELS, "The number of colors.", bar=BarRange(2, 64, 1))
    ] = 16
    shades: Annotated[
        int | None,
        Column(
            Whole(1, MOST_BANDS),
            Tier.LEVELS,
            "The levels of each color; 1 for flat color codes. If absent, as many as fit, at most 8.",
            bar=BarRange(1, 16, 1),
            start=8,
        ),
    ] = None
    below: Annotated[
        Color | None,
        Column(
            EndColor(),
            Tier.ENTRIES,
            "The color below the limits; if absent, the color of the first band.",
        ),
    ] = None
    above: Annotated[
        Color | None,
        Column(
            EndColor(),
            Tier.ENTRIES,
            "The color above the limits; if absent, the color of the last band.",
        ),
    ] = None
    missing: Annotated[Color, Column(ColorKind(), Tier.ENTRIES, "The color of missing values.")] = (
        128,
        128,
        128,
    )
    legend: Annotated[bool, Column(Boolean(), Tier.NOTHING, "Whether the display shows the legend.")] = True
    surfaces: Annotated[
        tuple[str, ...] | None,
        Column(
            References("surfaces"),
            Tier.LEVELS,
            "The surfaces that it colors; if absent, all surfaces that are not only of stage parts.",
        ),
    ] = None
    direction: Annotated[
        Vector,
        Column(
            VectorKind(has_length=True),
            Tier.MIX,
            "The direction of a distance, of a draft angle's pull, of up for a slope, or of stripes.",
        ),
    ] = UP
    stripes: Annotated[
        float,
        Column(
            Number(at_least=1, at_most=1000),
            Tier.MIX,
            "The number of zebra stripes in half a turn.",
            bar=BarRange(1, 60, 1),
        ),
    ] = 12.0


NODE: Final = "node"
POLYGON: Final = "polygon"

MOST_SCALARS: Final = 1000
"""Limit: scalars of a mesh."""

LARGEST_SCALAR: Final = LARGEST_COORDINATE


@dataclass(frozen=True, eq=False, repr=False)
class MeshScalar(Immutable):
    """A scalar of a mesh: `values`, (n,) float64, for the rows of the table `of`, "node" or "polygon".

    NaN is a missing value; all others are at most 1e30 in size. The values are copied unless they are a
    read-only array of this type. Raises InputError.
    """

    name: str
    values: Floats
    of: str = NODE

    def __post_init__(self) -> None:
        problems = []
        if not isinstance(self.name, str) or not self.name:
            problems.append(f"a scalar must have a name, not {shown(self.name)}; give it one")
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
            is_kept = values.dtype == np.float64 and not values.flags.writeable
            values = values if is_kept else read_only(np.array(values, np.float64))
            if problem := _endless(values):
                problems.append(f"{label}: {problem}")
        if problems:
            raise InputError(problems)
        object.__setattr__(self, "values", values)


def _endless(values: Floats) -> str | None:
    """The problem of the first value that is infinite or too large, or None."""
    # A comparison with NaN is false, and warns of nothing.
    rows = np.flatnonzero((values > LARGEST_SCALAR) | (values < -LARGEST_SCALAR))
    if not len(rows):
        return None
    found = values[rows[0]]
    return f"a value must be at most 1e30 in size, or NaN if it is missing, not {found:g} (row {rows[0]})"


def scalar_problems(scalars: Sequence[MeshScalar], nodes: int, polygons: int) -> Iterator[str]:
    """The problems of the scalars of a mesh with these numbers of nodes and polygons."""
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
    """The scalars of several meshes that are joined to one; `nodes` and `polygons` are their counts.

    A mesh without a scalar of some name has missing values. If a name is of nodes in one mesh and of polygons
    in another, the second scalar gets another name, as in "stress of polygons".
    """
    kinds = dict.fromkeys((scalar.name, scalar.of) for each in scalars for scalar in each)
    names: dict[str, tuple[str, str]] = {}
    for name, of in kinds:
        names[name if name not in names else f"{name} of {of}s"] = (name, of)
    joined = []
    for name, key in names.items():
        counts = nodes if key[1] == NODE else polygons
        found = [{(each.name, each.of): each.values for each in of_mesh}.get(key) for of_mesh in scalars]
        values = [
            np.full(count, np.nan) if each is None else each
            for count, each in zip(counts, found, strict=True)
        ]
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

Assumed: a scalar of the mesh hides a computed scalar of the same name, since the user means the numbers of
the file.
"""


def name_problems(name: str, scalars: Iterable[MeshScalar]) -> Iterator[Problem]:
    """The problem of the name of the scalar to show, given the scalars of the mesh."""
    known = [*(scalar.name for scalar in scalars), *COMPUTED]
    if name not in known:
        rule = "must be a scalar of the mesh or a computed one"
        yield Problem(("scalar", "name"), f"{rule}, not {shown(name)}{nearest(name, known)}")
