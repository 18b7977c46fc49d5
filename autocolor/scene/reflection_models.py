"""Reflection models: the specular factor at a point, as a function of cosines between unit vectors.

Paper: Figure 2. light(j) = intensity(j) (D cos(I) + S cos^N(E)). The diffuse term is cos(I) under every
model. The specular factor takes the place of cos^N(E), without S. It is 1 where light and eye are both in the
direction of the normal, so that S means the same under every model.

A model is a row: its parameters and one function of cosines. To add a model, write its class and name it in
`MODELS` at the foot.

N is the normal, L the direction to the light, V the direction to the eye, R = 2 (N.V) N - V the reflected
view, and H the unit vector halfway between L and V. Given N.L, N.V and cos(E) = L.R, the other cosines are

    L.V = 2 (N.V) (N.L) - cos(E)
    |L + V|^2 = 2 + 2 L.V
    N.H = (N.L + N.V) / |L + V|
    V.H = |L + V| / 2
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, ClassVar, Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    POWER_ERROR,
    ROUNDING,
    SPARSE,
    ExactLogarithms,
    Indices,
    Singles,
    dot,
    half_logarithms,
    least_steep,
    power,
    underflowing,
)
from autocolor.scene.columns import BarRange, Column, Problem, Row, Tier
from autocolor.scene.kinds import AngleCurve, AngleCurveKind, Number
from autocolor.scene.row_kinds import Nested

LEAST_ALONG: Final = np.float32(1e-6)
"""The least N.L + N.V to divide by, at the rim of what light and eye both reach."""


class ExactVectors(NamedTuple):
    """Vectors at the points, as exact as the points are, for places where the rounding of cosines counts.

    cos(E) is off by at most `rounding`. `mirror_difference` returns L - R and `normal` N, (3, k) float32, at
    k places of the points.
    """

    rounding: float
    mirror_difference: Callable[[Indices], Singles]
    normal: Callable[[Indices], Singles]

    def eye(self) -> ExactLogarithms:
        """log(cos(E)) near 1."""
        return ExactLogarithms(self.rounding, self._logarithms)

    def _logarithms(self, places: Indices) -> Singles:
        """log(cos(E)) at some places. For the chord c of E, the square of the sine is c^2 - c^4 / 4.

        Where the angle is small, a reflected view that is rounded to another length hardly changes the chord,
        but it changes a dot product.
        """
        apart = self.mirror_difference(places)
        square: Singles = dot(apart, apart)
        square -= square * square / 4
        return half_logarithms(square)

    def squared_half_tangent(self, places: Indices, incidence: Singles) -> Singles:
        """tan^2 of the angle between N and H at some places of the points, given N.L at all points.

        R is V reflected at N. So at right angles to N, L + V is L - R, and along N it is N.L + N.R.
        """
        apart = self.mirror_difference(places)
        excess = dot(apart, self.normal(places))
        square: Singles = dot(apart, apart)
        square -= excess * excess
        along = 2 * incidence.take(places)
        along -= excess
        np.maximum(along, LEAST_ALONG, out=along)
        square /= along * along
        return np.maximum(square, 0, out=square)


class Cosines(NamedTuple):
    """The cosines at some points, (points,) float32 each, -1 to 1 up to rounding.

    `incidence` is N.L, `eye` is cos(E). `view()` computes N.V, which not every model needs. Without `exact`
    vectors the cosines count as exact.
    """

    incidence: Singles
    eye: Singles
    view: Callable[[], Singles]
    exact: ExactVectors | None = None


class ReflectionModel(Row):
    """A reflection model with its parameters; equal values give equal pictures."""

    @property
    def largest(self) -> float:
        """An upper bound of the specular factor."""
        return 1.0

    def specular(self, cosines: Cosines, out: Singles) -> Singles:
        """The specular factor, written to `out`, which may be one of the arrays of cosines.

        It is finite and at least 0 for any cosines, and used where N.L > 0.
        """
        raise NotImplementedError


LEAST_REFLECTANCE: Final = 0.001
"""Assumed: the least F(0) to divide by; a refractive index of 1.065 has it."""

LEAST_INDEX: Final = 1.07
"""The least refractive index, rounded up, so that F(0) is above LEAST_REFLECTANCE."""

START_CURVE: Final = ((0.0, 0.04), (50.0, 0.06), (70.0, 0.17), (80.0, 0.39), (90.0, 1.0))
"""The initial curve: the reflectance of glass, whose refractive index is 1.5."""


@dataclass(frozen=True, repr=False)
class SpecularGrowth(Row):
    """How S grows with the angle of incidence I: a factor of the specular plane, 1 at normal incidence.

    Paper: "The Lighting Model". For a more accurate rendering, S should be a function of the angle of
    incidence as well as of the material. Departs: S is constant, as in Figure 2, unless a surface asks for
    more. Then S is multiplied by F(I) / F(0), where F is a curve through points, or Schlick's F0 + (1 - F0)
    (1 - cos(I))^5 (C. Schlick, Computer Graphics Forum, 1994). F0 is the share that the material reflects at
    normal incidence: given, or ((n - 1) / (n + 1))^2 for its refractive index n.

    F is divided by F(0) so that S means the same under every model, and light from straight ahead is
    reflected as without growth: with Schlick's F alone, the 0.04 of glass would leave no highlight there. The
    factor belongs to the plane, not to S: S stays a weight, and its edit a weighted sum.
    """

    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("base_reflectance",),
        ("refractive_index",),
        ("fresnel_curve",),
    )

    base_reflectance: Annotated[
        float | None,
        Column(
            Number(LEAST_REFLECTANCE, 1),
            Tier.LIGHT,
            "F0: the share reflected at normal incidence; the smaller, the more S grows.",
            bar=BarRange(0.01, 1, 0.01),
            start=0.04,
        ),
    ] = None
    refractive_index: Annotated[
        float | None,
        Column(
            Number(LEAST_INDEX, 10),
            Tier.LIGHT,
            "The refractive index, which determines F0: S grows with the angle of incidence.",
            bar=BarRange(1.1, 4, 0.01),
            start=1.5,
        ),
    ] = None
    fresnel_curve: Annotated[
        AngleCurve | None,
        Column(
            AngleCurveKind(LEAST_REFLECTANCE, START_CURVE),
            Tier.LIGHT,
            "Points [angle in degrees, reflected share]; S grows with the share.",
        ),
    ] = None

    def rules(self) -> Iterator[Problem]:
        """At most one of the three columns is given."""
        given = [name for (name,) in self.alternatives if vars(self)[name] is not None]
        for first, second in combinations(given, 2):
            yield Problem((second,), f"must stand without {first}, not beside it; leave one out")

    @property
    def normal_reflectance(self) -> float | None:
        """F0 of Schlick's factor, given or from the refractive index; None for a curve or a constant S."""
        if self.refractive_index is not None:
            return ((self.refractive_index - 1) / (self.refractive_index + 1)) ** 2
        return self.base_reflectance

    @property
    def largest(self) -> float:
        """The largest factor."""
        if self.fresnel_curve is not None:
            shares = [share for _, share in self.fresnel_curve]
            return max(shares) / shares[0]
        f0 = self.normal_reflectance
        return 1.0 if f0 is None else 1 / f0

    def factor(self, incidence: Singles) -> Singles | None:
        """F(I) / F(0) at some cosines of I, in a new array; None if S is constant.

        Cosines below 0 count as 0, and above 1 as 1.
        """
        if self.fresnel_curve is not None:
            # Near normal incidence, an arc cosine of float32 has few digits.
            angles = np.degrees(np.arccos(np.clip(incidence, 0, 1, dtype=np.float64)))
            xs, ys = zip(*self.fresnel_curve, strict=True)
            factor: Singles = (np.interp(angles, xs, ys) / ys[0]).astype(np.float32)
            return factor
        f0 = self.normal_reflectance
        return None if f0 is None else _schlick(incidence, f0)


