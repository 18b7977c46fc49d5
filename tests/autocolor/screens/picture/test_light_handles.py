from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor import Light
from autocolor.lighting.picking import Rim, highlight_placed, rims, specular_shares
from autocolor.screens.message_line import MESSAGE
from autocolor.widgets.items import WHITE, YELLOW
from autocolor.widgets.menu import WORK
from tests.autocolor.screens.ball import MIDDLE, ball_scene, hand_before
from tests.autocolor.screens.hand import Hand

REACH = 8
"""Elements or lines from a handle within which it is grabbed."""

PLACE = 335, 205
"""An element and line of the ball to which things are put."""

BACKGROUND = 20, 20


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_before(ball_scene(), tmp_path)


@pytest.fixture
def at_lights(hand: Hand) -> Hand:
    hand.turn_to("lights")
    return hand


def key(hand: Hand) -> Light:
    return hand.scene.lights["key"]


def yellow(hand: Hand) -> set[tuple[int, int]]:
    """The lines and elements of the yellow pixels beside the menu and the light list."""
    found = np.argwhere(hand.display.words[: WORK.bottom + 1, : WORK.right + 1] == YELLOW)
    listed = [widget.area for widget in hand.viewer.board.content.widgets]
    return {
        (line, element) for line, element in found.tolist() if not any(a.has(element, line) for a in listed)
    }


# The highlight.


def test_a_highlight_that_is_picked_goes_where_the_second_pick_is(hand: Hand) -> None:
    before = hand.scene
    hand.click(*hand.handle("highlight of key"))
    assert hand.message == "highlight of key: pick its new place"
    assert hand.scene is before
    # A pick on the background is refused, and the highlight is still held.
    hand.click(*BACKGROUND)
    assert hand.scene is before
    assert hand.viewer.session.news.is_warning
    hand.click(*PLACE)
    assert hand.viewer.studio.highlight_of("key") == PLACE[::-1]
    hand.press("Ctrl+Z")
    assert hand.scene is before


def test_a_dragged_highlight_follows_in_one_step(at_lights: Hand) -> None:
    hand, before = at_lights, at_lights.scene
    start = hand.handle("highlight of key")
    # The background is refused, and the drag goes on; the marks of other highlights are not in the way.
    hand.drag(start, (330, 240), BACKGROUND, hand.handle("highlight of fill"), PLACE)
    studio = hand.viewer.studio
    assert studio.highlight_of("key") == PLACE[::-1]
    assert hand.handle("highlight of key") == PLACE
    # Where it comes from does not matter but for the distance, which each place keeps.
    seen = studio.seen_at(*PLACE[::-1])
    assert key(hand).aim == highlight_placed(before, seen, "key").lights["key"].aim
    hand.press("Ctrl+Z")
    assert hand.scene is before
    assert hand.handle("highlight of key") == start


def test_a_highlight_stays_where_it_was_put_beside_the_chosen_surface(hand: Hand) -> None:
    assert hand.viewer.session.surface_name == "paint"
    hand.drag(hand.handle("highlight of key"), (300, 400), (320, 430))
    assert hand.viewer.studio.seen_at(430, 320).surface == "floor"  # type: ignore[union-attr]
    assert hand.handle("highlight of key") == (320, 430)
    # Where the light was put otherwise, the highlight is searched.
    hand.viewer.studio.light("key", position=(2.0, -5.0, 2.5))
    hand.viewer.tell("")
    assert hand.handle("highlight of key") != (320, 430)


def test_a_drag_over_the_background_keeps_the_last_place_and_escape_takes_a_drag_back(hand: Hand) -> None:
    before = hand.scene
    hand.drag(hand.handle("highlight of key"), MIDDLE, BACKGROUND)
    assert hand.viewer.studio.highlight_of("key") == MIDDLE[::-1]
    assert hand.viewer.session.news.is_warning
    placed = hand.scene
    hand.grab(*MIDDLE)
    hand.move(*PLACE)
    assert hand.scene is not placed
    hand.press("escape")
    assert hand.scene is placed
    assert hand.viewer.studio.history.to_undo == (before,)


