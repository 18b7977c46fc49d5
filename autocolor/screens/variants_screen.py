"""The variants screen: small pictures; the user comes back to a variant, or compares with it.

The screen shows no surface, so the small pictures borrow the words of all surfaces: every picture has an
equal share of the words, for the colors that it needs most.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.errors import InputError
from autocolor.images import display_image
from autocolor.mapping.palette import thumbnail
from autocolor.mapping.ranges import BACKGROUND, SCREENS
from autocolor.rendering import Rendering, rendering
from autocolor.scene.scene import Scene
from autocolor.screens.comparing import BEFORE, NamedScene
from autocolor.screens.naming import name_variant
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import PICTURE, Session
from autocolor.screens.steps import compare
from autocolor.widgets.items import (
    CHARACTER,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    SmallPicture,
    filled,
    outline,
    text,
)
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import (
    ROW_LINES,
    TEXT_DOWN,
    Button,
    Entry,
    Gap,
    Pair,
    Place,
    Widget,
    page_choice,
    short_name,
)

LINES: Final = 84
ELEMENTS: Final = 112
"""The size of a small picture."""

ACROSS: Final = 4
DOWN: Final = 4
ON_PAGE: Final = ACROSS * DOWN
STEP_ACROSS: Final = 124
STEP_DOWN: Final = 111
FRAME: Final = 4
NAME_LINES: Final = 14

PLACES: Final = tuple(
    Area(left, top, left + ELEMENTS + 2 * FRAME - 1, top + LINES + 2 * FRAME - 1 + NAME_LINES)
    for top in range(WORK.top + 4, WORK.top + 4 + DOWN * STEP_DOWN, STEP_DOWN)
    for left in range(8, 8 + ACROSS * STEP_ACROSS, STEP_ACROSS)
)
"""Where the small pictures stand, with their frames and names."""

MOST_COLORS: Final = 200
"""Assumed: the most colors of a small picture; more are not seen at this size."""


EMPTY: Final = ("no variant is kept yet", "keep the scene as it is now, and come back to it later")
"""The lines of the screen before a variant is kept."""


class VariantsScreen(Screen):
    """The variants as small pictures. While nothing moves, the missing pictures are computed in turn."""

    name = "variants"
    title = "variants"
    word = "variant"
    help = "Click a variant to choose it; then come back to it, or drop it"
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._chosen = ""
        self._page = 0
        self._last: Rendering | None = None
        """The rendering of the last small picture; the next rendering reuses what did not change."""
        self._small: dict[Scene, SmallPicture] = {}

    # The small pictures.

    @property
    def _pages(self) -> list[list[str]]:
        """The names of the variants, page by page; one page if there are none."""
        names = list(self.session.studio.variants)
        return [names[first : first + ON_PAGE] for first in range(0, len(names), ON_PAGE)] or [[]]

    def _names(self) -> list[str]:
        """The variants of this page."""
        pages = self._pages
        return pages[min(self._page, len(pages) - 1)]

    def _scenes(self) -> list[Scene]:
        """The scenes of this page."""
        return [self.session.studio.variants[name].scene for name in self._names()]

    def _share(self) -> int:
        """How many colors a small picture of this page may have."""
        return min(MOST_COLORS, (SCREENS.first - BACKGROUND - 1) // max(1, len(self._names())))

    def _shown(self) -> list[tuple[Area, int, SmallPicture]]:
        """The computed small pictures of this page, with their areas and the first of their words."""
        share = self._share()
        shown = []
        for number, (scene, area) in enumerate(zip(self._scenes(), PLACES, strict=False)):
            small = self._small.get(scene)
            if small is not None and small.most == share:
                shown.append((area, BACKGROUND + 1 + number * share, small))
        return shown

    def build(self, around: Surroundings) -> Content:
        shown = self._shown()
        return Content(
            items=[small.item(first, area.left + FRAME, area.top + FRAME) for area, first, small in shown]
            if self.session.studio.variants
            else [
                text(line, 16, WORK.top + ROW_LINES * number + TEXT_DOWN, LIGHT_GRAY)
                for number, line in enumerate(EMPTY)
            ],
            loads=[(first, small.colors) for _, first, small in shown],
            rows=self._rows,
            widgets=self._buttons(),
            idle=self._idle,
        )

    def _buttons(self) -> Sequence[Widget]:
        return [
            VariantButton(
                name,
                f"Variant {name}: a click chooses it",
                run=partial(self._choose, name),
                is_chosen=name == self._present,
            ).at(area)
            for name, area in zip(self._names(), PLACES, strict=False)
        ]

    def _idle(self) -> bool:
        """Compute the next missing small picture."""
        share = self._share()
        for scene in self._scenes():
            small = self._small.get(scene)
            if small is None or small.most != share:
                colors = self._colors_of(scene) if small is None else small.full
                self._small[scene] = SmallPicture(colors, share)
                return True
        return False

    def _colors_of(self, scene: Scene) -> Bytes:
        """The colors of a small picture, (84, 112, 3); black if the scene is refused at this size."""
        try:
            self._last = rendering(scene, 2 * LINES, 2 * ELEMENTS, self._last)
            return thumbnail(display_image(scene, self._last.picture), LINES, ELEMENTS)
        except InputError:
            # At this size a surface that the whole picture hides may be visible, and too bright.
            return np.zeros((LINES, ELEMENTS, 3), np.uint8)

    def enter(self) -> None:
        if self._present:
            self._choose(self._present)

    def leave(self) -> None:
        scenes = {variant.scene for variant in self.session.studio.variants.values()}
        self._small = {scene: small for scene, small in self._small.items() if scene in scenes}
        self._last = None

    # The menu.

    @property
    def _present(self) -> str:
        """The chosen variant, else the last variant; empty without variants."""
        names = list(self.session.studio.variants)
        return self._chosen if self._chosen in names else names[-1] if names else ""

    def _rows(self) -> Sequence[Widget]:
        name = self._present
        why_not = "" if name else "no variant is kept yet"
        rows: list[Widget] = [
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
                f"Compare with {name}, also by the key B; or with the state before the last step.",
                why_not,
                run=self._compare,
                other="off",
                run_other=self._compare_with_before,
            ),
            Button("drop", f"Drop variant {name}.", why_not, run=self._drop, value=name),
        ]
        pages = len(self._pages)
        if pages > 1:
            help = "The next page of variants; at the left end, the page before."
            page = min(self._page, pages - 1)
            rows.append(page_choice(help, page, pages, partial(setattr, self, "_page")))
        return rows

    def _choose(self, name: str) -> None:
        self._chosen = name
        self._page = list(self.session.studio.variants).index(name) // ON_PAGE

    def _keep(self) -> None:
        self._keep_as(None)
        name_variant(self.session, self._chosen)

    def _keep_as(self, name: str | None) -> None:
        name = self.session.studio.keep_variant(name)
        self._choose(name)
        self.session.tell(f"kept as {name}")

    def _come_back(self) -> None:
        self.session.studio.show_variant(self._present)
        self.session.tell(f"{self._present} is the scene again; undo goes back")
        self.session.turn_to(PICTURE)

    def _compare(self) -> None:
        session, name = self.session, self._present
        session.comparing.choose(NamedScene(f"variant {name}", session.studio.variants[name].scene))
        session.turn_to(PICTURE)
        compare(session)

    def _compare_with_before(self) -> None:
        self.session.comparing.choose(None)
        self.session.tell(f"compared from now on: {BEFORE}")

    def _drop(self) -> None:
        name = self._present
        variant = self.session.studio.variants[name]
        self.session.studio.drop_variant(name)
        self.session.comparing.forget(variant.scene)
        self.session.tell(f"variant {name} dropped")


class VariantButton(Button):
    """The frame of a small picture with its name below."""

    def items(self, lit: bool) -> list[Item]:
        word = YELLOW if self.is_chosen else LIGHT_GRAY if lit else SLATE
        area = self.area
        top = area.bottom - 12
        name = short_name(self.label, (area.width - 8) // CHARACTER)
        return [
            outline(area._replace(bottom=area.top + LINES + 2 * FRAME - 1), word),
            filled(Area(area.left, top, area.right, area.bottom), NIGHT),
            text(name, area.left + FRAME, top + 2, YELLOW if self.is_chosen else WHITE),
        ]

    def pick(self, place: Place) -> object:
        return self.run()
