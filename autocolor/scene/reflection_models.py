"""Reflection models: what a surface sends to the eye of the light that arrives. Phong's is the one there is.

Paper: Figure 2. light(j) = intensity(j) (D cos(I) + S cos^N(E)). The two terms are kept apart and without
their D and S, so that these can change without computing a cosine again.
"""

from __future__ import annotations

from autocolor.arrays import Singles, power


def phong_diffuse(cos_incidence: Singles) -> Singles:
    """cos(I), Lambert's law; `cos_incidence` is above 0."""
    return cos_incidence


def phong_specular(cos_eye: Singles, exponent: float) -> Singles:
    """cos^N(E); a negative cosine counts as 0. The array of the cosines is worked in."""
    # Most surfaces mirror some of the lights away from the eye.
    if exponent > 0 and cos_eye.max(initial=0.0) <= 0:
        cos_eye[:] = 0
        return cos_eye
    return power(cos_eye, exponent, out=cos_eye)
