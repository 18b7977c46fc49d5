from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError, Light, Mesh, Surface, View, render, scene_of
from autocolor.images import display_image
from autocolor.mapping.palette import thumbnail
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.variants_screen import ELEMENTS, FRAME, LINES, ON_PAGE, PLACES
from autocolor.widgets.menu import WORK
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boxes import hand_at, told, undo
from tests.autocolor.screens.hand import Hand
from tests.small import grid
from tests.tables import first


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "variants")


def keep(hand: Hand, number: int) -> None:
    """Keep some variants, each in other colors."""
    for each in range(number):
        color = f"#{(each * 67) % 256:02x}{(each * 29) % 256:02x}80"
        hand.viewer.studio.recolor("low", object_color=color)
        hand.pick("keep")


def rest(hand: Hand) -> None:
    for _ in range(ON_PAGE + 1):
        hand.viewer.on_tick()


def shown_at(hand: Hand, place: int) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """The colors of a small picture on the display."""
    display = hand.viewer.display
    assert isinstance(display, Ramtek9300)
    left, top = PLACES[place].left + FRAME, PLACES[place].top + FRAME
    return display.field()[top : top + LINES, left : left + ELEMENTS].astype(np.int64)


def names(hand: Hand) -> list[str]:
    return [each.label for each in hand.viewer.board.screen.widgets()]


def test_without_a_variant_there_is_nothing_to_come_back_to(hand: Hand) -> None:
    for label in ("come back", "drop"):
        hand.pick(label)
        assert told(hand) == (f"{label}: no variant is kept yet", True)


def test_a_scene_is_kept_and_come_back_to_in_one_step(hand: Hand) -> None:
    kept = hand.viewer.studio.scene
    hand.pick("keep")
    assert told(hand) == ("kept as A", False)
    hand.viewer.studio.recolor("low", object_color="#123456")
    changed = hand.viewer.studio.scene
    hand.pick("come back")
    assert hand.viewer.studio.scene.equals(kept)
    assert told(hand) == ("A is the scene again; undo goes back", False)
    assert hand.viewer.session.screen == "picture"
    hand.open_menu()
    undo(hand)
    assert hand.viewer.studio.scene is changed


def test_a_variant_is_chosen_by_a_click_and_dropped(hand: Hand) -> None:
    keep(hand, 3)
    assert names(hand) == ["A", "B", "C"]
    hand.click(PLACES[1].left + 20, PLACES[1].top + 20)
    hand.pick("drop")
    assert told(hand) == ("variant B dropped", False)
    assert names(hand) == ["A", "C"]
    hand.click(PLACES[0].left + 20, PLACES[0].top + 20)
    hand.pick("come back")
    assert hand.viewer.studio.scene.surface("low").paint.object_color == (0, 0, 128)


def test_a_variant_has_a_name_of_its_own_where_there_is_a_keyboard(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    for is_in_use in (False, True):
        hand.pick("keep as")
        hand.type("red")
        hand.press("return")
        assert (list(hand.viewer.studio.variants), told(hand)[1]) == (["red"], is_in_use)


@pytest.mark.parametrize("number", first(1, [4, 1, ON_PAGE]))
def test_small_pictures_have_true_colors_all_at_once(hand: Hand, number: int) -> None:
    keep(hand, number)
    rest(hand)
    assert all(WORK.covers(place) for place in PLACES)
    for place in {0, number - 1}:
        scene = list(hand.viewer.studio.variants.values())[place].scene
        picture = render(scene, lines=2 * LINES, elements=2 * ELEMENTS)
        wanted = thumbnail(display_image(scene, picture), LINES, ELEMENTS).astype(np.int64)
        errors = np.abs(shown_at(hand, place) - wanted).max(axis=2)
        assert errors.mean() < 3
        assert np.percentile(errors, 99) <= 16


def test_small_pictures_come_in_turn_while_nothing_moves(hand: Hand) -> None:
    keep(hand, 3)
    assert len(hand.viewer.board.screen.items()) == 0
    for number in (1, 2, 3, 3):
        hand.viewer.on_tick()
        assert len(hand.viewer.board.screen.items()) == number
    assert not hand.viewer.board.screen.idle()
    hand.pick("drop")
    hand.pick("< picture")
    assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)
    # When the screen is back, those of kept variants still stand, and that of the dropped one is gone.
    hand.open_menu()
    hand.pick("variants")
    assert len(hand.viewer.board.screen.items()) == 2
    hand.pick("keep")
    assert len(hand.viewer.board.screen.items()) == 2
    assert hand.viewer.board.screen.idle()
    assert not hand.viewer.board.screen.idle()


def test_the_words_of_the_menu_keep_their_entries(hand: Hand) -> None:
    keep(hand, ON_PAGE)
    rest(hand)
    loads = hand.viewer.board.screen.loads()
    assert len(loads) == ON_PAGE
    ends = [(first, first + len(colors)) for first, colors in loads]
    assert all(end <= following for (_, end), (following, _) in pairwise(ends))
    assert ends[0][0] > 0
    assert ends[-1][1] <= SCREENS.first


def test_many_variants_have_pages(hand: Hand) -> None:
    keep(hand, ON_PAGE + 3)
    assert len(names(hand)) == 3
    assert hand.widget("page").present == "2 of 2"  # type: ignore[attr-defined]
    # It opens at the page of the last variant.
    hand.pick("page")
    hand.pick("< picture")
    hand.open_menu()
    hand.pick("variants")
    assert len(names(hand)) == 3
    hand.pick("page")
    assert len(names(hand)) == ON_PAGE
    hand.pick("page")
    for _ in range(3):
        hand.pick("drop")
    assert len(names(hand)) == ON_PAGE
    assert "page" not in [row.label for row in hand.viewer.board.screen.rows()]


def test_a_small_picture_that_is_refused_is_black(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "variants")
    # A strip between the middles of two pixels of the picture, where the small one has the middle of a pixel.
    pixel = 2.0 / 480
    left = (10.0 - 320) * pixel
    meshes = [
        grid(1, 1, (-2.0, 0, -2.0), (4.0, 0, 0), (0, 0, 4.0), "wall"),
        grid(1, 1, (left - pixel / 4, -1e-4, -2.0), (pixel / 2, 0, 0), (0, 0, 4.0), "strip"),
    ]
    scene = scene_of(
        Mesh.joined(meshes),
        surface_of_part={"wall": "wall", "strip": "strip"},
        surfaces=[Surface("wall"), Surface("strip")],
        lights=[Light("key", (0, -5, 0), 3e38)],
        view=View((0, -1, 0), target=(0, 0, 0), field_of_view=90.0),
    )
    scene = scene.with_surface("wall", diffuse=0.1, specular=0.1).with_surface("strip", diffuse=1, specular=1)
    render(scene)
    with pytest.raises(InputError, match="intensities must stay below"):
        render(scene, lines=2 * LINES, elements=2 * ELEMENTS)
    hand.viewer.studio.edit(scene)
    hand.pick("keep")
    rest(hand)
    assert not shown_at(hand, 0).any()
    assert told(hand) == ("kept as A", False)