@pytest.mark.parametrize("bring_menu", [lambda hand: hand.turn_to("lights"), lambda hand: hand.press("tab")])
def test_a_dragged_highlight_keeps_beside_the_menu(hand: Hand, bring_menu: Callable[[Hand], object]) -> None:
    scene = hand.scene
    hand.viewer.session.edit(scene.replace(view=scene.view.replace(field_of_view=12.0)))
    bring_menu(hand)
    hand.drag(hand.handle("highlight of key"), MIDDLE, (WORK.right + 40, 240))
    assert hand.handle("highlight of key") == (WORK.right, 240)


# The rims.

RIMS: dict[Rim, tuple[str, str]] = {
    "cone": ("end of the cone of key", "key: cone angle {0.cone_angle:.1f} degrees"),
    ("z", "minimum"): ("end of the flap z, minimum, of key", "key: flap z, minimum {0.flaps.z.minimum:.2f}"),
}


@pytest.mark.parametrize("rim", RIMS)
def test_a_rim_is_dragged_or_put_by_two_picks_to_where_it_is_to_end(at_lights: Hand, rim: Rim) -> None:
    hand, before, (label, message) = at_lights, at_lights.scene, RIMS[rim]
    start = hand.handle(label)
    hand.drag(start, (300, 230), PLACE)
    after = hand.scene
    assert hand.message == message.format(key(hand))
    pixels = rims(hand.viewer.studio.sight, "key")[rim]
    assert np.abs(pixels - np.array(PLACE[::-1])).max(axis=1).min() <= 1
    hand.press("Ctrl+Z")
    assert hand.scene is before
    hand.click(*start)
    hand.click(*PLACE)
    assert hand.scene.equals(after)


def test_each_pixel_of_a_rim_is_within_reach_of_a_handle(at_lights: Hand) -> None:
    hand = at_lights
    handles = hand.viewer.board.content.handles
    found = rims(hand.viewer.studio.sight, "key")
    assert found.keys() == RIMS.keys()
    for rim, pixels in found.items():
        places = [(each.line, each.element) for each in handles if each.label == RIMS[rim][0]]
        assert set(places) <= set(map(tuple, pixels.tolist()))
        seen = pixels[(pixels <= (WORK.bottom, WORK.right)).all(axis=1)]
        assert len(places) < len(seen) / 2
        apart = np.abs(seen[:, None] - np.array(places)[None]).max(axis=2).min(axis=1)
        assert apart.max() <= REACH


# The marks.


def test_the_marks_are_at_the_handles_and_leave_the_picture_as_it_was(at_lights: Hand) -> None:
    hand, studio = at_lights, at_lights.viewer.studio
    studio.remove_light("fill")
    hand.viewer.tell("")
    marked = yellow(hand)
    pixels = {tuple(each) for found in rims(studio.sight, "key").values() for each in found.tolist()}
    assert 0.3 * len(pixels) < len(marked & pixels) < len(pixels)
    line, element = studio.highlight_of("key") or (0, 0)
    cross = {(line + down, element + across) for down in (-4, 4) for across in (-4, 4)}
    assert cross <= marked
    assert (line, element) not in marked
    # The number of the light is beside the cross.
    assert all(abs(a - line) <= 5 and -5 <= b - element <= 20 for a, b in marked - pixels)
    # While something is dragged, the rims are left out.
    hand.grab(*hand.handle("end of the cone of key"))
    hand.move(*PLACE)
    assert len(yellow(hand)) < 60 < len(marked)
    hand.drop()
    assert len(yellow(hand)) > 60
    hand.pick("on", 0.95)
    assert not key(hand).on
    assert not yellow(hand)
    assert not hand.viewer.board.content.handles
    beside = np.s_[hand.viewer.board.content.widgets[-1].area.bottom + 1 : WORK.bottom + 1, : WORK.right + 1]
    assert np.array_equal(hand.display.words[beside], studio.words[beside])


