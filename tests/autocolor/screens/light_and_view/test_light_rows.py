from __future__ import annotations

from autocolor import Light
from autocolor.screens.light_and_view.light_rows import light_rows
from autocolor.widgets.widget import Button, Switch, Widget
from tests.autocolor.screens.hand import Hand
from tests.autocolor.screens.light_and_view.pointing import (
    FILL,
    KEY,
    boxed,
    opened,
    scene_of_hand,
    screen_of,
)


def rows_of(hand: Hand) -> dict[str, Widget]:
    screen = screen_of(hand)
    rows = light_rows(hand.viewer.session, screen.edits, screen.chosen, screen.choose)
    return {row.label: row for row in rows}


def test_each_light_has_a_row_with_its_number() -> None:
    rows = rows_of(opened(boxed(KEY, FILL.replace(on=False))))
    key, fill = rows["1 key"], rows["2 fill"]
    assert isinstance(key, Switch)
    assert isinstance(fill, Switch)
    assert (key.is_on, key.is_chosen) == (True, True)
    assert (fill.is_on, fill.is_chosen) == (False, False)


def test_the_box_of_a_row_switches_the_light_and_the_rest_chooses_it() -> None:
    hand = opened(boxed(KEY, FILL))
    before = scene_of_hand(hand)
    hand.pick("2 fill", 0.3)
    assert hand.viewer.session.light_name == "fill"
    assert scene_of_hand(hand) is before
    hand.pick("1 key", 0.95)
    assert not scene_of_hand(hand).light("key").on
    assert hand.viewer.session.light_name == "fill"


def test_the_chosen_light_has_rows_for_its_kind_concentration_cone_and_flaps() -> None:
    rows = rows_of(opened(boxed(KEY, FILL)))
    assert list(rows)[4:] == ["kind", "concentration", "cone angle", "flaps x", "flaps y", "flaps z"]


def test_without_lights_there_is_the_row_of_the_eye_alone() -> None:
    assert list(rows_of(opened(boxed()))) == ["eye"]


def test_the_eye_has_a_row_and_hides_those_of_the_chosen_light() -> None:
    hand = opened(boxed(KEY, FILL))
    hand.pick("eye")
    rows = rows_of(hand)
    assert list(rows) == ["eye", "1 key", "2 fill"]
    eye, key = rows["eye"], rows["1 key"]
    assert isinstance(eye, Button)
    assert isinstance(key, Switch)
    assert (eye.is_chosen, key.is_chosen) == (True, False)
    hand.pick("1 key", 0.3)
    assert "kind" in rows_of(hand)


def test_all_rows_of_sixteen_lights_can_be_reached() -> None:
    hand = opened(boxed(*(Light(f"light {n}", (n, -3.0, 2.0)) for n in range(1, 17))))
    labels = set()
    for _ in range(3):
        labels |= {each.label for each in hand.viewer.board.menu_rows()}
        hand.pick("more")
    assert {f"{n} light {n}" for n in range(1, 17)} <= labels
    assert {"kind", "flaps z", "rescale", "display", "angle", "frame"} <= labels
