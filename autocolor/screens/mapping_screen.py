"""The mapping screen: how intensities become levels, with the curve, whose points can be dragged.

Paper: "The Lighting Model": intensities are mapped by the range of each surface or of the object; nonlinear
mappings can be tried. No mapping renders the picture again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.errors import UsageError
from autocolor.lighting.picture import Picture
from autocolor.mapping.intensity import (
    fractions_by_surface,
    has_extent,
    held_exposure,
    held_name,
    mapped_ranges,
    stage_surfaces,
)
from autocolor.scene.curves import CURVES, CurvePoints
from autocolor.scene.scene import AUTO, OBJECT, Exposure
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
    lines,
    outline,
    segments,
    text,
)
from autocolor.widgets.menu import WORK, Section
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Button, Choice, Gap, Switch, Widget, short_name

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
        self._has_panel = True
        """Whether the panel of the curve is shown."""
        self._touched: int | None = None
        """The number of the point that was touched last."""

    def build(self, around: Surroundings) -> Content:
        content = super().build(around)
        self._has_panel = around.has_panels
        if not around.has_panels:
            return replace(content, rows=self._rows)
        items = [*content.items, *panel_items(self._curve())]
        return replace(content, items=items, rows=self._rows, handles=[*content.handles, *self._handles()])

    # The menu.

    def _rows(self) -> Sequence[Widget]:
        scene, session = self.session.scene, self.session
        others = ("name", "view", "scalar", "front", "stage", "backdrop", *OF_DISPLAY)
        return [
            Choice(
                "mapping",
                "How intensities are mapped to levels; a click in the curve gives it points.",
                names=(*CURVES, POINTS),
                present=scene.mapping if isinstance(scene.mapping, str) else POINTS,
                choose=self._choose,
            ),
            Button("straight", "A straight curve with five points.", run=partial(self._put_points, STRAIGHT)),
            self._remove_row(),
            Button(
                "as in 1983",
                "What the paper describes, and nothing since: normals linear in the picture, Phong's model.",
                run=lambda: session.edit(session.scene.as_in_1983()),
            ),
            Gap("exposure gap"),
            exposure_row(session),
            *surface_rows(session, self._put),
            *held_rows(session, self._put),
            Gap("scene gap"),
            *rows_of(scene, self._put, session.world, leave_out=others),
            Section("display words"),
            *rows_of(scene, self._put, session.world, columns=OF_DISPLAY),
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
            "Remove the yellow point, which was touched last.",
            why_not,
            run=self._remove,
        )

    # The curve.

    def _handles(self) -> Sequence[Handle]:
        return [
            Handle(
                number,
                *place_of(x, y),
                f"intensity {x:.2f}, level {y:.2f}",
                place=partial(self._move, number),
                hold=partial(setattr, self, "_touched", number),
            )
            for number, (x, y) in enumerate(self._points())
        ]

    def pick(self, gesture: Gesture) -> None:
        if not self._is_on_panel(gesture.element, gesture.line):
            super().pick(gesture)
            return
        self._add(gesture)

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        if not self._is_on_panel(start.element, start.line):
            super().drag(start, last, now)
            return
        if last is start:
            self._add(start)
        if self._touched is not None:
            self._move(self._touched, now.element, now.line)

    def wheel(self, gesture: Gesture) -> None:
        if not self._is_on_panel(gesture.element, gesture.line):
            super().wheel(gesture)

    def hint(self, element: int, line: int) -> str:
        if not self._is_on_panel(element, line):
            return super().hint(element, line)
        x, y = fractions_of(element, line)
        return f"intensity {x:.2f}, level {y:.2f}: a click or a drag makes a point here"

    def sample(self, element: int, line: int) -> Sample | None:
        return None if self._is_on_panel(element, line) else super().sample(element, line)

    def _is_on_panel(self, element: int, line: int) -> bool:
        return self._has_panel and PANEL.has(element, line)

    def _points(self) -> CurvePoints:
        """The points of the curve; none if the curve has a name."""
        mapping = self.session.scene.mapping
        return () if isinstance(mapping, str) else mapping

    def _put_points(self, points: CurvePoints) -> None:
        self._put({"mapping": points})

    def _add(self, gesture: Gesture) -> None:
        """Make a point at the place of a gesture. A curve with a name gets points first."""
        points = self._points() or self._points_of_curve()
        points, self._touched = added(points, *fractions_of(gesture.element, gesture.line))
        self._put_points(points)

    def _move(self, number: int, element: int, line: int) -> None:
        """Move a point to a place, if the curve still has the point."""
        if number < len(self._points()):
            points = moved(self._points(), number, *fractions_of(element, line))
            self._put_points(points)
            x, y = points[number]
            self.session.tell(f"intensity {x:.2f}, level {y:.2f}")

    def _points_of_curve(self) -> CurvePoints:
        """Points on the curve that is shown."""
        xs = np.array([x for x, _ in STRAIGHT], np.float32)
        ys = np.interp(xs, ACROSS, self._curve().levels)
        rising = np.maximum.accumulate(ys.round(4).clip(0, 1))
        return tuple(zip(xs.tolist(), rising.tolist(), strict=True))

    def _curve(self) -> Curve:
        session, scene = self.session, self.session.scene
        mapped = session.studio.display_image.mapped
        name, stage = session.surface_name, stage_surfaces(scene)
        curve = curve_of(mapped, scene.scaling, scene.mapping, scene.exposure, name, stage)
        levels, shares = (ACROSS, np.zeros_like(ACROSS)) if curve is None else curve
        state = range_state(scene.exposure, session.surface_name)
        return Curve(session.surface_name, levels, shares, self._points(), self._touched, state)

    # The actions of the rows.

    def _choose(self, name: str) -> None:
        if name != POINTS:
            self._put({"mapping": name})
        elif not self._points():
            self._put_points(self._points_of_curve())

    def _remove(self) -> None:
        if self._touched is not None:
            self._put_points(removed(self._points(), self._touched))
            self._touched = None

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.replace(**changes))


@lru_cache(maxsize=4)
def curve_of(
    picture: Picture,
    scaling: str,
    mapping: str | CurvePoints,
    exposure: Exposure,
    name: str,
    stage: frozenset[int] = frozenset(),
) -> tuple[Singles, Singles] | None:
    """The levels, 0 to 1, and the shares of the intensities of a surface across its mapped range.

    None for a surface that is not visible.
    """
    number = picture.surfaces.index(name) + 1 if name in picture.surfaces else 0
    extents = mapped_ranges(picture, scaling, exposure, stage=stage)
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


class Curve(NamedTuple):
    """The contents of the panel.

    `levels` are fractions at ACROSS, `shares` are how often the intensities there are seen, 0 to 1.
    """

    surface: str
    levels: Singles
    shares: Singles
    points: CurvePoints
    touched: int | None
    """The number of the point that was touched last."""
    state: str = AUTO
    """What `range_state` says of the surface."""


def panel_items(curve: Curve) -> list[Item]:
    """The items of the panel."""
    title = f"{short_name(curve.surface, MOST_CHARACTERS)}: {curve.state}" if curve.surface else ""
    top = PANEL.top + 4
    items = [
        filled(PANEL, NIGHT),
        outline(PANEL, SLATE),
        text("level", CURVE.left, top, LIGHT_GRAY),
        _share_item(curve.shares),
        outline(CURVE, SLATE),
        lines([_places_of(ACROSS, curve.levels)], YELLOW, CURVE),
    ]
    items.append(text(title, CURVE.right + 1 - CHARACTER * len(title), top, LIGHT_GRAY))
    for number, (x, y) in enumerate(curve.points):
        element, line = place_of(x, y)
        word = YELLOW if number == curve.touched else WHITE
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


def _places_of(xs: Singles, ys: Singles) -> Floats:
    """The elements and lines, (n, 2), of fractions."""
    return np.column_stack(
        [CURVE.left + xs * (CURVE.width - 1.0), CURVE.bottom - ys * (CURVE.height - 1.0)]
    ).astype(np.float64)


def _share_item(shares: Singles) -> Item:
    """A line upward for each element, as long as intensities there are frequent."""
    tops = _places_of(ACROSS, shares)
    feet = np.column_stack([tops[:, 0], np.full(len(tops), float(CURVE.bottom))])
    return segments(np.hstack([feet, tops]), SLATE, CURVE)


def shares_of(intensities: Singles, low: float, high: float) -> Singles:
    """How often the intensities from low to high are seen at ACROSS, in proportion to the most frequent.

    Assumed: the square root, so that rare intensities are visible beside a frequent background.
    """
    # In float32 a narrow range has too few numbers for the ends of all bins.
    some = intensities[:: max(1, len(intensities) // MOST_COUNTED)].astype(np.float64)
    counts, _ = np.histogram(some, bins=len(ACROSS), range=(low, high) if low < high else (low, low + 1))
    shares: Singles = np.sqrt(counts / max(1, counts.max())).astype(np.float32)
    return shares


# Moving, adding and removing points: the curve always rises. Its first point is at the fraction 0 of the
# intensities and its last point at 1; both stay there.

STRAIGHT: Final[CurvePoints] = ((0.0, 0.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.75), (1.0, 1.0))
LEAST_APART: Final = 0.01
"""Assumed: the smallest distance of two points along the intensities."""

DIGITS: Final = 4
"""Decimals of a point; pointing is not as fine."""


def moved(points: CurvePoints, number: int, x: float, y: float) -> CurvePoints:
    """The points with point `number` moved to fractions of intensity and level, as far as neighbors allow."""
    last = len(points) - 1
    low = points[number - 1][1] if number else 0.0
    high = points[number + 1][1] if number < last else 1.0
    if 0 < number < last:
        least, most = points[number - 1][0] + LEAST_APART, points[number + 1][0] - LEAST_APART
        x = min(max(x, least), most) if least <= most else points[number][0]
    else:
        x = points[number][0]
    point = round(x, DIGITS), round(min(max(y, low), high), DIGITS)
    return (*points[:number], point, *points[number + 1 :])


def added(points: CurvePoints, x: float, y: float) -> tuple[CurvePoints, int]:
    """The points with a new point at fractions of intensity and level, and its number.

    If another point is closer than LEAST_APART along the intensities, that point gets the new level instead.
    Points below get at most the new level, and points above at least the new level.
    """
    number = min(range(len(points)), key=lambda number: abs(points[number][0] - x))
    if abs(points[number][0] - x) < LEAST_APART:
        x, above = points[number][0], points[number + 1 :]
    else:
        number = sum(other < x for other, _ in points)
        above = points[number:]
    x, y = round(x, DIGITS), round(y, DIGITS)
    low = [(other, min(level, y)) for other, level in points[:number]]
    high = [(other, max(level, y)) for other, level in above]
    return (*low, (x, y), *high), number


def removed(points: CurvePoints, number: int) -> CurvePoints:
    """The points without point `number`; the ends stay."""
    return (*points[:number], *points[number + 1 :]) if 0 < number < len(points) - 1 else points


# The rows of the menu for the ranges of intensities that the exposure holds.

MOST_LISTED: Final = 10
"""Assumed: surfaces that have a row; the exposure of more surfaces is held or released as a whole."""

LEAST_SHARE: Final = 1e-3
"""Assumed: the smallest distance of minimum and maximum, as a share of the bar's range."""

