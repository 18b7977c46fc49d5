"""The picture screen: the whole picture, over which the main menu comes on demand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from autocolor.scene.kinds import in_digits
from autocolor.scene.orbit import sides_of
from autocolor.screens.file_actions import ask_to_leave, seeming_up, stand_up
from autocolor.screens.light_parameters import all_lights_on, light_alone
from autocolor.screens.picture import picture_edits as edits
from autocolor.screens.picture.light_handles import LightHandles
from autocolor.screens.picture.over_picture import OverPicture, camera_rows, light_switches, surface_row
from autocolor.screens.picture.picture_edits import CLOSER, TURN
from autocolor.screens.screen import Content, Surroundings, surface_at
from autocolor.screens.session import PICTURE, SENT, Session
from autocolor.widgets.items import SCREEN
from autocolor.widgets.menu import WORK, Section
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Button, Choice, Entry, Pair, Steps, Widget, titled

PAN: Final = 16.0
"""Elements or lines for each step of a menu row that moves the picture."""


class PictureScreen(OverPicture):
    """The picture."""

    name = PICTURE
    title = "picture"
    word = "picture"
    help = "drag: turn; click: choose a surface; Tab or the right edge: the menu"
    has_menu = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._handles = LightHandles(session, SCREEN, has_rims=False)
        self._has_marks = False
        """Whether the highlights are marked: the pointer rests on the object."""

    def build(self, around: Surroundings) -> Content:
        session, content = self.session, super().build(around)
        self._handles.area = WORK if around.has_menu else SCREEN
        is_on_object = bool(surface_at(session.studio, *around.pointer))
        may_mark = is_on_object and around.has_panels and not session.explains

        def idle() -> bool:
            had_marks, self._has_marks = self._has_marks, may_mark
            return may_mark != had_marks

        marks = self._handles.items() if self._has_marks and may_mark else ()
        return replace(
            content,
            items=[*content.items, *marks],
            # A click that explains a pixel picks no handle.
            handles=() if session.explains else [*content.handles, *self._handles.handles()],
            preferred=self._handles.preferred,
            rows=self._rows,
            escape=self._escape,
            idle=idle,
        )

    def hint(self, element: int, line: int) -> str:
        names, _ = self.pointed(element, line)
        does = "click explains" if self.session.explains else "drag turns, click chooses, Shift explains"
        return f"{', '.join(names)}: {does}" if names else self.help

    def _rows(self) -> Sequence[Widget]:
        session, light, up = self.session, self.session.light_name, seeming_up(self.session)
        on_its_side = Button(
            "on its side? turn",
            f"The mesh seems to lie on its side: read it again with {up} up, or do nothing.",
            run=partial(stand_up, session),
        )
        alone = Pair(
            "alone",
            f"Switch on {titled('light', light)} alone, and again: the lights as before; or all lights.",
            run=partial(light_alone, session, light),
            other="all on",
            run_other=partial(all_lights_on, session),
        )
        return [
            *([on_its_side] if up else []),
            surface_row(session, "The surface that you edit; a click in the picture chooses, too."),
            *self._stage_rows(),
            Section("light switches"),
            *light_switches(session, light, self._choose_light),
            *([alone] if light else []),
            Section("turn & move"),
            Choice(
                "view",
                "Look at the object from a side.",
                names=tuple(sides_of(session.scene)),
                present=edits.present_side(session),
                choose=partial(edits.see_from, session),
            ),
            Steps(
                "turn",
                "Turn around the object.",
                step=lambda n: edits.turn(session, n * TURN, 0),
                signs=("<", ">"),
            ),
            Steps("rise", "Look from lower or from higher.", step=lambda n: edits.turn(session, 0, n * TURN)),
            Steps("closer", "Move farther or closer.", step=lambda n: edits.move(session, CLOSER**n)),
            Steps(
                "move",
                "Move the picture sideways.",
                step=lambda n: edits.pan(session, n * PAN, 0),
                signs=("<", ">"),
            ),
            Steps("lift", "Move the picture down or up.", step=lambda n: edits.pan(session, 0, -n * PAN)),
            Section("other actions"),
            Pair(
                "rescale",
                "Fill the picture with the object, or with the chosen surface.",
                run=partial(edits.rescale, session),
                other="surface",
                run_other=partial(edits.rescale, session, session.surface_name),
            ),
            Pair(
                "as opened",
                f"Look as the scene's file says; or fill the picture with {session.part_name or 'a part'}.",
                run=partial(edits.as_opened, session),
                other="part",
                run_other=partial(edits.rescale_part, session),
            ),
            *camera_rows(session),
            Button(
                "watch",
                "Let the picture come in line by line, as in 1983.",
                run=partial(setattr, session, "watches", True),
            ),
            Button(
                "explain a pixel",
                "Click a pixel next: every number that leads to its color; also Shift and a click.",
                run=self._explain,
            ),
            Button(
                "what was sent",
                "The instructions that the last edit sent to the display.",
                run=partial(session.turn_to, SENT),
            ),
            Button(
                "leave",
                "Leave the program; you are asked first about unsaved changes.",
                run=partial(ask_to_leave, session),
            ),
        ]

    def _explain(self) -> None:
        self.session.explains = True
        self.session.tell("click the pixel to explain", persistent=True)

    def _escape(self) -> bool:
        explains, self.session.explains = self.session.explains, False
        return explains

    def leave(self) -> None:
        self.session.explains = self._has_marks = False

    def _stage_rows(self) -> list[Widget]:
        """The row of the stage of the object, and where there is a backdrop, the rows of its two colors."""
        session, colors = self.session, self.session.scene.backdrop_colors

        def put(changes: Mapping[str, Any]) -> None:
            session.edit(session.scene.replace(**changes))

        rows = rows_of(session.scene, put, session.world, columns=("stage",))
        help = "The color behind everything at the top or the bottom of the picture, as a name or #rrggbb."
        if colors:
            top, low = colors
            rows += [
                Entry("backdrop", help, value=in_digits(top), take=lambda top: put({"backdrop": [top, low]})),
                Entry("  bottom", help, value=in_digits(low), take=lambda low: put({"backdrop": [top, low]})),
            ]
        return rows

    def _choose_light(self, name: str) -> None:
        self.session.choose_light(name)
        self.session.tell(titled("light", name))
