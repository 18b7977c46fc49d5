"""Reflection models: what a surface sends to the eye of the light that arrives. Phong's is the one there is.

Paper: Figure 2. light(j) = intensity(j) (D cos(I) + S cos^N(E)). The two terms are kept apart and without
their D and S, so that these can change without computing a cosine again.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Singles = npt.NDArray[np.float32]

LEAST_SPECULAR = 1e-12
"""What is smaller than this fraction of the peak is taken as 0: most pixels then need no power."""

BELOW_ONE = float(np.nextafter(np.float32(1), np.float32(0)))
LARGEST = float(np.finfo(np.float32).max)


def phong_diffuse(cos_incidence: Singles) -> Singles:
    """cos(I), Lambert's law; `cos_incidence` is above 0."""
    return cos_incidence


def phong_specular(cos_eye: Singles, exponent: float) -> Singles:
    """cos^N(E); a negative cosine counts as 0."""
    if exponent == 0:
        return np.ones_like(cos_eye)
    specular = np.zeros_like(cos_eye)
    bright = np.flatnonzero(cos_eye > min(LEAST_SPECULAR ** (1 / exponent), BELOW_ONE))
    # Rounding may leave a cosine above 1, which a large exponent would make a highlight of its own.
    log = np.log(np.minimum(cos_eye[bright], np.float32(1)))
    log *= np.float32(min(exponent, LARGEST))
    specular[bright] = np.exp(log, out=log)
    return specular
