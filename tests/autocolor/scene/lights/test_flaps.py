from __future__ import annotations

import math

import pytest

from autocolor import Flap, Flaps, InputError


def test_a_flap_has_sharp_edges_and_no_ends_unless_they_are_given() -> None:
    assert (Flap().minimum, Flap().maximum, Flap().on, Flap().edge_width) == (-math.inf, math.inf, True, 0)


@pytest.mark.parametrize("width", [-0.1, math.inf, math.nan])
def test_an_edge_width_is_a_number_from_0_on(width: float) -> None:
    with pytest.raises(InputError, match=r"^flap: edge_width must be a finite number of at least 0"):
        Flap(0, 1, edge_width=width)


def test_a_minimum_above_the_maximum_is_refused() -> None:
    message = r"^flap: the minimum must not be above the maximum, not 2 to 1; exchange them$"
    with pytest.raises(InputError, match=message):
        Flap(2, 1)


def test_a_table_changes_the_edge_width_of_one_flap_alone() -> None:
    flaps = Flaps(x=Flap(0, 1), z=Flap(minimum=0.5))
    assert flaps.replace(x={"edge_width": 0.2}) == Flaps(x=Flap(0, 1, edge_width=0.2), z=Flap(minimum=0.5))
