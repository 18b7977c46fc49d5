from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.planes.scaled_nodes import ScaledNodes, as_they_are


@given(st.integers(0, 1 << 32))
def test_corners_are_those_of_nodes_that_are_moved_and_then_scaled(seed: int) -> None:
    random = np.random.default_rng(seed)
    rows, middle, extent = random.normal(size=(3, 9)), random.normal(size=3), float(random.uniform(1e-9, 1e9))
    numbers = random.integers(0, 9, (4, 5))
    before = rows.copy()
    expected = ((rows - middle[:, None]) / extent)[:, numbers]
    assert ScaledNodes(rows, middle, extent).corners(numbers).tobytes() == expected.tobytes()
    assert as_they_are(rows).corners(numbers).tolist() == rows[:, numbers].tolist()
    assert rows.tobytes() == before.tobytes()
