"""Array types, named by their meaning, and the array operations that several wings use.

A run is an arithmetic series of whole numbers: the lines of an edge, or the pixels of a segment. Arrays of
vectors are (3, n), a row for each axis, because numpy is fast on long rows.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

Singles = NDArray[np.float32]
"""Intensities, cosines, and everything else that is stored for each pixel."""

Floats = NDArray[np.float64]
"""Coordinates, and numbers computed from them that are not yet stored for pixels."""

Indices = NDArray[np.intp]
"""Row numbers of tables, counts of rows, and places in a raster; the type of numpy's indices."""

Numbers = NDArray[np.int64]
"""Whole numbers to calculate with: depth keys, runs."""

Booleans = NDArray[np.bool_]
"""Truth values of rows, pixels or polygons."""

Bytes = NDArray[np.uint8]
"""Surface numbers, components of colors, bytes of files."""

RasterPlaces = NDArray[np.int16]
"""Lines and elements of a raster, numbered below 16,384."""

PartNumbers = NDArray[np.int32]
"""Part numbers. A mesh may have more than 65,536 parts."""

LowBits = NDArray[np.uint32]
"""The low bits of hashes."""

Words = NDArray[np.uint16]
"""Words of the display."""

AnyArray = NDArray[Any]
"""An array whose element type is not known, or is checked elsewhere."""

Real = TypeVar("Real", np.float32, np.float64)

RealArray = NDArray[Real]
"""An array of either type of floating-point numbers."""

