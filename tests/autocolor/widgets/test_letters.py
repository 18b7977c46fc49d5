from __future__ import annotations

from itertools import combinations

from autocolor.widgets.letters import PANEL, letter_panel
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import Place


def test_every_key_gives_its_name_and_character() -> None:
    pressed: list[tuple[str, str]] = []
    *keys, _ = letter_panel(lambda name, typed: pressed.append((name, typed)))
    for key in keys:
        key.pick(Place(key.area.left, key.area.top))
    assert {typed for _, typed in pressed} == {*"abcdefghijklmnopqrstuvwxyz0123456789-_.# ", ""}
    assert [name for name, typed in pressed if not typed] == ["backspace", "end", "escape", "return"]


def test_the_keys_stand_apart_on_their_panel_beside_the_menu() -> None:
    *keys, panel = letter_panel(lambda *_: None)
    assert panel.area == PANEL
    assert WORK.covers(PANEL)
    for key in keys:
        assert PANEL.inset(1).covers(key.area)
        for item in key.items(lit=True):
            assert key.area.covers(item.area)
    assert not any(one.area.overlaps(other.area) for one, other in combinations(keys, 2))
    assert len({key.key for key in keys}) == len(keys)
