"""The variants screen: small pictures; the user comes back to a variant, or compares with it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

from autocolor.rendering import Rendering, rendering
from autocolor.scene.scene import Scene
from autocolor.screens.comparing import BEFORE, NamedScene
from autocolor.screens.gallery import (
    ELEMENTS,
    LINES,
    TILE_ELEMENTS,
    TILE_LINES,
    Gallery,
    Small,
    Tile,
    small_picture,
)
from autocolor.screens.naming import ask_name
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import PICTURE, Session
from autocolor.screens.steps import compare
from autocolor.widgets.items import LIGHT_GRAY, Area, text
from autocolor.widgets.menu import WORK, paged
from autocolor.widgets.widget import ROW_LINES, TEXT_DOWN, Button, Entry, Gap, Pair, Widget

STEP_ACROSS: Final = 124
STEP_DOWN: Final = 111

PLACES: Final = tuple(
    Area(left, top, left + TILE_ELEMENTS - 1, top + TILE_LINES - 1)
    for top in range(WORK.top + 4, WORK.bottom - TILE_LINES, STEP_DOWN)
    for left in range(8, WORK.right - TILE_ELEMENTS, STEP_ACROSS)
)
"""The places of the tiles of a page, as many as there is room for."""

ON_PAGE: Final = len(PLACES)

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
        self._gallery = Gallery()

    # The small pictures.

    def build(self, around: Surroundings) -> Content:
        help = "The next page of variants; at the left end, the page before."
        turn = partial(setattr, self, "_page")
        variants = [(name, each.scene) for name, each in self.session.studio.variants.items()]
        shown, turning = paged(variants, ON_PAGE, self._page, help, turn)
        return Content(
            items=[
                text(line, 16, WORK.top + ROW_LINES * number + TEXT_DOWN, LIGHT_GRAY)
                for number, line in enumerate(() if shown else EMPTY)
            ],
            loads=self._gallery.loads,
            rows=lambda: [*self._rows(), *turning],
            widgets=[self._tile(*each, area) for each, area in zip(shown, PLACES, strict=False)],
            idle=lambda: self._gallery.advance(
                {scene: partial(self._small_picture, scene) for _, scene in shown}
            ),
        )

    def _tile(self, name: str, scene: Scene, area: Area) -> Tile:
        help = f"Variant {name}: a click chooses it, another renames it"
        tile = Tile(name, help, run=partial(self._pick, name), is_chosen=name == self._present)
        return self._gallery.framed(scene, tile.at(area))

    def _small_picture(self, scene: Scene) -> Small:
        self._last = rendering(scene, 2 * LINES, 2 * ELEMENTS, self._last)
        return Small(small_picture(scene, self._last.picture))

    def enter(self) -> None:
        if self._present:
            self._choose(self._present)

    def leave(self) -> None:
        self._gallery.keep({variant.scene for variant in self.session.studio.variants.values()})
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
        return [
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

    def _pick(self, name: str) -> None:
        if name == self._present:
            self._ask_name()
        self._choose(name)

    def _choose(self, name: str) -> None:
        self._chosen = name
        self._page = list(self.session.studio.variants).index(name) // ON_PAGE

    def _keep(self) -> None:
        self._keep_as(None)
        self._ask_name()

    def _ask_name(self) -> None:
        ask_name(self.session, "variant", self._present, partial(self._rename, self._present))

    def _rename(self, name: str, new: str) -> None:
        if new != name:
            self.session.studio.rename_variant(name, new)
        self._choose(new)

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
