"""The mapping screen: how intensities become levels, with the curve, whose points can be dragged.

Paper: "The Lighting Model": intensities are mapped by the range of each surface or of the object; nonlinear
mappings can be tried. No mapping renders the picture again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.errors import UsageError
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import fractions_by_surface, held_name, ranges_of
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.scene.scene import AUTO, OBJECT, Exposure
from autocolor.screens.cached import Cached
from autocolor.screens.effects import ranges_to_hold
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import HELD, OverPicture, exposure_row
from autocolor.screens.screen import Content, Handle, Sample, Surroundings
from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar, bar_within
from autocolor.widgets.items import (
    CHARACTER,
    LIGHT_GRAY,
    NIGHT,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    filled,
    fitted,
    lines,
    outline,
    segments,
    text,
)
from autocolor.widgets.menu import WORK, Section
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Button, Choice, Gap, Switch, Widget

POINTS: Final = "points"

OF_DISPLAY: Final = ("scaling", "division", "dither", "interpolation")
"""The columns that say how words stand for levels; their rows are behind a fold."""


class MappingScreen(OverPicture):
    """The mapping of the scene, over the picture."""

    name = "mapping"
    title = "mapping"
    word = "mapping"
    help = "How intensities become levels; click a surface in the picture to show its curve"

    # The panel of the curve is at the lower left.
    corners = ((1.0, 0.0),)

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._touched: int | None = None
        """The number of the point that was touched last."""
        self._curve: Cached[tuple[Singles, Singles]] = Cached()
        """The levels and the shares of the curve that is shown; see `curve_of`."""

    def build(self, around: Surroundings) -> Content:
        content = replace(super().build(around), rows=self._rows)
        if not around.has_panels:
            return content
        handles = [
            Handle(
                number,
                *place_of(x, y),
                f"intensity {x:.2f}, level {y:.2f}",
                place=partial(self._move, number),
                hold=partial(setattr, self, "_touched", number),
            )
            for number, (x, y) in enumerate(self._points)
        ]
        name, exposure = self.session.surface_name, self.session.scene.exposure
        title = f"{fitted(name, MOST_CHARACTERS)}: {range_state(exposure, name)}" if name else ""
        panel = panel_items(title, *self._levels_and_shares(), self._points, self._touched)
        return replace(
            content,
            items=[*content.items, *panel],
            handles=[*content.handles, *handles],
            hint=self._hint,
            sample=self._sample,
            pick=self._pick,
            drag=self._drag,
            wheel=self._wheel,
        )

    def _rows(self) -> Sequence[Widget]:
        scene, session = self.session.scene, self.session
        others = ("name", "view", "scalar", "front", "stage", "backdrop", *OF_DISPLAY)
        inner = range(1, len(self._points) - 1)
        return [
            Choice(
                "mapping",
                "How intensities are mapped to levels; a click in the curve gives it points.",
                names=(*CURVES, POINTS),
                present=scene.mapping if isinstance(scene.mapping, str) else POINTS,
                choose=lambda name: self._put(
                    {"mapping": self._points_of_curve() if name == POINTS else name}
                ),
            ),
            Button(
                "straight",
                "A straight curve, whose points are its two ends.",
                run=lambda: self._put({"mapping": STRAIGHT}),
            ),
            Button(
                "remove point",
                "Remove the yellow point, which was touched last.",
                "" if self._touched in inner else "click at a point between the ends of the curve first",
                run=self._remove,
            ),
            Button(
                "as in 1983",
                "What the paper describes, and nothing since: normals linear in the picture, Phong's model.",
                run=lambda: session.edit(session.scene.as_in_1983()),
            ),
            Gap("exposure gap"),
            exposure_row(session),
            *surface_rows(session),
            *held_rows(session),
            Gap("scene gap"),
            *rows_of(scene, self._put, session.world, leave_out=others),
            Section("display words"),
            *rows_of(scene, self._put, session.world, columns=OF_DISPLAY),
        ]

    def _remove(self) -> None:
        touched, self._touched = self._touched, None
        self._put({"mapping": [point for n, point in enumerate(self._points) if n != touched]})

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.replace(**changes))

    # On the panel, gestures are for the curve, and beside it for the picture.

    def _pick(self, gesture: Gesture) -> None:
        if PANEL.has(gesture.element, gesture.line):
            self._add(gesture)
        else:
            self.pick(gesture)

    def _drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        if not PANEL.has(start.element, start.line):
            self.drag(start, last, now)
            return
        if last is start:
            self._add(start)
        if self._touched is not None:
            self._move(self._touched, now.element, now.line)

    def _wheel(self, gesture: Gesture) -> None:
        if not PANEL.has(gesture.element, gesture.line):
            self.wheel(gesture)

    def _hint(self, element: int, line: int) -> str:
        if not PANEL.has(element, line):
            return self.hint(element, line)
        x, y = fractions_of(element, line)
        return f"intensity {x:.2f}, level {y:.2f}: a click or a drag makes a point here"

    def _sample(self, element: int, line: int) -> Sample | None:
        return None if PANEL.has(element, line) else self.sample(element, line)

    @property
    def _points(self) -> CurvePoints:
        """The points of the curve; none if the curve has a name."""
        mapping = self.session.scene.mapping
        return () if isinstance(mapping, str) else mapping

    def _points_of_curve(self) -> CurvePoints:
        """The points of the curve; of a curve with a name, the fewest that look like it."""
        return self._points or fewest_points(self._levels_and_shares()[0])

    def _levels_and_shares(self) -> tuple[Singles, Singles]:
        image, surface = self.session.studio.display_image, self.session.surface_name
        return self._curve.of(partial(curve_of, image, surface), image, surface)

    def _add(self, gesture: Gesture) -> None:
        """Make a point at the place of a gesture. A curve with a name gets points first."""
        place = fractions_of(gesture.element, gesture.line)
        points, self._touched = added(self._points_of_curve(), *place)
        self._put({"mapping": points})

    def _move(self, number: int, element: int, line: int) -> None:
        """Move a point to a place, if the curve still has the point."""
        if number < len(self._points):
            points = moved(self._points, number, *fractions_of(element, line))
            self._put({"mapping": points})
            self.session.tell("intensity {:.2f}, level {:.2f}".format(*points[number]))


# The panel of the curve: intensity rises to the right, the level upward. Behind the curve are the
# shares of the intensities, and on the curve its points.

PANEL: Final = Area(8, WORK.bottom - 215, 223, WORK.bottom - 8)
"""The panel, at the lower left of the picture."""

CURVE: Final = Area(PANEL.left + 8, PANEL.top + 16, PANEL.right - 8, PANEL.bottom - 8)
"""The area of the curve on the panel."""

ACROSS: Final = np.linspace(0, 1, CURVE.width, dtype=np.float32)
"""The fraction of the intensities at each element of the curve."""

MOST_CHARACTERS: Final = (CURVE.width - 2 * CHARACTER) // CHARACTER - len("level: 99.95 %")
MOST_COUNTED: Final = 20_000
"""Assumed: intensities that are counted; the panel cannot tell more apart."""


def panel_items(
    title: str, levels: Singles, shares: Singles, points: CurvePoints, touched: int | None
) -> list[Item]:
    """The items of the panel. The point with the number `touched` is yellow."""
    tops, top = _places_of(shares), PANEL.top + 4
    feet = np.column_stack([tops[:, 0], np.full(len(tops), float(CURVE.bottom))])
    items = [
        filled(PANEL, NIGHT),
        outline(PANEL, SLATE),
        text("level", CURVE.left, top, LIGHT_GRAY),
        text(title, CURVE.right + 1 - CHARACTER * len(title), top, LIGHT_GRAY),
        segments(np.hstack([feet, tops]), SLATE, CURVE),
        outline(CURVE, SLATE),
        lines([_places_of(levels)], YELLOW, CURVE),
    ]
    for number, (x, y) in enumerate(points):
        element, line = place_of(x, y)
        word = YELLOW if number == touched else WHITE
        items.append(filled(Area(element - 2, line - 2, element + 2, line + 2).within(PANEL), word))
    return items


def place_of(x: float, y: float) -> tuple[int, int]:
    """The element and the line of fractions of intensity and level."""
    return round(CURVE.left + x * (CURVE.width - 1)), round(CURVE.bottom - y * (CURVE.height - 1))


def fractions_of(element: int, line: int) -> tuple[float, float]:
    """The fractions of intensity and level at a place, 0 to 1."""
    x = (element - CURVE.left) / (CURVE.width - 1)
    y = (CURVE.bottom - line) / (CURVE.height - 1)
    return min(1.0, max(0.0, x)), min(1.0, max(0.0, y))


def _places_of(ys: Singles) -> Floats:
    """The elements and lines, (n, 2), of fractions at ACROSS."""
    xs = CURVE.left + ACROSS * (CURVE.width - 1.0)
    return np.column_stack([xs, CURVE.bottom - ys * (CURVE.height - 1.0)]).astype(np.float64)


def curve_of(image: DisplayImage, surface: str) -> tuple[Singles, Singles]:
    """The levels, 0 to 1, and the shares of the intensities at ACROSS of the mapped range of a surface.

    A surface that is not visible has a straight line, and no shares.
    """
    picture = image.mapped
    number = picture.surfaces.index(surface) + 1 if surface in picture.surfaces else 0
    seen = next((each for each in picture.slices if each.surface_number == number), None)
    if seen is None:
        return ACROSS, np.zeros_like(ACROSS)
    extents = ranges_of(image.scene, picture)
    low, high = (np.float32(limit) for limit in extents[number])
    curve = fractions_by_surface(picture, extents, image.scene.mapping, only=number)[number]
    # The sum may exceed the maximum by rounding, where a curve has no value.
    levels = curve(np.minimum(low + ACROSS * (high - low), high))
    return levels, shares_of(picture.relative[seen.pixels], *extents[number])


def shares_of(intensities: Singles, low: float, high: float) -> Singles:
    """How often the intensities from low to high are seen at ACROSS, in proportion to the most frequent.

    Assumed: the square root, so that rare intensities are visible beside a frequent background.
    """
    # In float32 a narrow range has too few numbers for the ends of all bins.
    some = intensities[:: max(1, len(intensities) // MOST_COUNTED)].astype(np.float64)
    counts, _ = np.histogram(some, bins=len(ACROSS), range=(low, high) if low < high else (low, low + 1))
    shares: Singles = np.sqrt(counts / max(1, counts.max())).astype(np.float32)
    return shares


# Making and moving points: the curve always rises. Its first point is at the fraction 0 of the intensities
# and its last point at 1; both stay there.

STRAIGHT: Final[CurvePoints] = ((0.0, 0.0), (1.0, 1.0))

LARGEST_MISS: Final = 0.02
"""Assumed: how far the points of a curve with a name may be from it; nobody sees the difference."""

LEAST_APART: Final = 0.01
"""Assumed: the smallest distance of two points along the intensities."""

DIGITS: Final = 4
"""Decimals of a point; pointing is not as fine."""


def fewest_points(levels: Singles) -> CurvePoints:
    """The two ends of a curve, and only as many further points as keep within LARGEST_MISS of it.

    `levels` has the fractions of levels at ACROSS.
    """
    ys = np.maximum.accumulate(levels.round(DIGITS).clip(0, 1))
    places = [0, len(ACROSS) - 1]
    while True:
        misses = np.abs(np.interp(ACROSS, ACROSS[places], ys[places]) - ys)
        if misses.max() <= LARGEST_MISS:
            points = zip(ACROSS[places].astype(float), ys[places].astype(float), strict=True)
            return tuple((round(x, DIGITS), round(y, DIGITS)) for x, y in points)
        places = sorted([*places, int(misses.argmax())])


def moved(points: CurvePoints, number: int, x: float, y: float) -> CurvePoints:
    """The points with point `number` moved to fractions of intensity and level, as far as neighbors allow."""
    around = ((0.0, 0.0), *points, (1.0, 1.0))
    (left, low), (right, high) = around[number], around[number + 2]
    if number in (0, len(points) - 1) or right - left < 2 * LEAST_APART:
        x = points[number][0]
    else:
        x = min(max(x, left + LEAST_APART), right - LEAST_APART)
    point = round(x, DIGITS), round(min(max(y, low), high), DIGITS)
    return (*points[:number], point, *points[number + 1 :])


def added(points: CurvePoints, x: float, y: float) -> tuple[CurvePoints, int]:
    """The points with a new point at fractions of intensity and level, and its number.

    If another point is closer than LEAST_APART along the intensities, that point gets the new level instead.
    Points below get at most the new level, and points above at least the new level.
    """
    nearest = min([other for other, _ in points], key=lambda other: abs(other - x))
    x, y = nearest if abs(nearest - x) < LEAST_APART else round(x, DIGITS), round(y, DIGITS)
    below = [(other, min(level, y)) for other, level in points if other < x]
    above = [(other, max(level, y)) for other, level in points if other > x]
    return (*below, (x, y), *above), len(below)


# The rows of the menu for the ranges of intensities that the exposure holds.

MOST_LISTED: Final = 10
"""Assumed: surfaces that have a row; the exposure of more surfaces is held or released as a whole."""

LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of minimum and maximum, as a share of the bar's range."""

