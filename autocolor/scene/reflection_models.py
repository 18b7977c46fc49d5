"""Reflection models: the specular factor at a point, as a function of cosines between unit vectors.

Paper: Figure 2. light(j) = intensity(j) (D cos(I) + S cos^N(E)). The diffuse term is cos(I) under every
model. The specular factor takes the place of cos^N(E), without S. It is 1 where light and eye are both in the
direction of the normal, so that S means the same under every model.

A model is a row: its parameters and one function of cosines, of any float type. To add a model, write its
class and name it in `MODELS` at the foot.

N is the normal, L the direction to the light, V the direction to the eye, R = 2 (N.V) N - V the reflected
view, and H the unit vector halfway between L and V. Given N.L, N.V and cos(E) = L.R, the other cosines are

    L.V = 2 (N.V) (N.L) - cos(E)
    |L + V|^2 = 2 + 2 L.V
    N.H = (N.L + N.V) / |L + V|
    V.H = |L + V| / 2
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import ClassVar, Final

import numpy as np

from autocolor.arrays import Real, RealArray, power
from autocolor.scene.columns import BarRange, Problem, Row, Tier, column_of
from autocolor.scene.kinds import AngleCurve, AngleCurveKind, number
from autocolor.scene.row_kinds import nested, table_row


class ReflectionModel(Row):
    """A reflection model with its parameters; equal values give equal pictures."""

    @property
    def largest(self) -> float:
        """An upper bound of the specular factor, with its growth."""
        raise NotImplementedError

    @property
    def steepness(self) -> float:
        """The power of cos(E), or of N.H, like which the factor falls near a cosine of 1."""
        raise NotImplementedError

    def specular(
        self, incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
    ) -> RealArray[Real]:
        """The specular factor, (points,), given N.L, cos(E) and N.V, which may be off by their rounding.

        It is finite and at least 0 for any cosines, and used where N.L > 0.
        """
        raise NotImplementedError


LEAST_REFLECTANCE: Final = 0.001
"""Assumed: the least F(0) to divide by; a refractive index of 1.065 has it."""

LEAST_INDEX: Final = 1.07
"""The least refractive index, rounded up, so that F(0) is above LEAST_REFLECTANCE."""

START_CURVE: Final = ((0.0, 0.04), (50.0, 0.06), (70.0, 0.17), (80.0, 0.39), (90.0, 1.0))
"""The initial curve: the reflectance of glass, whose refractive index is 1.5."""


@table_row
class SpecularGrowth(Row):
    """How S grows with the angle of incidence I: a factor of the specular plane, 1 at normal incidence.

    Paper: "The Lighting Model". For a more accurate rendering, S should be a function of the angle of
    incidence as well as of the material. Departs: S may grow with the angle of incidence; in Figure 2 it is
    constant. If it grows, S is multiplied by F(I) / F(0), where F is a curve through points, or Schlick's F0
    + (1 - F0) (1 - cos(I))^5 (C. Schlick, Computer Graphics Forum, 1994). F0 is the share that the material
    reflects at normal incidence: given, or ((n - 1) / (n + 1))^2 for its refractive index n.

    F is divided by F(0) so that S means the same under every model, and light from straight ahead is
    reflected as without growth: with Schlick's F alone, the 0.04 of glass would leave no highlight there. The
    factor belongs to the plane, not to S: S stays a weight, and its edit a weighted sum.
    """

    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("base_reflectance",),
        ("refractive_index",),
        ("fresnel_curve",),
    )

    base_reflectance: float | None = number(
        default=None,
        at_least=LEAST_REFLECTANCE,
        at_most=1,
        bar=BarRange(0.01, 1, 0.01),
        start=0.04,
        tier=Tier.LIGHT,
        help="F0: the share reflected at normal incidence; the smaller, the more S grows.",
    )
    refractive_index: float | None = number(
        default=None,
        at_least=LEAST_INDEX,
        at_most=10,
        bar=BarRange(1.1, 4, 0.01),
        start=1.5,
        tier=Tier.LIGHT,
        help="The refractive index, which determines F0: S grows with the angle of incidence.",
    )
    fresnel_curve: AngleCurve | None = column_of(
        AngleCurveKind(LEAST_REFLECTANCE, START_CURVE),
        default=None,
        tier=Tier.LIGHT,
        help="Points [angle in degrees, reflected share]; S grows with the share.",
    )

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

    def factor(self, incidence: RealArray[Real]) -> RealArray[Real] | None:
        """F(I) / F(0) at some cosines of I, in a new array; None if S is constant.

        Cosines below 0 count as 0, and above 1 as 1.
        """
        if self.fresnel_curve is not None:
            # Near normal incidence, an arc cosine of float32 has few digits.
            angles = np.degrees(np.arccos(np.clip(incidence, 0, 1, dtype=np.float64)))
            xs, ys = zip(*self.fresnel_curve, strict=True)
            factor: RealArray[Real] = (np.interp(angles, xs, ys) / ys[0]).astype(incidence.dtype)
            return factor
        f0 = self.normal_reflectance
        return None if f0 is None else _schlick(incidence, f0)


def _schlick(incidence: RealArray[Real], f0: float) -> RealArray[Real]:
    """1 + (1 / F0 - 1) (1 - cos(I))^5 at some cosines."""
    factor = np.clip(1 - incidence, 0, 1)
    once = factor.copy()
    factor *= factor
    factor *= factor
    factor *= once
    factor *= 1 / f0 - 1
    factor += 1
    return factor


CONSTANT: Final = SpecularGrowth()
"""An S that does not depend on the angle of incidence."""


@table_row
class _PowerOfCosine(ReflectionModel):
    """The models that raise a cosine to N. S may grow with the angle of incidence."""

    exponent: float = number(
        default=20.0,
        at_least=0,
        bar=BarRange(1, 200, 1),
        tier=Tier.LIGHT,
        help="N: the exponent, which makes the highlight narrower.",
    )

    growth: SpecularGrowth = nested(
        SpecularGrowth,
        default=CONSTANT,
        inline=True,
        tier=Tier.LIGHT,
        help="How S grows with the angle of incidence.",
    )

    @property
    def largest(self) -> float:
        """The largest factor of the growth; the power of a cosine is at most 1."""
        return self.growth.largest

    @property
    def steepness(self) -> float:
        """N."""
        return self.exponent

    def grown(self, factor: RealArray[Real], incidence: RealArray[Real]) -> RealArray[Real]:
        """A factor, in its own array, times the growth of S at some cosines of I."""
        growth = self.growth.factor(incidence)
        return factor if growth is None else np.multiply(factor, growth, out=factor)


@table_row
class Phong(_PowerOfCosine):
    """cos^N(E). Paper: Figure 2."""

    def specular(
        self, incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
    ) -> RealArray[Real]:
        """cos^N(E), times the growth of S."""
        return self.grown(power(eye, self.exponent), incidence)


@table_row
class BlinnPhong(_PowerOfCosine):
    """cos^N of the angle between normal and half vector. Departs: J. Blinn's model of 1977, not Figure 2."""

    def specular(
        self, incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
    ) -> RealArray[Real]:
        """(N.H)^N, times the growth of S."""
        normal, _ = _half_vector(incidence, eye, view)
        return self.grown(power(normal, self.exponent), incidence)


