from __future__ import annotations

import pytest

from autocolor.widgets.areas import Area
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Place

ROW = Area(505, 32, 639, 47)


@pytest.mark.parametrize(("element", "ran"), [(510, "add"), (630, "copy")])
def test_each_half_of_a_pair_is_a_button(element: int, ran: str) -> None:
    did: list[str] = []
    pair = Pair("add", run=lambda: did.append("add"), other="copy", run_other=lambda: did.append("copy"))
    pair.at(ROW).pick(Place(element, 40))
    pair.nudge(1 if ran == "copy" else -1)
    assert did == [ran, ran]


@pytest.mark.parametrize("lit", [True, False])
def test_a_pair_stays_in_its_area(lit: bool) -> None:
    pair = Pair("a name that is too long", other="another one that is too long", area=ROW)
    assert all(ROW.covers(item.area) for item in pair.items(lit))
