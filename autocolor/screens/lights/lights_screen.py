"""The lights screen: every parameter of the chosen light, over the picture; lights added, copied, removed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from autocolor.scene.lights.light import Light
from autocolor.scene.lights.new_lights import new_light_of
from autocolor.screens.input.gestures import Gesture
from autocolor.screens.lights.half_space_rows import half_space_rows
from autocolor.screens.lights.light_parameters import parameter_rows
from autocolor.screens.lights.plane_picking import PlanePicking
from autocolor.screens.picture.light_handles import LightHandles
from autocolor.screens.picture.over_picture import OverPicture
from autocolor.screens.screen import Handle
from autocolor.screens.session import Session
from autocolor.widgets.items import Item
from autocolor.widgets.menu import WORK
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Choice, Gap, Widget


class LightsScreen(OverPicture):
    """The lights, one at a time."""

    name = "lights"
    title = "lights"
    help = "The chosen light: drag its highlight, and where its cone, flaps and half-spaces end"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._handles = LightHandles(session, WORK, has_rims=True)
        self._picking = PlanePicking(session, WORK)

    def items(self) -> Sequence[Item]:
        return [*super().items(), *(self._picking if self._picking.is_on else self._handles).items()]

    def handles(self) -> Sequence[Handle]:
        return () if self._picking.is_on else self._handles.handles()

    def pick(self, gesture: Gesture) -> None:
        if self._picking.is_on:
            self._picking.pick(gesture.element, gesture.line)
        else:
            super().pick(gesture)

    def escape(self) -> bool:
        return self._picking.end()

    def leave(self) -> None:
        self._picking.end()

    def place(self, handle: Handle, element: int, line: int) -> None:
        self._handles.place(handle, element, line)

    def rows(self) -> Sequence[Widget]:
        light = self.session.chosen_light
        if light is None:
            return [
                Button(
                    "add a light", "A light above the side of the eye, aimed at the object.", run=self._add
                )
            ]
        return [
            Choice(
                "light",
                "The light whose parameters these are.",
                names=tuple(each.name for each in self.session.scene.lights),
                present=light.name,
                choose=self.session.choose_light,
            ),
            *self._verbs(light),
            Gap("parameters gap"),
            *parameter_rows(self.session, light, leave_out=("half_spaces",)),
            Gap("half-spaces gap"),
            *half_space_rows(self.session, light, self._picking),
        ]

    def _verbs(self, light: Light) -> list[Widget]:
        session = self.session
        return [
            Pair(
                "alone",
                "This light alone; or all lights on.",
                run=partial(session.light_alone, light.name),
                other="all on",
                run_other=session.all_lights_on,
            ),
            Pair(
                "add",
                "Another light, or a copy of this one.",
                run=self._add,
                other="copy",
                run_other=self._copy,
            ),
            Pair(
                "mirror",
                "A copy of this light on the other side of the object; or take this light away.",
                run=self._mirror,
                other="remove",
                run_other=self._remove,
            ),
            Button("save the rig", "Save all lights, to put them on another scene.", run=session.save_rig),
        ]

    def _add(self) -> None:
        light = new_light_of(self.session.scene)
        scene = self.session.scene
        self.session.edit(scene.replace(lights=(*scene.lights, light)))
        self.session.choose_light(light.name)
        self.session.tell(f"light added: {light.name}")

    def _copy(self) -> None:
        self._append(self.session.scene.with_copied_light(self.session.light_name).lights, "copied")

    def _mirror(self) -> None:
        # The sides of a product are those of its shorter horizontal extent.
        (x, y, _), (to_x, to_y, _) = self.session.scene.object_bounds
        axis = "x" if to_x - x <= to_y - y else "y"
        lights = self.session.scene.with_mirrored_light(self.session.light_name, axis).lights
        self._append(lights, f"mirrored along {axis}")

    def _append(self, lights: tuple[Light, ...], done: str) -> None:
        before = self.session.light_name
        self.session.edit(self.session.scene.replace(lights=lights))
        self.session.choose_light(lights[-1].name)
        self.session.tell(f"light {before} {done}: {lights[-1].name}")

    def _remove(self) -> None:
        name = self.session.light_name
        self.session.edit(self.session.scene.without_light(name))
        self.session.tell(f"light {name} removed; undo brings it back")
