from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.defaults import OBJECT_COLORS
from autocolor.screens.surface.painting import color_after

colors = st.sampled_from(OBJECT_COLORS) | st.just("#123456")


@given(colors, st.sampled_from([1, -1]))
def test_steps_go_through_all_colors_and_the_own_one_and_back(own: str, step: int) -> None:
    present, seen = own, []
    for _ in range(len({own, *OBJECT_COLORS})):
        assert color_after(color_after(present, own, step), own, -step) == present
        present = color_after(present, own, step)
        seen.append(present)
    assert present == own
    assert set(seen) == {own, *OBJECT_COLORS}
    # A color that came from elsewhere is followed by the first.
    assert color_after("#654321", own, 1) == ("#123456" if own == "#123456" else OBJECT_COLORS[0])
