"""How S grows with the angle of incidence I: a factor of the specular plane, 1 at normal incidence.

Paper: "The Lighting Model". For a more accurate rendering, S should be a function of the angle of incidence
as well as of the material.

Departs: S is constant, as in Figure 2, unless a surface asks for more. Then it is multiplied by F(I) / F(0),
where F is Schlick's F0 + (1 - F0) (1 - cos(I))^5 (C. Schlick, Computer Graphics Forum, 1994), or a curve
through points. F is divided by F(0) so that S means the same under every model, and light from straight ahead
is reflected as without growth: with Schlick's F alone, the 0.04 of glass would leave no highlight there.

F0 is what the material reflects at normal incidence: given, or ((n - 1) / (n + 1))^2 for its refractive index
n. The factor belongs to the plane, not to S: S stays a weight, and its edit a weighted sum.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, ClassVar, Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.scene.columns.angle_kinds import AngleCurve, AngleCurveKind
from autocolor.scene.columns.bars import Bar
from autocolor.scene.columns.column import Column, Row, Tier
from autocolor.scene.columns.problems import Problem
from autocolor.scene.columns.value_kinds import Number

LEAST_REFLECTANCE: Final = 0.001
"""Assumed: the least F(0) to divide by; it is that of a refractive index of 1.065."""

LEAST_INDEX: Final = 1.07
"""The least refractive index, rounded to where F(0) is above the least."""

START_CURVE: Final = ((0.0, 0.04), (50.0, 0.06), (70.0, 0.17), (80.0, 0.39), (90.0, 1.0))
"""What a curve begins with: that of glass, whose refractive index is 1.5."""


@dataclass(frozen=True, repr=False)
class SpecularGrowth(Row):
    """What a material reflects at each angle of incidence, in one of three ways; without, S is constant."""

    alternatives: ClassVar[tuple[str, ...]] = ("base_reflectance", "refractive_index", "fresnel_curve")

    base_reflectance: Annotated[
        float | None,
        Column(
            Number(LEAST_REFLECTANCE, 1),
            Tier.LIGHT,
            "F0: what is reflected at normal incidence; the less, the more S grows.",
            bar=Bar(0.01, 1, 0.01),
            start=0.04,
        ),
    ] = None
    refractive_index: Annotated[
        float | None,
        Column(
            Number(LEAST_INDEX, 10),
            Tier.LIGHT,
            "The refractive index, which tells F0: S grows with the angle of incidence.",
            bar=Bar(1.1, 4, 0.01),
            start=1.5,
        ),
    ] = None
    fresnel_curve: Annotated[
        AngleCurve | None,
        Column(
            AngleCurveKind(LEAST_REFLECTANCE, START_CURVE),
            Tier.LIGHT,
            "Points [angle in degrees, share reflected]; S grows as the share does.",
        ),
    ] = None

    def rules(self) -> Iterator[Problem]:
        """At most one of the three is given."""
        given = [name for name in self.alternatives if vars(self)[name] is not None]
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
