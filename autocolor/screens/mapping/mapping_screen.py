"""The mapping screen: how intensities become levels, with the curve, whose points can be dragged.

Paper: "The Lighting Model": intensities are mapped by the range of each surface or of the object; nonlinear
mappings can be tried. Nothing of this renders again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache, partial
from typing import Any, Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.picture import Picture
from autocolor.mapping.exposure import mapped_ranges
from autocolor.mapping.intensity_mapping import fractions_by_surface
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.scene.scene import AUTO, Exposure
from autocolor.screens.input.gestures import Gesture
from autocolor.screens.mapping.curve_panel import (
    ACROSS,
    PANEL,
    Curve,
    fractions_of,
    panel_items,
    place_of,
    shares_of,
)
from autocolor.screens.mapping.curve_points import STRAIGHT, added, moved, removed
from autocolor.screens.mapping.held_ranges import held_rows
from autocolor.screens.picture.over_picture import OverPicture
from autocolor.screens.screen import Handle
from autocolor.screens.session import Session
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.items import Item
from autocolor.widgets.widget import Button, Choice, Gap, Widget

POINTS: Final = "points"
HELD: Final = "held"


class MappingScreen(OverPicture):
    """The mapping of the scene, over the picture."""

    name = "mapping"
    title = "mapping"
    help = "How intensities become levels; click in the picture: the surface whose curve is shown"

    has_room_at_left = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._touched: int | None = None
        """The number of the point that was touched last."""

    # The menu.

    def rows(self) -> Sequence[Widget]:
        scene, session = self.session.scene, self.session
        others = ("name", "view", "scalar")
        return [
            Choice(
                "mapping",
                "How intensities are mapped to levels; a click in the curve makes points of it.",
                names=(*CURVES, POINTS),
                present=scene.mapping if isinstance(scene.mapping, str) else POINTS,
                choose=self._choose,
            ),
            Button("straight", "A straight curve with five points.", run=partial(self._put_points, STRAIGHT)),
            self._remove_row(),
            Gap("exposure gap"),
            Choice(
                "exposure",
                "Auto: the range of intensities is the picture's. Held: it stays, and less light is darker.",
                names=(AUTO, HELD),
                present=AUTO if scene.exposure == AUTO else HELD,
                choose=self._expose,
            ),
            *held_rows(session, self._put),
            Gap("scene gap"),
            *rows_of(scene, self._put, session.world, leave_out=others),
        ]

    def _remove_row(self) -> Widget:
        touched, points = self._touched, self._points()
        why_not = ""
        if not points:
            why_not = "a curve with a name has no points; click in it to make some"
        elif touched is None or touched >= len(points):
            why_not = "click at a point of the curve first"
        elif touched in (0, len(points) - 1):
            why_not = "the ends of the curve stay; click at another point first"
        return Button(
            "remove point",
            "Remove the point that was touched last, which is yellow.",
            why_not,
            run=self._remove,
        )

    # The curve.

    def items(self) -> Sequence[Item]:
        return [*super().items(), *panel_items(self._curve())]

    def handles(self) -> Sequence[Handle]:
        return [
            Handle(number, *place_of(x, y), f"intensity {x:.2f}, level {y:.2f}")
            for number, (x, y) in enumerate(self._points())
        ]

    def hold(self, handle: Handle) -> None:
        if isinstance(handle.key, int):
            self._touched = handle.key

    def place(self, handle: Handle, element: int, line: int) -> None:
        points, number = self._points(), handle.key
        if isinstance(number, int) and number < len(points):
            points = moved(points, number, *fractions_of(element, line))
            self._put_points(points)
            x, y = points[number]
            self.session.tell(f"intensity {x:.2f}, level {y:.2f}")

    def pick(self, gesture: Gesture) -> None:
        if not PANEL.has(gesture.element, gesture.line):
            super().pick(gesture)
            return
        points = self._points() or self._points_of_curve()
        points, self._touched = added(points, *fractions_of(gesture.element, gesture.line))
        self._put_points(points)

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        # What is dragged on the panel beside its points does not turn the object behind it.
        if not PANEL.has(start.element, start.line):
            super().drag(start, last, now)

    def wheel(self, gesture: Gesture) -> None:
        if not PANEL.has(gesture.element, gesture.line):
            super().wheel(gesture)

    def hint(self, element: int, line: int) -> str:
        if not PANEL.has(element, line):
            return super().hint(element, line)
        x, y = fractions_of(element, line)
        return f"intensity {x:.2f}, level {y:.2f}: a click adds a point; points are dragged"

    def _points(self) -> CurvePoints:
        """The points of the curve; none of one that has a name."""
        mapping = self.session.scene.mapping
        return () if isinstance(mapping, str) else mapping

    def _put_points(self, points: CurvePoints) -> None:
        self._put({"mapping": points})

    def _points_of_curve(self) -> CurvePoints:
        """Points on the curve that is shown."""
        xs = np.array([x for x, _ in STRAIGHT], np.float32)
        ys = np.interp(xs, ACROSS, self._curve().levels)
        rising = np.maximum.accumulate(ys.round(4).clip(0, 1))
        return tuple(zip(xs.tolist(), rising.tolist(), strict=True))

    def _curve(self) -> Curve:
        session, scene = self.session, self.session.scene
        curve = curve_of(
            session.studio.image.mapped, scene.scaling, scene.mapping, scene.exposure, session.surface_name
        )
        levels, shares = (ACROSS, np.zeros_like(ACROSS)) if curve is None else curve
        return Curve(session.surface_name, levels, shares, self._points(), self._touched)

    # What the rows do.

    def _choose(self, name: str) -> None:
        if name != POINTS:
            self._put({"mapping": name})
        elif not self._points():
            self._put_points(self._points_of_curve())

    def _remove(self) -> None:
        if self._touched is not None:
            self._put_points(removed(self._points(), self._touched))
            self._touched = None

    def _expose(self, how: str) -> None:
        if how == AUTO:
            self._put({"exposure": AUTO})
            self.session.tell("the exposure follows the picture")
            return
        self.session.studio.hold_exposure()
        if self.session.scene.exposure == AUTO:
            self.session.warn(
                "to hold the exposure, a surface must have different intensities, and none has;"
                " switch a light on"
            )
        else:
            self.session.tell("exposure held: less light is darker")

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.replace(**changes))


@lru_cache(maxsize=4)
def curve_of(
    picture: Picture, scaling: str, mapping: str | CurvePoints, exposure: Exposure, name: str
) -> tuple[Singles, Singles] | None:
    """The levels, 0 to 1, and the shares of the intensities of a surface across its mapped range.

    None for a surface that is not visible.
    """
    number = picture.surfaces.index(name) + 1 if name in picture.surfaces else 0
    extents = mapped_ranges(picture, scaling, exposure)
    curves = fractions_by_surface(picture, extents, mapping, only=number)
    if number not in curves:
        return None
    low, high = extents[number]
    # The sum may exceed the maximum by rounding, where a curve has no value.
    levels = curves[number](np.minimum(np.float32(low) + ACROSS * np.float32(high - low), np.float32(high)))
    return levels, _shares(picture, number, low, high)


@lru_cache(maxsize=4)
def _shares(picture: Picture, number: int, low: float, high: float) -> Singles:
    """How often the intensities of a visible surface are seen, which no curve changes."""
    seen = next(surface for surface in picture.slices if surface.surface_number == number)
    return shares_of(picture.relative[seen.pixels], low, high)