BEYOND: Final = 2.0
"""Assumed: the bars go to twice the largest intensity of the picture."""


def surface_rows(session: Session, put: Callable[[Mapping[str, object]], object]) -> list[Widget]:
    """A row for each surface in use, whose box says whether its range is held; none for many surfaces."""
    names = [name for name in session.studio.level_ranges if name != OBJECT]
    return [
        Switch(
            name,
            f"Hold the range of {name}, or let it follow the picture; beside the box: show its curve.",
            within="exposure",
            is_on=bool(held_name(session.scene.exposure, name)),
            flip=partial(_flip, session, name, put),
            choose=partial(session.choose_surface, name),
            is_chosen=name == session.surface_name,
        )
        for name in (names if len(names) <= MOST_LISTED else ())
    ]


def _flip(session: Session, name: str, put: Callable[[Mapping[str, object]], object]) -> None:
    put({"exposure": flipped(session, name)})
    session.tell(f"the range of {name}: {range_state(session.scene.exposure, name)}")


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
    studio, scene = session.studio, session.scene
    held: dict[str, tuple[float, float]] = {} if isinstance(scene.exposure, str) else dict(scene.exposure)
    if held_name(scene.exposure, name):
        of_object = held.pop(OBJECT, None)
        others = [other for other in studio.level_ranges if other != OBJECT]
        held = {**(dict.fromkeys(others, of_object) if of_object else {}), **held}
        held.pop(name)
        return tuple(held.items()) or studio.history.following_exposure
    picture = studio.display_image.mapped
    number = picture.surfaces.index(name) + 1
    extent = mapped_ranges(picture, scene.scaling, scene.exposure, stage=stage_surfaces(scene)).get(number)
    if extent is None:
        raise UsageError(f"{name} has no range to hold, as no point of it is seen; turn it to the eye first")
    if not has_extent(extent):
        raise UsageError(f"{name} has no range to hold, as all its points have one intensity; light it first")
    if isinstance(scene.exposure, str) and scene.exposure != AUTO:
        ranges = held_exposure(picture, scene.scaling, scene.exposure, stage_surfaces(scene))
        held = {} if isinstance(ranges, str) else dict(ranges)
    held[name] = (extent.minimum * picture.scale, extent.maximum * picture.scale)
    return tuple(held.items())


def held_rows(session: Session, put: Callable[[Mapping[str, object]], object]) -> list[Widget]:
    """The rows of the held minimum and maximum of the chosen surface; none if the exposure is not held."""
    exposure = session.scene.exposure
    name = held_name(exposure, session.surface_name)
    if isinstance(exposure, str) or not name:
        return []
    low, high = dict(exposure)[name]
    # The held range may exceed the bar: if the bar's range followed it, a drag would never reach its end.
    usual = bar_within(0.0, BEYOND * (session.studio.display_image.mapped.ranges.whole.maximum or 1.0))
    least = LEAST_SHARE * usual.high

    def hold(minimum: float, maximum: float) -> object:
        limits = {**dict(exposure), name: (minimum, maximum)}
        return put({"exposure": tuple(limits.items())})

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
