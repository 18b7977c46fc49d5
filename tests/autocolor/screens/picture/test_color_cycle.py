from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.defaults import OBJECT_COLORS
from autocolor.screens.picture.color_cycle import color_after

colors = st.sampled_from(OBJECT_COLORS) | st.just("#123456")


@given(colors, st.sampled_from([1, -1]))
def test_a_step_and_its_opposite_come_back_to_the_same_color(own: str, step: int) -> None:
    assert color_after(color_after(own, own, step), own, -step) == own


@given(colors)
def test_steps_in_one_direction_go_through_all_colors_and_the_own_one(own: str) -> None:
    present, seen = own, []
    for _ in range(len({own, *OBJECT_COLORS})):
        present = color_after(present, own, 1)
        seen.append(present)
    assert present == own
    assert set(seen) == {own, *OBJECT_COLORS}


def test_a_color_that_came_from_elsewhere_is_followed_by_the_first() -> None:
    assert color_after("#654321", "#123456", 1) == "#123456"
    assert color_after("#654321", OBJECT_COLORS[3], 1) == OBJECT_COLORS[0]
