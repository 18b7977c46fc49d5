from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from autocolor import Flap, Flaps, Light
from autocolor.screens.light_and_view.flap_switches import FlapSwitch, flap_switches
from autocolor.screens.light_and_view.orthographic_views import FRONT, SIDES, TOP, OrthographicViews
from autocolor.widgets.colors import NIGHT, YELLOW
from autocolor.widgets.items import filled
from autocolor.widgets.widget import Place

VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def switches_of(flaps: Flaps, changes: list[Mapping[str, Any]] | None = None) -> list[FlapSwitch]:
    light = Light("key", (1.0, 2.0, 3.0), flaps=flaps)
    return list(flap_switches(VIEWS, light, (changes if changes is not None else []).append))


def test_each_line_of_a_flap_has_a_switch_at_its_end() -> None:
    switches = switches_of(Flaps(z=Flap(-1.0, 2.0)))
    assert [each.label for each in switches] == [
        "key: flap z, minimum, front",
        "key: flap z, maximum, front",
        "key: flap z, minimum, side",
        "key: flap z, maximum, side",
    ]
    line = round(VIEWS.position(FRONT, (0.0, 0.0, 2.0))[1])
    assert FRONT.area.right - 2 <= switches[1].area.right <= FRONT.area.right
    assert line - 3 <= switches[1].area.bottom < line


def test_switches_are_within_their_view_wherever_the_lines_are() -> None:
    for tenth in range(-130, 131):
        flaps = Flaps(*(Flap(minimum=tenth / 10) for _ in "xyz"))
        for each in switches_of(flaps):
            assert any(side.area.covers(each.area) for side in SIDES)
            assert not each.area.is_empty


def test_a_switch_is_full_while_its_flap_is_on_and_flips_it() -> None:
    changes: list[Mapping[str, Any]] = []
    on, off = switches_of(Flaps(x=Flap(minimum=0.0), y=Flap(minimum=1.0, on=False)), changes)[:2]
    assert on.label == "key: flap x, minimum, top"
    assert filled(on.area.inset(2), YELLOW) in on.items(lit=False)
    assert filled(off.area.inset(1), NIGHT) in off.items(lit=False)
    assert filled(off.area.inset(2), YELLOW) not in off.items(lit=False)
    assert "off" in on.help
    for each in (on, off):
        each.pick(Place(each.area.left, each.area.top))
    assert changes == [{"flaps": {"x": {"on": False}}}, {"flaps": {"y": {"on": True}}}]


def test_a_flap_without_an_end_in_view_has_no_switch() -> None:
    assert switches_of(Flaps(x=Flap(), y=Flap(minimum=1e9))) == []
    assert TOP.area.width