def test_a_coarse_picture_has_no_marks_until_the_movement_ends(
    at_lights: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand, before, times = at_lights, at_lights.scene, itertools.count()
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: float(next(times)))
    hand.grab(450, 420)
    for element in (455, 460, 465):
        hand.move(element, 420)
    assert hand.viewer.studio.is_coarse
    assert not yellow(hand)
    assert not hand.viewer.board.content.handles
    hand.drop()
    assert not hand.viewer.studio.is_coarse
    assert yellow(hand)
    assert hand.viewer.studio.history.timeline.views_back == (before.view,)


def test_without_a_menu_the_message_line_names_a_highlight_under_the_pointer_and_nothing_else(
    hand: Hand,
) -> None:
    foot = slice(MESSAGE.top, MESSAGE.bottom + 1)
    hand.viewer.tell("")
    hand.move(20, 20)
    assert not yellow(hand)
    labels = [each.label for each in hand.viewer.board.content.handles]
    assert labels == ["highlight of fill", "highlight of key"]
    display, picture = hand.display, hand.viewer.studio.words
    assert (display.words[foot] == picture[foot]).all()
    hand.move(*hand.handle("highlight of key"))
    assert hand.hint.startswith("highlight of key: drag it")
    assert (display.words[foot] != picture[foot]).any()
    hand.move(20, 20)
    assert (display.words[foot] == picture[foot]).all()


def test_the_lights_screen_marks_all_highlights_at_rest_and_the_chosen_one_is_yellow(at_lights: Hand) -> None:
    hand = at_lights
    for name, word in (("key", YELLOW), ("fill", WHITE)):
        element, line = hand.handle(f"highlight of {name}")
        assert hand.display.words[line - 4, element - 4] == word
    hand.drag(hand.handle("highlight of fill"), (330, 240), PLACE)
    assert hand.viewer.session.light_name == "fill"
    assert hand.handle("highlight of fill") == PLACE
    assert hand.display.words[PLACE[1] - 4, PLACE[0] - 4] == YELLOW


def test_of_two_highlights_the_press_takes_the_light_that_shines_there_most(hand: Hand) -> None:
    studio, (element, line) = hand.viewer.studio, PLACE
    for name in ("key", "fill"):
        studio.place_highlight(name, line, element)
        studio.light(name, concentration=0.0, cone_angle=None, flaps={"x": None, "y": None, "z": None})
    for strong, weak in (("key", "fill"), ("fill", "key")):
        studio.light(strong, intensity=0.9)
        studio.light(weak, intensity=0.1)
        hand.viewer.tell("")
        shares = specular_shares(studio.picture, line, element)
        assert shares[strong] > shares[weak] > 0
        found = hand.viewer.board.handle_at(element, line)
        assert found is not None
        assert found.label == f"highlight of {strong}"


def test_the_highlight_of_a_light_that_follows_or_is_at_infinity_goes_where_it_is_picked(
    at_lights: Hand,
) -> None:
    hand = at_lights
    studio = hand.viewer.studio
    studio.light("key", at_infinity=True)
    studio.edit(studio.scene.with_light_following("key", "eye"))
    for place in (PLACE, (300, 220)):
        hand.drag(hand.handle("highlight of key"), (330, 240), place)
        assert studio.highlight_of("key") == place[::-1]
        assert hand.handle("highlight of key") == place
        assert (key(hand).follows, key(hand).at_infinity) == ("eye", True)
    position = zip("xyz", hand.scene.lights_in_world["key"].position, strict=True)
    assert hand.message == "key: " + "  ".join(f"{axis} {place:.2f}" for axis, place in position)
    # Its cross is where the highlight is seen after it was turned in place.
    hand.viewer.studio.light("key", direction=(0.1, 1.0, 0.0))
    assert hand.handle("highlight of key") == pytest.approx(
        (studio.highlight_of("key") or (0, 0))[::-1], abs=8
    )
