from __future__ import annotations

import pytest

from autocolor.errors import InputError
from autocolor.scene.columns.column import Tier
from autocolor.scene.columns.rows import cost
from autocolor.scene.scalars.scalar import Scalar


@pytest.mark.parametrize("limits", [(1, 1), (2, 1), (0, float("nan")), (0, float("inf")), (1,), "12", 5])
def test_limits_are_two_finite_numbers_the_second_above_the_first(limits: object) -> None:
    with pytest.raises(InputError, match=r"must be two finite numbers, the second above the"):
        Scalar("stress", limits)  # type: ignore[arg-type]


def test_a_color_beyond_a_limit_has_words_of_its_own() -> None:
    without, red, blue = (Scalar("stress", below=color) for color in (None, (255, 0, 0), (0, 0, 255)))
    assert cost(without, red) is Tier.LEVELS
    assert cost(red, blue) is Tier.ENTRIES


def test_all_color_scales_are_named_where_none_is_near() -> None:
    with pytest.raises(InputError, match=r"not 'jet'; known are 'viridis', .*'coolwarm'") as refusal:
        Scalar("stress", scale="jet")
    assert "_r'" not in str(refusal.value)


def test_an_unknown_color_scale_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(InputError, match=r"must be the name of a color scale, or a list of 2"):
        Scalar("stress", scale="virids")
    with pytest.raises(InputError, match=r"did you mean 'coolwarm'\?"):
        Scalar("stress", scale="cool-warm")
    assert Scalar("stress", scale=["red", "#00f"]).scale == ((255, 0, 0), (0, 0, 255))  # type: ignore[arg-type]