def _schlick(incidence: Singles, f0: float) -> Singles:
    """1 + (1 / F0 - 1) (1 - cos(I))^5 at some cosines."""
    factor: Singles = 1 - incidence
    np.clip(factor, np.float32(0), np.float32(1), out=factor)
    once = factor.copy()
    factor *= factor
    factor *= factor
    factor *= once
    factor *= np.float32(1 / f0 - 1)
    factor += 1
    return factor


CONSTANT: Final = SpecularGrowth()
"""An S that does not depend on the angle of incidence."""


@dataclass(frozen=True, repr=False)
class _PowerOfCosine(ReflectionModel):
    """The models that raise a cosine to N. S may grow with the angle of incidence."""

    exponent: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.LIGHT,
            "N: the exponent, which makes the highlight narrower; exact to 1e-4 up to 100,000.",
            bar=BarRange(1, 200, 1),
        ),
    ] = 20.0

    growth: Annotated[
        SpecularGrowth,
        Column(Nested(SpecularGrowth, inline=True), Tier.LIGHT, "How S grows with the angle of incidence."),
    ] = CONSTANT

    @property
    def largest(self) -> float:
        """The largest factor of the growth; the power of a cosine is at most 1."""
        return self.growth.largest


@dataclass(frozen=True, repr=False)
class Phong(_PowerOfCosine):
    """cos^N(E). Paper: Figure 2."""

    @underflowing
    def specular(self, cosines: Cosines, out: Singles) -> Singles:
        """cos^N(E), times the growth of S; a negative cosine counts as 0."""
        # Most surfaces reflect some of the lights away from the eye.
        if 0 < self.exponent <= SPARSE and cosines.eye.max(initial=0.0) <= 0:
            out[:] = 0
            return out
        growth = self.growth.factor(cosines.incidence)
        exact = cosines.exact and cosines.exact.eye()
        return _grown(power(cosines.eye, self.exponent, out, exact), growth)


