"""The screen of kept variants: small pictures of them, to come back to one, or to compare with it.

Nothing else is shown there, so the small pictures borrow the words of all surfaces: each has a share of them,
with the colors that it needs most.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.mapping.display_image import display_image
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS
from autocolor.mapping.palette import in_palette
from autocolor.mapping.thumbnail import thumbnail
from autocolor.rendering import render
from autocolor.scene.scene import Scene
from autocolor.screens.comparing import BEFORE, Other
from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, fitted, image, outline, text
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Entry, Gap, Place, Widget

LINES: Final = 84
ELEMENTS: Final = 112
"""The size of a small picture."""

ACROSS: Final = 4
DOWN: Final = 4
STEP_ACROSS: Final = 124
STEP_DOWN: Final = 114
"""The places of the small pictures."""

MOST_COLORS: Final = 200
"""Assumed: the most colors of one; more are not seen at this size."""


class KeptScreen(Screen):
    """The kept variants, and the present scene."""

    name = "kept"
    title = "kept"
    help = "Click a kept variant to choose it; then come back to it, or drop it"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._chosen = ""
        self._page = 0

    def _names(self) -> list[str]:
        """The variants of this page."""
        names = list(self.session.studio.variants)
        pages = max(1, -(-len(names) // (ACROSS * DOWN)))
        self._page %= pages
        return names[self._page * ACROSS * DOWN : (self._page + 1) * ACROSS * DOWN]

    def _pictures(self) -> list[tuple[int, Words, Bytes]]:
        """The first entry, the words and the colors of each small picture."""
        names = self._names()
        if not names:
            return []
        each = min(MOST_COLORS, (SCREENS.first - BACKGROUND - 1) // len(names))
        found, first = [], BACKGROUND + 1
        for name in names:
            places, colors = small_picture(self.session.studio.variants[name].scene, each)
            found.append((first, (places + first).astype(np.uint16), colors))
            first += each
        return found

    def loads(self) -> Sequence[tuple[int, Bytes]]:
        return [(first, colors) for first, _, colors in self._pictures()]

    def items(self) -> Sequence[Item]:
        if not self.session.studio.variants:
            return [
                text("no variant is kept yet", 16, 16, LIGHT_GRAY),
                text("keep: the scene as it is now, to come back to it or to compare", 16, 32, GRAY),
            ]
        found = []
        for (_, words, _), area in zip(self._pictures(), places(), strict=False):
            found.append(image(words, area.left + 4, area.top + 4))
        return found

    def widgets(self) -> Sequence[Widget]:
        return [
            Variant(
                name,
                f"Variant {name}: a click chooses it.",
                run=partial(self._choose, name),
                is_chosen=name == self._present,
            ).at(area)
            for name, area in zip(self._names(), places(), strict=False)
        ]

    @property
    def _present(self) -> str:
        """The chosen variant; the last one kept where none is chosen."""
        names = list(self.session.studio.variants)
        return self._chosen if self._chosen in names else names[-1] if names else ""

    def rows(self) -> Sequence[Widget]:
        studio, name = self.session.studio, self._present
        why_not = "" if name else "no variant is kept yet"
        found: list[Widget] = [
            Button("keep", "Keep the scene as it is now under a free letter.", run=self._keep),
            Entry("keep as", "Keep the scene under a name of your own.", take=self._keep_as),
            Gap("chosen gap"),
            Button(
                "come back",
                f"Make {name} the current scene again; undo goes back.",
                why_not,
                run=self._come_back,
                value=name,
            ),
            Pair(
                "compare",
                f"Compare with {name}, here and by the key; or with the state before the last step again.",
                why_not,
                run=self._compare,
                other="off",
                run_other=self._compare_with_before,
            ),
            Button("drop", f"Keep {name} no longer.", why_not, run=self._drop, value=name),
        ]
        if len(studio.variants) > ACROSS * DOWN:
            found.append(
                Pair("before", "The other variants.", run=self._turn, other="next", run_other=self._turn)
            )
        return found

    def _choose(self, name: str) -> None:
        self._chosen = name

    def _keep(self) -> None:
        self._chosen = self.session.studio.keep_variant()
        self.session.tell(f"kept as {self._chosen}")

    def _keep_as(self, name: str) -> None:
        self._chosen = self.session.studio.keep_variant(name)
        self.session.tell(f"kept as {name}")

    def _come_back(self) -> None:
        self.session.studio.show_variant(self._present)
        self.session.tell(f"{self._present} is the scene again")

    def _compare(self) -> None:
        session, name = self.session, self._present
        session.comparing.choose(Other(f"variant {name}", session.studio.variants[name].scene))
        session.turn_to(PICTURE)
        session.compare()

    def _compare_with_before(self) -> None:
        self.session.comparing.choose(None)
        self.session.tell(f"compared from now on: {BEFORE}")

    def _drop(self) -> None:
        name = self._present
        kept = self.session.studio.variants[name]
        self.session.studio.drop_variant(name)
        self.session.comparing.forget(kept.scene)
        self.session.tell(f"{name} is kept no longer")

    def _turn(self) -> None:
        self._page += 1


class Variant(Button):
    """The frame of a small picture with its name below."""

    def items(self, lit: bool) -> list[Item]:
        word = YELLOW if self.is_chosen else LIGHT_GRAY if lit else SLATE
        area = self.area
        top = area.bottom - 12
        name = fitted(self.label, (area.width - 8) // CHARACTER)
        return [
            outline(area._replace(bottom=area.top + LINES + 7), word),
            filled(Area(area.left, top, area.right, area.bottom), NIGHT),
            text(name, area.left + 4, top + 2, YELLOW if self.is_chosen else WHITE),
        ]

    def pick(self, place: Place) -> object:
        return self.run()


def places() -> list[Area]:
    """Where the small pictures stand, with their frames and names."""
    return [
        Area(left, top, left + ELEMENTS + 7, top + LINES + 7 + 14)
        for top in range(8, 8 + DOWN * STEP_DOWN, STEP_DOWN)
        for left in range(8, 8 + ACROSS * STEP_ACROSS, STEP_ACROSS)
    ]


@lru_cache(maxsize=64)
def small_picture(scene: Scene, most: int) -> tuple[Words, Bytes]:
    """A scene as a small picture: the number of a color at each pixel, (84, 112), and the colors."""
    picture = render(scene, lines=2 * LINES, elements=2 * ELEMENTS)
    return in_palette(thumbnail(display_image(scene, picture), LINES, ELEMENTS), most)
