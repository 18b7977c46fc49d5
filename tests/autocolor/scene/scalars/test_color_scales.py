from __future__ import annotations

import numpy as np
import pytest

from autocolor.scene.scalars.color_scales import COLOR_SCALES, scale_colors


@pytest.mark.parametrize("name", COLOR_SCALES)
@pytest.mark.parametrize("count", [2, 5, 16, 256])
def test_a_scale_runs_from_its_first_color_to_its_last(name: str, count: int) -> None:
    colors = scale_colors(name, count)
    ends = [bytes.fromhex(COLOR_SCALES[name][end][1:]) for end in (0, -1)]
    assert colors.shape == (count, 3)
    assert colors.dtype == np.uint8
    assert [bytes(colors[0]), bytes(colors[-1])] == ends


def test_a_list_of_colors_is_a_scale_whose_colors_are_mixed_between_them() -> None:
    assert scale_colors(((0, 0, 0), (200, 100, 0)), 3).tolist() == [[0, 0, 0], [100, 50, 0], [200, 100, 0]]