BEYOND: Final = 2.0
"""Assumed: the bars go to twice the largest intensity of the picture."""


def surface_rows(session: Session) -> list[Widget]:
    """A row for each surface in use, whose box says whether its range is held; none for many surfaces."""

    def flip(name: str) -> None:
        session.edit(session.scene.replace(exposure=flipped(session, name)))
        session.tell(f"the range of {name}: {range_state(session.scene.exposure, name)}")

    names = [name for name in session.studio.level_ranges if name != OBJECT]
    return [
        Switch(
            name,
            f"Hold the range of {name}, or let it follow the picture; beside the box: show its curve.",
            within="exposure",
            is_on=bool(held_name(session.scene.exposure, name)),
            flip=partial(flip, name),
            choose=partial(session.choose_surface, name),
            is_chosen=name == session.surface_name,
        )
        for name in (names if len(names) <= MOST_LISTED else ())
    ]


def range_state(exposure: Exposure, name: str) -> str:
    """Whether the range of a surface is held, "auto", or follows the picture by a percentage."""
    if held_name(exposure, name):
        return HELD
    return exposure if isinstance(exposure, str) else AUTO


def flipped(session: Session, name: str) -> Exposure:
    """The exposure with the range of a surface released if it is held, else held as it is mapped now.

    The surfaces that are mapped by the object's held range keep it. With a percentage as exposure, all ranges
    are held, because those of the other surfaces could not follow the picture as before. Raises UsageError if
    the surface has no range to hold.
    """
    studio, exposure = session.studio, session.scene.exposure
    held = {} if isinstance(exposure, str) else dict(exposure)
    if held_name(exposure, name):
        of_object = held.pop(OBJECT, None)
        others = [other for other in studio.level_ranges if other != OBJECT]
        held = {**(dict.fromkeys(others, of_object) if of_object else {}), **held}
        held.pop(name)
        return tuple(held.items()) or studio.history.following_exposure
    ranges = ranges_to_hold(studio.display_image)
    limits = ranges.get(name, ranges.get(OBJECT))
    if limits is None or name not in studio.display_image.mapped.ranges.surfaces:
        raise UsageError(f"{name} has no range to hold; light it, and turn it to the eye")
    if isinstance(exposure, str) and exposure != AUTO:
        held = ranges
    return tuple({**held, name: limits}.items())


def held_rows(session: Session) -> list[Widget]:
    """The rows of the held minimum and maximum of the chosen surface; none if the exposure is not held."""
    exposure = session.scene.exposure
    name = held_name(exposure, session.surface_name)
    if isinstance(exposure, str) or not name:
        return []
    low, high = dict(exposure)[name]
    # The held range may exceed the bar: if the bar's range followed it, a drag would never reach its end.
    usual = bar_within(0.0, BEYOND * (session.studio.display_image.mapped.ranges.whole.maximum or 1.0))
    least = LEAST_SHARE * usual.high

    def hold(minimum: float, maximum: float) -> None:
        limits = {**dict(exposure), name: (minimum, maximum)}
        session.edit(session.scene.replace(exposure=limits))

    of = "all surfaces" if name == OBJECT else name
    return [
        Bar(
            "minimum",
            f"The intensity of {of} that is shown by the lowest level.",
            value=low,
            **usual._asdict(),
            put=lambda value: hold(max(0.0, min(value, high - least)), high),
        ),
        Bar(
            "maximum",
            f"The intensity of {of} that is shown by the highest level.",
            value=high,
            **usual._asdict(),
            put=lambda value: hold(low, max(value, low + least)),
        ),
    ]
