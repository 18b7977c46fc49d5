"""A hand on the unit of a display that shows the boxes, and what it sees."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from autocolor import Scene
from autocolor.mapping.ranges import SCREENS
from autocolor.screens.viewer import Viewer
from autocolor.widgets.menu import WORK
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import boxes


def hand_at(folder: Path, screen: str, scene: Scene | None = None) -> Hand:
    """A hand before a screen, to which it went by the strip."""
    hand = Hand(Viewer(boxes() if scene is None else scene, Ramtek9300(), folder))
    hand.turn_to(screen)
    assert hand.viewer.session.screen == screen
    return hand


def told(hand: Hand) -> tuple[str, bool]:
    """The message, and whether it is a warning."""
    news = hand.viewer.session.news
    return news.text, news.is_warning


def hint_of(hand: Hand, label: str) -> str:
    """What the message line says while the pointer is on a row."""
    place = hand.middle(label)
    hand.viewer.tell("")
    hand.move(*place)
    return hand.hint


def undo(hand: Hand) -> None:
    """Pick undo in the menu."""
    hand.pick(" ")


def words_are_those_of_the_scene(hand: Hand) -> bool:
    """Whether the display has the words of the picture beside the strip and panels, but for lines over it."""
    studio = hand.viewer.studio
    shown, words = np.array(hand.display.words[:200, :500]), studio.words[:200, :500]
    shown[: WORK.top] = words[: WORK.top]
    for left, top, right, bottom in (widget.area for widget in hand.viewer.board.content.widgets):
        shown[top : bottom + 1, left : right + 1] = words[top : bottom + 1, left : right + 1]
    others = shown[shown != words]
    return len(others) < words.size // 50 and bool((others >= SCREENS.first).all())
