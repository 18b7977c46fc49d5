from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.lighting.light_planes import DIFFUSE, SPECULAR, LightPlanes, mix
from autocolor.visibility.visible_points import point_chunks, surface_slices


@given(st.lists(st.integers(0, 30), min_size=1, max_size=5), st.integers(1, 40), st.integers(0, 1 << 32))
def test_the_mix_is_the_weighted_sum_of_both_planes_by_surface(
    counts: list[int], at_once: int, seed: int
) -> None:
    random = np.random.default_rng(seed)
    slices = surface_slices(np.array([0, *counts]))
    values = random.uniform(0, 1, (2, sum(counts))).astype(np.float32)
    weights = {
        each.surface_number: (np.float32(random.uniform()), np.float32(random.uniform())) for each in slices
    }
    out = np.full(sum(counts), np.float32(np.nan))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("autocolor.visibility.visible_points.PIXELS_AT_ONCE", at_once)
        for chunk in point_chunks(slices):
            mix(LightPlanes(values, weights), chunk, out=out[chunk.pixels])
    for each in slices:
        diffuse, specular = map(float, weights[each.surface_number])
        for pixel in range(each.start, each.stop):
            expected = diffuse * float(values[DIFFUSE, pixel]) + specular * float(values[SPECULAR, pixel])
            assert out[pixel] == pytest.approx(expected, rel=1e-6)