LARGEST_SINGLE: Final = float(np.finfo(np.float32).max)

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def underflowing(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, in which numbers too small for their type become 0, whatever `np.seterr` says.

    Light far from a highlight, and products of small coordinates, are expected to underflow.
    """

    @functools.wraps(function)
    def silent(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
        with np.errstate(under="ignore"):
            return function(*args, **kwargs)

    return silent


HALF: Final = 0.5
"""Added before taking the floor: rounding half up is the only rounding rule of the package."""

MOST_MULTIPLIED: Final = 64
"""The largest exponent for which repeated squaring is exact to 1e-5."""

NUMBERS_AT_ONCE: Final = 1 << 16

ROUNDING: Final = float(np.finfo(np.float32).eps)
"""A unit in the last place of 1 in float32."""

SPARSE: Final = 200.0
"""Above this exponent, powers that are negligible become 0, and if few are left, only these are computed."""

NEGLIGIBLE: Final = 16.0
"""Powers below exp(-NEGLIGIBLE), which is the rounding of 1 in float32, are negligible."""

FEW: Final = 0.3
"""The fraction of powers that are not negligible up to which it takes less time to compute only these."""


def runs(first: Numbers, count: Numbers, step: Numbers | None = None) -> Numbers:
    """The runs `first`, `first` + `step`, ... of `count` numbers, joined to an array, (numbers,) int64.

    The arguments are (runs,) int64. A count is at least 1, and `step` is 1 by default. A single cumulative
    sum gives all runs. It is exact, because int64 wraps around: an overflow is undone by a later jump.

    >>> runs(np.array([5, 1]), np.array([3, 2])).tolist()
    [5, 6, 7, 1, 2]
    """
    heads = np.cumsum(count) - count
    total = int(heads[-1] + count[-1]) if len(count) else 0
    # The sum jumps from the last number of a run to the first number of the next run.
    jump = first.copy()
    if step is None:
        numbers = np.ones(total, np.int64)
        jump[1:] -= first[:-1] + count[:-1] - 1
    else:
        numbers = np.repeat(step, count)
        jump[1:] -= first[:-1] + (count[:-1] - 1) * step[:-1]
    numbers[heads] = jump
    return np.cumsum(numbers, out=numbers)


def chunks(end: int, most: int, start: int = 0) -> Iterator[slice]:
    """The numbers from `start` to before `end`, in slices of at most `most`.

    >>> list(chunks(5, 3))
    [slice(0, 3, None), slice(3, 5, None)]
    """
    for first in range(start, end, most):
        yield slice(first, min(first + most, end))


def chunks_of_runs(count: Numbers, most: int) -> Iterator[tuple[slice, slice]]:
    """Chunks of whole runs with about `most` numbers: a slice of the runs, and a slice of their numbers.

    >>> list(chunks_of_runs(np.array([3, 2, 4]), 5))
    [(slice(0, 2, None), slice(0, 5, None)), (slice(2, 3, None), slice(5, 9, None))]
    """
    ends = np.cumsum(count)
    first, base = 0, 0
    while first < len(ends):
        last = max(first + 1, int(np.searchsorted(ends, base + most, side="right")))
        end = int(ends[last - 1])
        yield slice(first, last), slice(base, end)
        first, base = last, end


def least_of_four(rows: AnyArray | Sequence[AnyArray]) -> AnyArray:
    """The least of four rows. Measured: a reduction over the short axis takes ten times as long."""
    least: AnyArray = np.minimum(np.minimum(rows[0], rows[1]), np.minimum(rows[2], rows[3]))
    return least


def most_of_four(rows: AnyArray) -> AnyArray:
    """The most of four rows."""
    most: AnyArray = np.maximum(np.maximum(rows[0], rows[1]), np.maximum(rows[2], rows[3]))
    return most


def dot(one: RealArray[Real], other: RealArray[Real]) -> RealArray[Real]:
    """The dot products of the vectors in two arrays, both (3, n).

    >>> dot(np.array([[2.0], [3.0], [6.0]]), np.array([[1.0], [0.0], [0.5]])).tolist()
    [5.0]
    """
    products: RealArray[Real] = np.einsum("ij,ij->j", one, other)
    return products


def cross(one: Floats, other: Floats) -> Floats:
    """The cross products of the vectors in two arrays, both (3, ...).

    Measured: `np.cross` and `np.linalg.norm` of a million rows of three numbers take five times as long.

    >>> cross(np.array([[1.0], [0.0], [0.0]]), np.array([[0.0], [1.0], [0.0]])).ravel().tolist()
    [0.0, 0.0, 1.0]
    """
    products = np.empty_like(one)
    for axis, product in enumerate(products):
        after, before = (axis + 1) % 3, (axis + 2) % 3
        np.multiply(one[after], other[before], out=product)
        product -= one[before] * other[after]
    return products


def bounds_of(points: Floats) -> tuple[Floats, Floats]:
    """The least and the largest coordinates of points, (n, 3); zeros if there are none.

    >>> low, high = bounds_of(np.array([[1.0, 5.0, 0.0], [2.0, 3.0, 0.0]]))
    >>> low.tolist(), high.tolist()
    ([1.0, 3.0, 0.0], [2.0, 5.0, 0.0])
    """
    if not len(points):
        return np.zeros(3), np.zeros(3)
    rows = points.T
    return rows.min(axis=1), rows.max(axis=1)


def used_rows(numbers: Indices, count: int) -> Booleans:
    """Whether each of `count` rows is in `numbers`, (k, n). The numbers are not copied as a whole.

    >>> used_rows(np.array([[0, 3], [1, 3]]), 5).tolist()
    [True, True, False, True, False]
    """
    used = np.zeros(count, np.bool_)
    for chunk in chunks(numbers.shape[1], NUMBERS_AT_ONCE):
        used[numbers[:, chunk]] = True
    return used


def used_bounds(rows: Floats, numbers: Indices) -> tuple[Floats, Floats]:
    """The least and the largest value of each row, (k, count), in some columns; infinite without columns.

    `numbers` has the numbers of the columns.

    >>> low, high = used_bounds(np.array([[5.0, 2.0, 3.0]]), np.array([[0, 2]]))
    >>> low.tolist(), high.tolist()
    ([3.0], [5.0])
    """
    used = used_rows(numbers, rows.shape[1])
    low: Floats = rows.min(axis=1, where=used, initial=np.inf)
    high: Floats = rows.max(axis=1, where=used, initial=-np.inf)
    return low, high


def lengths(vectors: Floats) -> Floats:
    """The length of each vector of (3, ...).

    >>> lengths(np.array([[2.0, 0.0], [3.0, 0.0], [6.0, 1.0]])).tolist()
    [7.0, 1.0]
    """
    squares: Floats = (vectors * vectors).sum(axis=0)
    return np.sqrt(squares, out=squares)


def unit_vector(direction: tuple[float, float, float]) -> tuple[float, float, float]:
    """The unit vector of a direction, which must not be zero.

    >>> unit_vector((0.0, 3e36, 4e36))
    (0.0, 0.6, 0.8)
    """
    # Divide by the largest component first: the squares of very large or small components would over- or
    # underflow.
    largest = max(abs(component) for component in direction)
    scaled = tuple(component / largest for component in direction)
    length = math.hypot(*scaled)
    return (scaled[0] / length, scaled[1] / length, scaled[2] / length)


def normalized(vectors: Floats) -> Floats:
    """The vectors, (3, ...), divided by their lengths; zero vectors stay zero.

    >>> normalized(np.array([[2.0, 0.0], [3.0, 0.0], [6.0, 0.0]])).T.tolist()[1]
    [0.0, 0.0, 0.0]
    """
    sizes = lengths(vectors)
    sizes[sizes == 0] = 1.0
    return vectors / sizes


def columns(rows: RealArray[Real], places: Indices) -> RealArray[Real]:
    """Some columns of an array, (rows, places).

    Measured: `take` along the second axis of an array that is not contiguous copies the whole array first. An
    index of both axes takes half of the time of this for ten places, and four times as long for thousands.
    """
    return np.array([row.take(places) for row in rows])


def power(cosines: RealArray[Real], exponent: float) -> RealArray[Real]:
    """The cosines to a power, in [0, 1]; negative cosines count as 0, and every cosine to the power 0 is 1.

    >>> power(np.array([0.5, -1.0, 1.0], np.float32), 2).tolist()
    [0.25, 0.0, 1.0]

    Measured, with the exponential of a logarithm as the unit: `np.power` takes 2; repeated squaring takes
    0.5; finding that all powers are negligible takes 0.1. A clip takes a quarter of the time of a minimum and
    a maximum.
    """
    if exponent > SPARSE:
        # Above an exponent of 1e9 or so, only a cosine of 1 counts.
        counts = cosines >= 1 - NEGLIGIBLE / exponent
        count = np.count_nonzero(counts)
        if count <= FEW * len(cosines):
            few = np.zeros_like(cosines)
            few[counts] = _power(cosines[counts], exponent)
            return few
    elif cosines.dtype.type(exponent) > 0 and cosines.max(initial=0.0) <= 0:
        # Most surfaces reflect some of the lights away from the eye.
        return np.zeros_like(cosines)
    return _power(cosines, exponent)


def _power(cosines: RealArray[Real], exponent: float) -> RealArray[Real]:
    """As `power`, for all cosines alike."""
    if cosines.dtype.type(min(exponent, LARGEST_SINGLE)) == 0:
        return np.ones_like(cosines)
    # Rounding may leave a cosine above 1. A large exponent would make it very bright.
    powers = np.clip(cosines, 0, 1)
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        if exponent <= MOST_MULTIPLIED and exponent == int(exponent):
            return _multiplied(powers, int(exponent))
        np.log(powers, out=powers)
        powers *= min(exponent, LARGEST_SINGLE)
        return np.exp(powers, out=powers)


def _multiplied(out: RealArray[Real], exponent: int) -> RealArray[Real]:
    """The numbers to a whole power of at least 1, in place, by repeated squaring."""
    powers: RealArray[Real] | None = None
    while exponent > 1:
        if exponent & 1:
            powers = out.copy() if powers is None else np.multiply(powers, out, out=powers)
        np.multiply(out, out, out=out)
        exponent >>= 1
    return out if powers is None else np.multiply(out, powers, out=out)


def half_up(value: float) -> int:
    """The nearest integer; halves are rounded up.

    >>> half_up(2.5), half_up(-2.5)
    (3, -2)
    """
    return math.floor(value + HALF)


def halves_up(values: Singles, out: Singles | None = None) -> Singles:
    """The nearest integers of an array, as float32; halves are rounded up. `out` may be `values`."""
    rounded = np.add(values, np.float32(HALF), out=out)
    return np.floor(rounded, out=rounded)


# Components of colors, and their light as a fraction of the light of white.


def light_of(components: Floats) -> Floats:
    """The light of components of colors, 0 to 255, whole or not: 0 to 1.

    Assumed: monitors show colors as sRGB does, IEC 61966-2-1. The mean of the components themselves would
    make the edges of bright surfaces too dark.
    """
    shares = components / 255
    light: Floats = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return light


def components_of(light: Floats) -> Bytes:
    """The components of colors for light, 0 to 1: uint8, rounded half up."""
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    components: Bytes = np.floor(encoded * 255 + HALF).astype(np.uint8)
    return components