@dataclass(frozen=True, repr=False)
class BlinnPhong(_PowerOfCosine):
    """cos^N of the angle between normal and half vector. Departs: J. Blinn, SIGGRAPH 1977, not Figure 2."""

    @underflowing
    def specular(self, cosines: Cosines, out: Singles) -> Singles:
        """(N.H)^N, times the growth of S; a negative cosine counts as 0."""
        half = _half_vector(cosines.incidence, cosines.view(), cosines.eye)
        growth = self.growth.factor(cosines.incidence)
        steep = _steep_half(half, cosines, self.exponent)
        power(half.normal, self.exponent, out=out)
        if steep is not None:
            out[steep.places] = np.exp(-self.exponent / 2 * np.log1p(steep.squared_tangent))
        return _grown(out, growth)


LEAST_FACING: Final = 0.3
"""Assumed: the least N.V to divide by; otherwise a silhouette would far outshine its surface.

Measured on a sphere and on the coupe, roughness 0.3: with light from the front and from the side the largest
factor is 1.0 and 2.8, at N.V above 0.5 whatever the bound. With light from behind to one side it is 47 at N.V
0.1 without a bound, 21 with this one, and 19 among points with N.V above 0.3; from straight behind 1005, 59
and 18.
"""

LEAST_SQUARE: Final = np.float32(1e-6)
"""The least |L + V|^2, above the rounding of float32; only where L and V are opposite is it less."""


@dataclass(frozen=True, repr=False)
class CookTorrance(ReflectionModel):
    """F D G / (N.V) over its value at normal incidence and view.

    Departs: R. Cook and K. Torrance, SIGGRAPH 1981, not Figure 2: Beckmann's distribution D, whose slope m is
    `roughness`; their geometric attenuation G; and their Fresnel term F for the index of refraction that
    reflects `normal_reflectance`, F0, at normal incidence.
    """

    roughness: Annotated[
        float,
        Column(
            Number(0.01, 1),
            Tier.LIGHT,
            "The roughness: m, the slope of the microfacets; exact to 1e-4 from 0.02.",
            bar=BarRange(0.01, 1, 0.01),
        ),
    ] = 0.3
    normal_reflectance: Annotated[
        float,
        Column(
            Number(0.001, 1),
            Tier.LIGHT,
            "F0: the share reflected at normal incidence.",
            bar=BarRange(0.01, 1, 0.01),
        ),
    ] = 0.05

    @property
    def largest(self) -> float:
        """The factor if F and G were 1 and D at its maximum, which is 4 / e for a roughness of 1."""
        return 4 / math.e / self.normal_reflectance / LEAST_FACING

    @underflowing
    def specular(self, cosines: Cosines, out: Singles) -> Singles:
        """F D G / (N.V), relative to normal incidence and view."""
        view = cosines.view()
        half = _half_vector(cosines.incidence, view, cosines.eye)
        fresnel = self._fresnel(half.view)
        gain = float(fresnel.max(initial=1)) / max(float(view.min(initial=1)), LEAST_FACING)
        attenuation = _attenuation(cosines.incidence, view, half)
        np.multiply(self._distribution(half, cosines, gain), fresnel, out=out)
        out *= attenuation
        out /= np.maximum(view, np.float32(LEAST_FACING))
        return out

    def _distribution(self, half: _HalfVector, cosines: Cosines, gain: float) -> Singles:
        """Beckmann's D over its value at cos 1: exp(-(tan / m)^2) / cos^4.

        Its error is multiplied by at most `gain`.
        """
        square = np.maximum(half.normal * half.normal, np.float32(1e-4))
        tangent = (1 - square) / square
        tangent /= np.float32(-self.roughness * self.roughness)
        distribution: Singles = np.exp(tangent, out=tangent)
        distribution /= square * square
        # Near a cosine of 1, D falls like the cosine to the power 2 / m^2.
        steep = _steep_half(half, cosines, 2 / self.roughness**2, POWER_ERROR / gain)
        if steep is not None:
            places, squares = steep
            distribution[places] = np.exp(-squares / self.roughness**2) * (1 + squares) ** 2
        return distribution

    def _fresnel(self, cosine: Singles) -> Singles:
        """F over F0, for unpolarized light at a cosine of incidence on a half vector."""
        root = math.sqrt(self.normal_reflectance)
        if root == 1:
            return np.ones_like(cosine)
        index = np.float32((1 + root) / (1 - root))
        g = np.sqrt(cosine * cosine + (index * index - 1))
        first = (g - cosine) / (g + cosine)
        second = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)
        fresnel: Singles = first * first * (1 + second * second)
        fresnel *= np.float32(0.5 / self.normal_reflectance)
        return fresnel


