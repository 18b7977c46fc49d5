"""The frames of an animation: evenly timed variants between variants that have times.

    fade = autocolor.frames(scene, [{"surfaces.body.object_color": "red"},
                                    {"surfaces.body.object_color": "navy"}], 48)
    around = autocolor.frames(scene, [], 72, turn=360)

The kind of a column interpolates its values (see `Kind.between`). Numbers, limits, colors, points and curves
of equally many points go straight, and whole numbers are rounded half up. A direction turns along a great
circle. The eye of a view with a target turns around it: the azimuth goes the shortest way, elevation and
distance are linear. Names, switches and choices hold, and so does a value that is absent in one variant.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from itertools import pairwise
from numbers import Real
from typing import Any, Final

from autocolor.batches.table import MOST_VARIANTS, Rows, Variant, check_keys, variants_of
from autocolor.checks import brief, is_whole, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.settings import field_of, place_of, row_at, scene_with, value_at
from autocolor.scene.row_kinds import OneRowOf
from autocolor.scene.scene import Scene, check_scene, cost_of_edit
from autocolor.scene.surfaces import Paint, Surface
from autocolor.scene.view import VERTICAL

SAME_TIME: Final = 1e-9
"""Assumed: a frame is at the time of a variant if they differ by this part of the whole duration."""

LARGEST_TURN: Final = 360_000.0
"""Limit: degrees of a turn."""

LINE_OF_SIGHT: Final = ("view.direction", "view.target")


def frames(
    scene: Scene, variants: Rows, count: int, *, turn: float = 0.0, loop: bool | None = None
) -> tuple[Variant, ...]:
    """The frames of an animation of a scene, evenly spaced from the first variant to the last.

    Variants without times are evenly spaced, too. If only some variants set a field, it has the scene's own
    value in the others. A frame at the time of a variant has exactly its settings.

    With `turn`, the eye also turns by so many degrees around the view's target, counterclockwise as seen from
    above. Then there may be no variant.

    With `loop`, the last frame is left out, because it would repeat the first when the film begins again.
    Assumed: `loop` is true by default if the last variant gives the same scene as the first and the turn is
    whole.

    Raises UsageError if the times do not rise, if the count is no whole number from 1 to 100,000, or if
    nothing moves. Raises the errors of `scene_with` with the name of the variant.
    """
    return frames_of_tracks(scene, [variants_of(variants)], count, turn=turn, loop=loop)


def frames_of_tracks(
    scene: Scene,
    tracks: Sequence[Sequence[Variant]],
    count: int,
    *,
    turn: float = 0.0,
    loop: bool | None = None,
) -> tuple[Variant, ...]:
    """The frames of several tables, each over the whole duration; see `frames`.

    Raises UsageError if two tables set the same key.
    """
    check_scene(scene)
    if not is_whole(count, 1, MOST_VARIANTS):
        raise UsageError(
            f"frames must be a whole number from 1 to {MOST_VARIANTS:,}, not {shown(count)}; choose another"
        )
    if isinstance(turn, bool) or not isinstance(turn, Real) or not abs(turn) <= LARGEST_TURN:
        raise UsageError(
            f"a turn must be a number of degrees up to {LARGEST_TURN:,.0f}, not {shown(turn)}; choose another"
        )
    moving = [_Track(scene, variants) for variants in tracks if variants]
    check_keys(tracks)
    if not turn and all(len(track.variants) < 2 for track in moving):
        raise UsageError("an animation must have at least two variants, or a turn; add a value to a list")
    if loop is None:
        loop = turn % 360 == 0 and all(track.is_closed for track in moving)
    steps = count if loop else max(count - 1, 1)
    made = []
    for number in range(count):
        share = number / steps
        settings: dict[str, object] = {}
        for track in moving:
            settings |= track.settings_at(share)
        if turn:
            settings |= _turned(scene, settings, turn * share)
        start, end = moving[0].span if len(moving) == 1 else (0.0, 1.0)
        made.append(Variant(f"frame-{number + 1:04}", settings, start + (end - start) * share))
    return tuple(made)


def in_step(lists: Sequence[Sequence[Variant]]) -> list[list[Variant]]:
    """Lists of variants without times as tables: lists of the same length become one table.

    So an eye and a target that move together are one movement of the view. Raises UsageError if two lists set
    the same key.
    """
    tables: dict[int, list[Variant]] = {}
    for variants in lists:
        table = tables.setdefault(len(variants), [])
        if not table:
            table.extend(variants)
            continue
        for row, (one, other) in enumerate(zip(table, variants, strict=True)):
            check_keys([[one], [other]])
            table[row] = Variant(f"{one.name}-{other.name}", {**one.settings, **other.settings})
    return list(tables.values())


class _Track:
    """A table of variants with their times, their scenes, and the places of all their keys."""

    def __init__(self, scene: Scene, variants: Sequence[Variant]) -> None:
        """The track of some variants, at least one. Raises UsageError and InputError."""
        self.scene, self.variants, self.scenes = scene, variants, list[Scene]()
        for variant in variants:
            try:
                self.scenes.append(scene_with(scene, variant.settings))
            except (InputError, UsageError) as error:
                base = InputError if isinstance(error, InputError) else UsageError
                raise base(
                    f"variant {brief(variant.name)}: {problem}" for problem in error.problems
                ) from None
        keys = dict.fromkeys(key for variant in variants for key in variant.settings)
        if any(key in keys for key in LINE_OF_SIGHT):
            # Between a view with a target and a view with a direction, there are views with directions.
            keys |= dict.fromkeys(LINE_OF_SIGHT)
        self.times, self.places = times_of(variants), {key: place_of(scene, key) for key in keys}
        self.span = self.times[0], self.times[-1]
        # Whether the last variant gives the same scene as the first.
        self.is_closed = cost_of_edit(self.scenes[0], self.scenes[-1]) is None

    def settings_at(self, share: float) -> Mapping[str, object]:
        """The settings at a share of the duration, 0 to 1."""
        start, end = self.span
        at = end if share == 1 else start + (end - start) * share
        after = bisect_left(self.times, at)
        closest = min((max(after - 1, 0), after), key=lambda number: abs(self.times[number] - at))
        if abs(self.times[closest] - at) <= SAME_TIME * (end - start):
            return self.variants[closest].settings
        one, other = self.times[after - 1 : after + 1]
        between = self.scenes[after - 1].between(self.scenes[after], (at - one) / (other - one))
        return self._settings_of(between, self.variants[after - 1])

    def _settings_of(self, between: Scene, earlier: Variant) -> dict[str, object]:
        """The values of all keys in a scene between two variants, as settings."""
        settings: dict[str, object] = {}
        for key, place in self.places.items():
            field, value, row = field_of(place), value_at(between, place), row_at(between, place)
            if isinstance(row, Surface) and row.paint.ramp and place.path[-1] in Paint.alternatives[0]:
                # Two colors beside a ramp would be refused.
                continue
            if field is None:
                # The key is a whole inline row, which holds.
                settings |= {key: earlier.settings[key]} if key in earlier.settings else {}
            elif value is None:
                # The field is absent, here or with the row that it is in. Unset it if the scene has it.
                is_unset = field.is_optional and value_at(self.scene, place) is not None
                settings |= {key: None} if is_unset else {}
            else:
                kind, name = field.kind, place.path[-1]
                plain = kind.to_plain(name, value)
                stem = key.removesuffix(name)
                # The name of a reflection model comes with the parameters of the model.
                keys = plain if isinstance(kind, OneRowOf) else {name: plain.get(name)}
                settings |= {f"{stem}{inner}": inner_value for inner, inner_value in keys.items()}
        return settings


def times_of(variants: Sequence[Variant]) -> list[float]:
    """The times of variants; 0, 1, 2 and so on if no variant has a time. Raises UsageError."""
    if all(variant.time is None for variant in variants):
        return [float(number) for number in range(len(variants))]
    times: list[Any] = [variant.time for variant in variants]
    if None in times:
        missing = variants[times.index(None)].name
        raise UsageError(
            f"all variants must have times, or none, not all but {shown(missing)}; give it a time"
        )
    for (one, before), (other, after) in pairwise(zip(variants, times, strict=True)):
        if before >= after:
            raise UsageError(
                f"the time of {shown(other.name)} must be later than the time of {shown(one.name)},"
                f" {before:g}, not {after:g}; sort the variants by time"
            )
    return times


def _turned(scene: Scene, settings: Mapping[str, object], degrees: float) -> dict[str, object]:
    """The settings of a view that turned around its target, or around the object on its line of sight."""
    view = scene_with(scene, settings).view
    x, y, z = view.orbit_target(*scene.object_bounds)
    right, back = view.eye[0] - x, view.eye[1] - y
    if math.hypot(right, back) <= VERTICAL * abs(view.eye[2] - z):
        raise UsageError(
            f"a view that turns must be from the side, not from {view.eye}, vertically above or"
            " below its target; move the eye, or vary view.angle"
        )
    turn = math.radians(degrees % 360)
    cosine, sine = math.cos(turn), math.sin(turn)
    eye = x + right * cosine - back * sine, y + right * sine + back * cosine, view.eye[2]
    if view.target is not None:
        return {"view.eye": list(eye)}
    toward = [a - b for a, b in zip((x, y, z), eye, strict=True)]
    return {"view.eye": list(eye), "view.direction": toward}
