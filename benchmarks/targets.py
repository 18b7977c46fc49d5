"""The targets of this renderer beside what is measured: `python -m benchmarks targets`.

Everything is timed in turns in one process, this renderer and its peers alike; a ratio is the median of those
of the rounds, between their quartiles. A peer is measured against when its pictures agree with ours; where it
is not there, or they do not, its rows say so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from benchmarks.batches import beside_the_encoder, light_moves, two_processes
from benchmarks.cases import Spread, ratios, spread, timed
from benchmarks.color_drags import BLEND_BAR, COLOR_BAR, UPRIGHT_BAR, ColorDrag, color_drag_seconds
from benchmarks.comparison import comparison_scene
from benchmarks.contestants import case_of, contestants
from benchmarks.mapped_tables import mapped_memory, mapped_times
from benchmarks.movement import drag_seconds
from benchmarks.once import differing_pixels, first_picture, many_polygons, memory
from benchmarks.own_cases import COPY, IMAGE, SCAN_OUT, SMOOTH_IMAGE, STREAM, own_cases
from benchmarks.points import ALL_LIGHTS, FRAME, ONE_LIGHT, RECOLOR

ROUNDS, ROUNDS_OF_SLOW, ROUNDS_OF_MANY = 25, 5, 7
MET, MISSED, SKIPPED, NOT_COMPARABLE = "met", "MISSED", "skipped", "not comparable"
NOTES = (
    "Edits of a frame, of all lights and of a color end with the field scanned out, those of one light with\n"
    "the words in the frame buffer, those of peers with glFinish; a peer is compared in the same edit.\n"
    "A recoloring is one of many, as while a color is dragged; the first one is a case of its own.\n"
    "Memory is the peak of making and rendering a scene, its mesh included, over that of the imports."
)

Seconds = Mapping[str, list[float]]


@dataclass(frozen=True)
class Target:
    """A bound, and how what it bounds is found from the seconds of all cases.

    A row that `needs` a peer is skipped without it, one that `takes_long` in a quick run, and one for
    something that is not built yet, which nothing measures, always.
    """

    name: str
    unit: str
    bound: float
    measured: Callable[[Seconds], Spread] | None = None
    at_least: bool = False
    needs: str | None = None
    takes_long: bool = False

    def is_met(self, figure: Spread) -> bool:
        """Whether the median keeps to the bound."""
        return figure.median >= self.bound if self.at_least else figure.median <= self.bound


def between(case: str, other: str) -> Callable[[Seconds], Spread]:
    """How many times as long a case takes as another."""
    return lambda seconds: ratios(seconds[case], seconds[other])


def dragged(drag: ColorDrag) -> Callable[[Seconds], Spread]:
    """How long a drag of a color takes to be seen."""
    return lambda _: color_drag_seconds(drag).times(1e3)


TARGETS = (
    Target("scan-out", "copies of a field", 1.6, between(SCAN_OUT, COPY)),
    Target("recolor a surface, scan-out", "copies of a field", 3, between(RECOLOR, COPY)),
    Target(
        "recolor a surface, scan-out", "times faster than VTK", 45,
        between(case_of("VTK", RECOLOR), RECOLOR), at_least=True, needs="VTK",
    ),
    Target(
        "one light of four moved", "of VTK's time", 0.22,
        between(ONE_LIGHT, case_of("VTK", ONE_LIGHT)), needs="VTK",
    ),
    Target(
        "four lights moved", "of VTK's time", 0.43,
        between(ALL_LIGHTS, case_of("VTK", ALL_LIGHTS)), needs="VTK",
    ),
    Target(
        "four lights moved", "of OpenGL's time", 1,
        between(ALL_LIGHTS, case_of("OpenGL", ALL_LIGHTS)), needs="OpenGL",
    ),
    Target("whole frame, eye moved", "of VTK's time", 1, between(FRAME, case_of("VTK", FRAME)), needs="VTK"),
    Target(
        "whole frame, eye moved", "of OpenGL's time", 1.5,
        between(FRAME, case_of("OpenGL", FRAME)), needs="OpenGL",
    ),
    Target(
        "a million polygons", "frames of 8,136", 7, lambda _: many_polygons(ROUNDS_OF_MANY), takes_long=True
    ),
    Target("first picture of a process", "s", 0.5, lambda _: first_picture()),
    Target("memory, the coupe", "MB", 40, lambda _: memory("coupe")),
    Target("memory, a million polygons", "MB", 400, lambda _: memory("hills"), takes_long=True),
    Target("ten million polygons", "frames of a million", 12, lambda _: mapped_times(), takes_long=True),
    Target(
        "memory, ten million polygons", "MB beyond the tables", 600, lambda _: mapped_memory(),
        takes_long=True,
    ),
    Target("batch and Watkins differ", "pixels", 0, lambda _: spread([differing_pixels()])),
    Target(
        "a picture through the instructions", "ms", 1, lambda seconds: spread(seconds[STREAM]).times(1e3)
    ),
    Target("an image with smooth edges, 2 x 2", "of a plain image's time", 4.5, between(SMOOTH_IMAGE, IMAGE)),
    Target("a drag on 100,000 polygons", "ms between fields", 33, lambda _: drag_seconds().times(1e3)),
    Target("a color bar of the coupe, dragged", "ms to its field", 4, dragged(COLOR_BAR)),
    Target("the blend bar of the coupe, dragged", "ms to its field", 4, dragged(BLEND_BAR)),
    Target("light blending of the coupe, dragged", "ms to its field", 4, dragged(UPRIGHT_BAR)),
    Target(
        "1,000 recolorings to PNG", "ms beside encoder, writing", 3, lambda _: beside_the_encoder(),
        takes_long=True,
    ),
    Target(
        "recolorings, two processes", "times one's speed", 1.7, lambda _: two_processes(), at_least=True,
        takes_long=True,
    ),
    Target("500 light moves of a batch", "times relighting alone", 1.1, lambda _: light_moves()),
)  # fmt: skip
"""In the order of what they are about: the display, edits beside peers, size, start, being right, batches."""


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """The rows of the targets, the milliseconds of all cases, and how the peers' pictures agree."""
    scene = comparison_scene()
    peers, missing = contestants(scene)
    slow = [case for peer in peers if peer.peer.is_slow for case in peer.cases() if not quick]
    fast = [case for peer in peers if not peer.peer.is_slow for case in peer.cases()]
    seconds = timed([*own_cases(scene), *fast], rounds) | timed(slow, min(rounds, ROUNDS_OF_SLOW))
    verdicts = {name: (SKIPPED, reason) for name, reason in missing.items()} | {
        peer.name: (NOT_COMPARABLE, peer.disagreement) for peer in peers if not peer.agrees
    }
    return {
        "rounds": rounds,
        "peers": {
            peer.name: {
                "description": peer.peer.description,
                "agrees": peer.agrees,
                "pictures": {edit: each.values() for edit, each in peer.agreements.items()},
            }
            for peer in peers
        },
        "absent": missing,
        "cases ms": {name: spread(row).times(1e3)._asdict() for name, row in seconds.items()},
        "targets": [row(target, seconds, verdicts, quick) for target in TARGETS],
    }