def _grown(factor: Singles, growth: Singles | None) -> Singles:
    """A specular factor times the growth of S, in its own array; unchanged if S is constant."""
    return factor if growth is None else np.multiply(factor, growth, out=factor)


class _HalfVector(NamedTuple):
    """The cosines of the half vector with the normal and with the direction to the eye."""

    normal: Singles
    view: Singles


def _half_vector(incidence: Singles, view: Singles, eye: Singles) -> _HalfVector:
    """N.H and V.H, given N.L, N.V and cos(E); both 0 to 1."""
    square = view * incidence
    square *= 4
    square -= 2 * eye
    square += 2
    np.clip(square, LEAST_SQUARE, np.float32(4), out=square)
    length = np.sqrt(square, out=square)
    normal = incidence + view
    normal /= length
    np.clip(normal, np.float32(0), np.float32(1), out=normal)
    length *= np.float32(0.5)
    return _HalfVector(normal, length)


ROUNDING_OF_HALF: Final = 2 * ROUNDING
"""Assumed: the rounding of N.H itself, above that of cos(E) divided by |L + V|^2."""


class _SteepHalf(NamedTuple):
    """Some places of the points, and tan^2 of the angle between N and H there, (places,)."""

    places: Indices
    squared_tangent: Singles


def _steep_half(
    half: _HalfVector, cosines: Cosines, exponent: float, error: float = POWER_ERROR
) -> _SteepHalf | None:
    """Where the rounding of N.H may put (N.H)^exponent off by more than an error; None if nowhere.

    N.H is off by the rounding of cos(E) over |L + V|^2, which is 4 (V.H)^2, so that it is worst at glancing
    angles, and by that of its own quotient.
    """
    if cosines.exact is None or exponent == 0:
        return None
    rounding, view = cosines.exact.rounding, half.view
    worst = ROUNDING_OF_HALF + rounding / (4 * float(view.min(initial=1)) ** 2)
    if exponent * worst <= error:
        return None
    steep = half.normal > np.float32(least_steep(exponent, worst, error))
    least = ROUNDING_OF_HALF + rounding / 4
    if exponent * least <= error:
        steep &= view * view < np.float32(rounding / 4 / (error / exponent - ROUNDING_OF_HALF))
    places = steep.nonzero()[0]
    if not len(places):
        return None
    return _SteepHalf(places, cosines.exact.squared_half_tangent(places, cosines.incidence))


def _attenuation(incidence: Singles, view: Singles, half: _HalfVector) -> Singles:
    """G, the share that no microfacet shadows: min(1, 2 (N.H) (N.V) / V.H, 2 (N.H) (N.L) / V.H)."""
    attenuation: Singles = np.minimum(incidence, view)
    attenuation *= half.normal
    attenuation *= 2
    attenuation /= half.view
    return np.clip(attenuation, np.float32(0), np.float32(1), out=attenuation)


MODELS: Final[dict[str, type[ReflectionModel]]] = {
    "phong": Phong,
    "blinn": BlinnPhong,
    "cook-torrance": CookTorrance,
}
"""Every reflection model by the name that a scene gives it."""
