from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Scene
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.ranges import SCREENS, SURFACE_WORDS
from autocolor.screens.picture.split_screen import FIRST, MIDDLE, halves_of
from autocolor.studio import Studio
from autocolor.widgets.items import HEIGHT, WHITE
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.ball import ball_scene, hand_before
from tests.autocolor.screens.hand import Hand
from tests.tables import first

MARKED = slice(0, 40)
"""The lines at the top, with the names of the states."""

EDITS: dict[str, Callable[[Scene], Scene]] = {
    "light": lambda scene: scene.with_light("key", intensity=0.5, position=(4, -4, 3)),
    "paint": lambda scene: scene.with_paint("paint", object_color="#1040c0", light_color="#ffe0a0"),
    "all paints": lambda scene: scene.with_paint("paint", object_color="#1040c0").with_paint(
        "floor", object_color="#80ff10", light_color="#ff00ff"
    ),
    "ramp": lambda scene: scene.with_paint("paint", ramp=["#102", "#a03060", "#ffb060", "#fff"]),
    "background": lambda scene: scene.replace(background="#305070", contrast="floor"),
    "view": lambda scene: scene.with_view(eye=(3, -7, 1)),
    "scalar": lambda scene: scene.with_scalar(name="z", scale="turbo"),
    "normals": lambda scene: scene.replace(words="normals"),
}


def hand_after(edit: str, folder: Path) -> Hand:
    hand = hand_before(ball_scene(), folder)
    hand.viewer.session.edit(EDITS[edit](ball_scene()))
    hand.viewer.tell("")
    return hand


def field_of(scene: Scene) -> np.ndarray:
    """The picture of a scene without a legend, (lines, elements, 3)."""
    display = Ramtek9300()
    Studio(scene if scene.scalar is None else scene.with_scalar(legend=False), display)
    return display.entries[display.words].astype(int)


def split(hand: Hand) -> None:
    hand.open_menu()
    hand.pick("compare", 0.9)


def colors_on(hand: Hand) -> np.ndarray:
    """The colors on the display, without a menu and a message."""
    hand.move(300, 300)
    hand.viewer.tell("")
    return hand.display.entries[hand.display.words].astype(int)


@pytest.mark.parametrize("edit", first(2, EDITS))
def test_the_state_before_is_at_the_left_of_the_line_and_the_present_one_at_the_right(
    edit: str, tmp_path: Path
) -> None:
    hand = hand_after(edit, tmp_path)
    before, after = field_of(ball_scene()), field_of(hand.scene)
    split(hand)
    assert hand.viewer.page == "split"
    assert hand.message.startswith("now: ")
    is_exact = "every color exact" in hand.message
    for line in (MIDDLE, 200):
        if line != MIDDLE:
            hand.click(line, 300)
        shown = colors_on(hand)
        off = hand.viewer.screens["split"].halves.off  # type: ignore[attr-defined]
        assert is_exact == (off == 0)
        for true, part in ((before, slice(None, line - 1)), (after, slice(line + 1, None))):
            assert np.abs(shown[:, part] - true[:, part])[MARKED.stop :].max() <= off


def test_a_drag_moves_the_line_by_the_words_between_alone(tmp_path: Path) -> None:
    hand = hand_after("light", tmp_path)
    split(hand)
    colors_on(hand)
    display = hand.display
    scene, written = hand.scene, display.frame_buffer.written
    hand.drag((320, 200), (310, 200))
    assert hand.scene is scene
    assert 0 < display.frame_buffer.written - written < HEIGHT * 60 + 8_000
    assert (display.words[MARKED.stop :, 310] == WHITE).all()


def test_an_edit_of_the_picture_leaves_the_split(tmp_path: Path) -> None:
    hand = hand_after("light", tmp_path)
    split(hand)
    # Another paint of the chosen surface is shown at once at the right.
    hand.press("c")
    assert hand.viewer.page == "split"
    off = np.abs(colors_on(hand) - field_of(hand.scene))[MARKED.stop :, MIDDLE + 1 :]
    assert off.max() <= hand.viewer.screens["split"].halves.off  # type: ignore[attr-defined]
    hand.press("left")
    assert hand.viewer.page == "picture"
    split(hand)
    hand.press("Ctrl+Z")
    assert hand.viewer.page == "picture"


def test_nothing_is_sampled_from_borrowed_words(tmp_path: Path) -> None:
    hand = hand_after("paint", tmp_path)
    split(hand)
    words = np.asarray(colors_on(hand)[..., 0])
    places = [(element, line) for line in range(0, len(words), 9) for element in range(0, 640, 9)]
    assert not any(hand.viewer.board.content.sample(*place) for place in places)


def test_a_variant_is_split_as_it_is_compared(tmp_path: Path) -> None:
    hand = hand_before(ball_scene(), tmp_path)
    hand.viewer.studio.keep_variant("A")
    for intensity in (0.5, 0.25):
        hand.viewer.session.edit(hand.viewer.session.scene.with_light("key", intensity=intensity))
    hand.turn_to("variants")
    hand.pick("compare")
    split(hand)
    assert hand.message.startswith("now: key: intensity 1 -> 0.25; ")
    assert np.array_equal(colors_on(hand)[MARKED.stop :, :300], field_of(ball_scene())[MARKED.stop :, :300])


def image_of(seed: int, count: int) -> DisplayImage:
    """An image with so many words of random colors."""
    random = np.random.default_rng(seed)
    words = random.integers(0, count, (40, 60)).astype(np.uint16)
    entries = random.integers(0, 256, (1024, 3)).astype(np.uint8)
    return SimpleNamespace(words=words, entries=entries)  # type: ignore[return-value]


@given(st.integers(0, 1000), st.integers(1, 1008), st.integers(1, 1008))
def test_no_color_is_farther_off_than_is_said(seed: int, one: int, other: int) -> None:
    images = image_of(seed, one), image_of(seed + 1, other)
    halves = halves_of(*images)
    assert len(halves.colors) <= SURFACE_WORDS
    table = np.zeros((1024, 3), np.uint8)
    table[FIRST : FIRST + len(halves.colors)] = halves.colors
    farthest = 0
    for image, words in zip(images, (halves.left, halves.right), strict=True):
        assert FIRST <= words.min() <= words.max() < SCREENS.first
        true = image.entries[image.words].astype(int)
        farthest = max(farthest, int(np.abs(table[words] - true).max()))
    assert farthest == halves.off
    distinct = {tuple(color) for image in images for color in image.entries[np.unique(image.words)]}
    assert (halves.off == 0) == (len(distinct) <= SURFACE_WORDS)


def test_halves_with_too_many_colors_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autocolor.screens.picture.split_screen.SURFACE_WORDS", 200)
    hand = hand_after("all paints", tmp_path)
    split(hand)
    off = hand.viewer.screens["split"].halves.off  # type: ignore[attr-defined]
    assert off > 0
    assert f"each half at coarser levels: colors within {off} of 255" in hand.message
