"""The mapping screen: how intensities become levels, with the curve, whose points can be dragged.

Paper: "The Lighting Model": intensities are mapped by the range of each surface or of the object; nonlinear
mappings can be tried. Nothing of this renders again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache, partial
from typing import Any, Final

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.lighting.picture import IntensityRange, Picture
from autocolor.mapping.exposure import mapped_ranges
from autocolor.mapping.intensity_mapping import fractions_by_surface
from autocolor.scene.curves import CURVES, CurvePoints, Fractions
from autocolor.scene.scene import AUTO, Exposure
from autocolor.screens.gestures import Gesture
from autocolor.screens.over_picture import OverPicture
from autocolor.screens.screen import Handle
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.items import Item, filled, lines, outline, text
from autocolor.widgets.menu import WORK
from autocolor.widgets.pairs import Pair
from autocolor.widgets.widget import Button, Choice, Gap, Widget

PANEL: Final = Area(8, WORK.bottom - 215, 223, WORK.bottom - 8)
"""The panel of the curve, at the lower left of the picture."""

CURVE: Final = Area(PANEL.left + 8, PANEL.top + 16, PANEL.right - 8, PANEL.bottom - 8)
"""Where the curve is: intensity rises to the right, the level upward."""

POINTS: Final = "points"
STRAIGHT: Final[CurvePoints] = ((0.0, 0.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.75), (1.0, 1.0))
LEAST_APART: Final = 0.01
"""Assumed: the smallest distance of two points along the intensities."""


class MappingScreen(OverPicture):
    """The mapping of the scene, over the picture."""

    name = "mapping"
    title = "mapping"
    help = "How intensities become levels; drag the points of the curve"

    def rows(self) -> Sequence[Widget]:
        session = self.session
        scene = session.scene
        present = scene.mapping if isinstance(scene.mapping, str) else POINTS
        others = ("name", "background", "view")
        return [
            Choice(
                "mapping",
                "How intensities are mapped to levels; points can be dragged.",
                names=(*CURVES, POINTS),
                present=present,
                choose=self._choose,
            ),
            Button("straight", "A straight curve with five points.", run=partial(self._put_points, STRAIGHT)),
            Gap("exposure gap"),
            Pair(
                "hold",
                "Hold the exposure, so that less light is darker; or let it follow the picture.",
                run=self._hold,
                other="auto",
                run_other=self._release,
            ),
            Gap("scene gap"),
            *rows_of(scene, self._put, session.world, leave_out=others),
        ]

    def items(self) -> Sequence[Item]:
        xs = np.linspace(0, 1, CURVE.width, dtype=np.float32)
        levels = self._levels(xs)
        at_ends = [(0, 0), (0, 1), (1, 1), (1, 0), (0, 0)]
        found = [
            filled(PANEL, NIGHT),
            outline(PANEL, SLATE),
            text("level", CURVE.left, PANEL.top + 4, LIGHT_GRAY),
            text("intensity", CURVE.right - 62, CURVE.bottom - 10, GRAY),
            lines([places_of(at_ends)], SLATE, CURVE),
            lines([places_of(list(zip(xs.tolist(), levels.tolist(), strict=True)))], YELLOW, CURVE),
        ]
        for x, y in self._points():
            element, line = place_of(x, y)
            found.append(filled(Area(element - 2, line - 2, element + 2, line + 2).within(PANEL), WHITE))
        return found

    def handles(self) -> Sequence[Handle]:
        return [
            Handle(number, *place_of(x, y), f"intensity {x:.2f}, level {y:.2f}")
            for number, (x, y) in enumerate(self._points())
        ]

    def place(self, handle: Handle, element: int, line: int) -> None:
        points = list(self._points())
        number = handle.key
        if not isinstance(number, int) or number >= len(points):
            return
        x, y = fractions_of(element, line)
        # The ends stay at the ends, and the curve stays a rising one.
        if 0 < number < len(points) - 1:
            x = min(max(x, points[number - 1][0] + LEAST_APART), points[number + 1][0] - LEAST_APART)
        else:
            x = points[number][0]
        low = points[number - 1][1] if number else 0.0
        high = points[number + 1][1] if number < len(points) - 1 else 1.0
        points[number] = (round(x, 4), round(min(max(y, low), high), 4))
        self._put_points(tuple(points))
        self.session.tell(f"intensity {points[number][0]:.2f}, level {points[number][1]:.2f}")

    def pick(self, gesture: Gesture) -> None:
        if not PANEL.has(gesture.element, gesture.line):
            super().pick(gesture)
            return
        # A click on the panel adds a point.
        x, y = fractions_of(gesture.element, gesture.line)
        points = self._points()
        if all(abs(x - other) > LEAST_APART for other, _ in points):
            below = [b for a, b in points if a < x]
            above = [b for a, b in points if a > x]
            y = min(max(y, below[-1]), above[0])
            self._put_points(tuple(sorted((*points, (round(x, 4), round(y, 4))))))

    def _points(self) -> CurvePoints:
        """The points of the curve; none of one that has a name."""
        mapping = self.session.scene.mapping
        return () if isinstance(mapping, str) else mapping

    def _put_points(self, points: CurvePoints) -> None:
        self._put({"mapping": points})

    def _choose(self, name: str) -> None:
        if name != POINTS:
            self._put({"mapping": name})
        elif isinstance(self.session.scene.mapping, str):
            # Points begin on the curve that they follow.
            xs = np.array([x for x, _ in STRAIGHT], np.float32)
            ys = np.maximum.accumulate(self._levels(xs)).round(4).clip(0, 1)
            self._put_points(tuple(zip(xs.tolist(), ys.tolist(), strict=True)))

    def _levels(self, xs: Singles) -> Singles:
        """The levels, 0 to 1, at fractions of the range that is mapped for the chosen surface."""
        studio, scene = self.session.studio, self.session.scene
        picture = studio.picture
        number = next(
            (each for each, name in enumerate(picture.surfaces, 1) if name == self.session.surface_name), 0
        )
        curves = curves_of(picture, scene.scaling, scene.mapping, scene.exposure)
        if number not in curves:
            return xs
        (low, high), function = curves[number]
        return function((low + xs * (high - low)).astype(np.float32))

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.replace(**changes))

    def _hold(self) -> None:
        self.session.studio.hold_exposure()
        self.session.tell("exposure held: less light is darker")

    def _release(self) -> None:
        self._put({"exposure": AUTO})
        self.session.tell("the exposure follows the picture")


@lru_cache(maxsize=1)
def curves_of(
    picture: Picture, scaling: str, mapping: str | CurvePoints, exposure: Exposure
) -> Mapping[int, tuple[IntensityRange, Fractions]]:
    """The range of intensities and the curve of each visible surface, by number."""
    extents = mapped_ranges(picture, scaling, exposure)
    functions = fractions_by_surface(picture, extents, mapping)
    return {number: (extents[number], function) for number, function in functions.items()}


def place_of(x: float, y: float) -> tuple[int, int]:
    """The element and the line of fractions of intensity and level."""
    return round(CURVE.left + x * (CURVE.width - 1)), round(CURVE.bottom - y * (CURVE.height - 1))


def places_of(points: Sequence[tuple[float, float]]) -> Floats:
    """The elements and lines, (n, 2), of fractions."""
    return np.array([place_of(x, y) for x, y in points], np.float64)


def fractions_of(element: int, line: int) -> tuple[float, float]:
    """The fractions of intensity and level at a place, 0 to 1."""
    x = (element - CURVE.left) / (CURVE.width - 1)
    y = (CURVE.bottom - line) / (CURVE.height - 1)
    return min(1.0, max(0.0, x)), min(1.0, max(0.0, y))