LEAST_FACING: Final = 0.3
"""Assumed: the least N.V to divide by; otherwise a silhouette would far outshine its surface.

Measured on a sphere and on the coupe, roughness 0.3: with light from the front and from the side the largest
factor is 1.0 and 2.8, at N.V above 0.5 whatever the bound. With light from behind to one side it is 47 at N.V
0.1 without a bound, 21 with this one, and 19 among points with N.V above 0.3; from straight behind 1005, 59
and 18.
"""

LEAST_SQUARE: Final = 1e-6
"""The least |L + V|^2, above the rounding of float32; only where L and V are opposite is it less."""


@table_row
class CookTorrance(ReflectionModel):
    """F D G / (N.V) over its value at normal incidence and view.

    Departs: the model of R. Cook and K. Torrance, SIGGRAPH 1981, not Figure 2. It has Beckmann's distribution
    D, whose slope m is `roughness`; their geometric attenuation G; and their Fresnel term F for the index of
    refraction that reflects `normal_reflectance`, F0, at normal incidence.
    """

    roughness: float = number(
        default=0.3,
        at_least=0.01,
        at_most=1,
        bar=BarRange(0.01, 1, 0.01),
        tier=Tier.LIGHT,
        help="The roughness: m, the slope of the microfacets.",
    )
    normal_reflectance: float = number(
        default=0.05,
        at_least=0.001,
        at_most=1,
        bar=BarRange(0.01, 1, 0.01),
        tier=Tier.LIGHT,
        help="F0: the share reflected at normal incidence.",
    )

    @property
    def largest(self) -> float:
        """The factor if F and G were 1 and D at its maximum, which is 4 / e for a roughness of 1."""
        return 4 / math.e / self.normal_reflectance / LEAST_FACING

    @property
    def steepness(self) -> float:
        """Near a cosine of 1, Beckmann's distribution falls like the cosine to the power 2 / m^2."""
        return 2 / self.roughness**2

    def specular(
        self, incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
    ) -> RealArray[Real]:
        """F D G / (N.V), relative to normal incidence and view."""
        half_normal, half_view = _half_vector(incidence, eye, view)
        # G, the share that no microfacet shadows: min(1, 2 (N.H) (N.V) / V.H, 2 (N.H) (N.L) / V.H).
        attenuation = np.minimum(incidence, view)
        attenuation *= half_normal
        attenuation *= 2
        attenuation /= half_view
        np.clip(attenuation, 0, 1, out=attenuation)
        factor = self._distribution(half_normal)
        factor *= self._fresnel(half_view)
        factor *= attenuation
        factor /= np.maximum(view, LEAST_FACING)
        return factor

    def _distribution(self, cosine: RealArray[Real]) -> RealArray[Real]:
        """Beckmann's D over its value at cos 1: exp(-(tan / m)^2) / cos^4."""
        square = np.maximum(cosine * cosine, 1e-4)
        tangent: RealArray[Real] = (1 - square) / square
        tangent /= -self.roughness * self.roughness
        np.exp(tangent, out=tangent)
        tangent /= square * square
        return tangent

    def _fresnel(self, cosine: RealArray[Real]) -> RealArray[Real]:
        """F over F0, for unpolarized light at a cosine of incidence on a half vector."""
        root = math.sqrt(self.normal_reflectance)
        if root == 1:
            return np.ones_like(cosine)
        index = (1 + root) / (1 - root)
        g = np.sqrt(cosine * cosine + (index * index - 1))
        first = (g - cosine) / (g + cosine)
        second = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)
        fresnel: RealArray[Real] = first * first * (1 + second * second)
        fresnel *= 0.5 / self.normal_reflectance
        return fresnel


def _half_vector(
    incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
) -> tuple[RealArray[Real], RealArray[Real]]:
    """N.H and V.H, given N.L, cos(E) and N.V; both 0 to 1."""
    length = np.sqrt(half_length_squared(incidence, eye, view))
    normal = incidence + view
    normal /= length
    np.clip(normal, 0, 1, out=normal)
    length *= 0.5
    return normal, length


def half_length_squared(
    incidence: RealArray[Real], eye: RealArray[Real], view: RealArray[Real]
) -> RealArray[Real]:
    """|L + V|^2, given N.L, cos(E) and N.V."""
    square = view * incidence
    square *= 4
    square -= 2 * eye
    square += 2
    np.clip(square, LEAST_SQUARE, 4, out=square)
    return square


MODELS: Final[dict[str, type[ReflectionModel]]] = {
    "phong": Phong,
    "blinn": BlinnPhong,
    "cook-torrance": CookTorrance,
}
"""Every reflection model by the name that a scene gives it."""