def row(
    target: Target, seconds: Seconds, verdicts: Mapping[str, tuple[str, str]], quick: bool
) -> dict[str, Any]:
    """A target with what is measured for it, or with why nothing is."""
    figure, verdict, reason = None, SKIPPED, ""
    if target.measured is None:
        reason = "it is not built yet"
    elif target.needs is not None and target.needs in verdicts:
        verdict, reason = verdicts[target.needs]
    elif quick and target.takes_long:
        reason = "it takes long, and the run is a quick one"
    else:
        figure = target.measured(seconds)
        verdict = MET if target.is_met(figure) else MISSED
    return {
        "target": target.name,
        "unit": target.unit,
        "measured": None if figure is None else figure._asdict(),
        "bound": target.bound,
        "at least": target.at_least,
        "verdict": verdict,
        "reason": reason,
    }


def text(measured: dict[str, Any]) -> str:
    """The peers and how they agree, the targets, and all cases."""
    return "\n\n".join(
        "\n".join(lines)
        for lines in (peer_lines(measured), target_lines(measured), case_lines(measured), [NOTES])
    )


def peer_lines(measured: dict[str, Any]) -> list[str]:
    """What each peer is, and how far its pictures agree; why the others are not there."""
    lines = [f"{'a peer beside ours, of 255':40}{'only one covers':>16}{'astray':>8}{'median':>8}{'99th':>8}"]
    for name, peer in measured["peers"].items():
        lines.append(f"{name}: {peer['description']}")
        for edit, each in peer["pictures"].items():
            numbers = (
                f"{each['uncovered']:16,}{each['astray']:8,}{each['median']:8.2f}{each['percentile']:8.2f}"
            )
            lines.append(f"    {edit:36}{numbers}  {'agrees' if each['agrees'] else 'DISAGREES'}")
    return lines + [f"{name}: {SKIPPED}: {reason}" for name, reason in measured["absent"].items()]


def target_lines(measured: dict[str, Any]) -> list[str]:
    """Each target with what is measured for it, its bound and the verdict."""
    lines = [f"{'target':36}{'measured':>10}{'quartiles':>16}{'bound':>11}"]
    for target in measured["targets"]:
        spent = "" if target["measured"] is None else columns(Spread(**target["measured"]))
        bound = f"{'>=' if target['at least'] else '<='} {target['bound']:g}"
        verdict = ": ".join(filter(None, (target["verdict"], target["reason"])))
        lines.append(f"{target['target']:36}{spent:26}{bound:>11}  {target['unit']:24}{verdict}")
    return lines


def case_lines(measured: dict[str, Any]) -> list[str]:
    """Each case, those of peers as ratios to ours of the same edit too."""
    lines = [f"{'case':36}{'ms':>10}{'quartiles':>16}{'times ours':>11}"]
    cases, peers = measured["cases ms"], measured["peers"]
    for name, case in cases.items():
        peer, _, edit = name.partition(": ")
        ours = f"{case['median'] / cases[edit]['median']:.3g}" if peer in peers else ""
        note = "" if peer not in peers or peers[peer]["agrees"] else NOT_COMPARABLE
        lines.append(f"{name:36}{columns(Spread(**case))}{ours:>11}  {note}".rstrip())
    return lines


def columns(figure: Spread) -> str:
    """A median and its quartiles, in 26 letters."""
    low, median, high = (f"{part:,.0f}" if part >= 1000 else f"{part:.3g}" for part in figure)
    return f"{median:>10}{f'{low} - {high}':>16}"
