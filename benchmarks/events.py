"""From an event to the field that shows it: `python -m benchmarks events`.

Events are put into the queue of the real window, on a virtual screen, as those of the mouse and the keyboard
are, and the window is stepped until it has shown another field. What is dragged is found on the board by its
label, so that a case stays the same when a screen is laid out anew; a case whose screen is not there is told.

Each limit is for the median. The processor's time stands beside the wall clock's, which others on the machine
lengthen.
"""

from __future__ import annotations

import os
import shutil
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import autocolor
from autocolor.commands.window import connected
from autocolor.screens.steps import switch_split
from autocolor.screens.surface.painting import change_paint
from autocolor.screens.viewer import Viewer
from benchmarks.hills import hills, side_of
from benchmarks.movement import screen
from benchmarks.points import COUPE
from ramtek_emu import Ramtek9300
from ramtek_emu.monitor.input_queue import Input, Key, Pointer
from ramtek_emu.monitor.window import Monitor

ROUNDS = 40
WARMING = 4
"""Events of a case that are not counted."""
GIVEN_UP = 2.0
"""Seconds after which an event has shown nothing."""
MANY_POLYGONS = 100_000
LEFT = 1

Share = tuple[float, float]
"""A place in a widget's area, as shares of its width and height."""


class Shown(NamedTuple):
    """Seconds from an event to its field, on the wall and of the processor; whether a field came at all."""

    wall: float
    processor: float
    came: bool


class AbsentError(Exception):
    """What a case needs is not on the screen."""


class Bench:
    """A window with a scene, and a user who puts events into its queue."""

    def __init__(self, scene: autocolor.Scene, folder: Path) -> None:
        display = Ramtek9300()
        self.viewer = Viewer(scene, display, folder)
        self.monitor: Monitor = connected(Monitor(display), self.viewer)
        self.monitor.open()
        self._settle()

    def close(self) -> None:
        """Close the window without asking."""
        self.monitor.close()

    def shown(self, *events: Input) -> Shown:
        """Put events into the queue, and wait for the next field."""
        before = self.monitor.refreshed
        begin, worked = time.perf_counter(), time.process_time()
        for event in events:
            self.monitor.input.add(event)
        while self.monitor.refreshed == before:
            self.monitor.step(0)
            if time.perf_counter() - begin > GIVEN_UP:
                return Shown(GIVEN_UP, time.process_time() - worked, False)
        return Shown(time.perf_counter() - begin, time.process_time() - worked, True)

    def do(self, *events: Input) -> None:
        """Put events into the queue one after the other, and wait until each is handled."""
        for event in events:
            self.monitor.input.add(event)
            while self.monitor.input:
                self.monitor.step(0)
        self._settle()

    def _settle(self) -> None:
        """Let the window rest, so that nothing of what was done is measured with what follows."""
        end = time.perf_counter() + 0.15
        while time.perf_counter() < end:
            self.monitor.step(5)

    def turn_to(self, screen: str) -> None:
        """Turn to a screen without events, with the pointer over nothing."""
        if screen not in self.viewer.screens:
            raise AbsentError(f"there is no screen {screen!r}")
        self.viewer.board.close()
        self.viewer.session.turn_to(screen)
        self.viewer.tell("")
        self.do(at((300, 60)))

    def place(self, label: str, share: Share = (0.5, 0.5)) -> tuple[int, int]:
        """A place in the widget of a label or a key, or the handle whose label begins so."""
        for widget in self.viewer.board.widgets():
            if label in (widget.label, widget.key):
                left, top, right, bottom = widget.area
                return round(left + share[0] * (right - left)), round(top + share[1] * (bottom - top))
        for handle in self.viewer.board.content.handles:
            if handle.label.startswith(label):
                return handle.element, handle.line
        raise AbsentError(f"nothing is called {label!r} on the screen {self.viewer.page!r}")


def at(place: tuple[int, int], action: str = "move", button: int = 0) -> Pointer:
    """What the mouse does at a place."""
    return Pointer(*place, action, button)


class Case(NamedTuple):
    """A kind of event on a screen, its limit in milliseconds, and what measures it."""

    name: str
    screen: str
    limit: float
    shown: Callable[[Bench, int], Iterator[Shown]]
    prepare: Callable[[Bench], object] = lambda _: None


def key(*texts: str) -> Callable[[Bench, int], Iterator[Shown]]:
    """Keys that are pressed in turns."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        for number in range(rounds):
            text = texts[number % len(texts)]
            yield bench.shown(Key(text, text))
            bench.monitor.input.release(text)
            bench.do()

    return shown


def drag(label: str, start: Share = (0.3, 0.5), end: Share = (0.7, 0.5)) -> Callable[..., Iterator[Shown]]:
    """A widget that is dragged to and fro between two shares of its area, or a handle by as many elements."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        here, there = bench.place(label, start), bench.place(label, end)
        if here == there:
            here, there = (here[0] - 15, here[1] - 5), (here[0] + 15, here[1] + 5)
            bench.do(at(bench.place(label)), at(bench.place(label), "press", LEFT))
        else:
            bench.do(at(here), at(here, "press", LEFT))
        bench.do(at(there))
        for number in range(rounds):
            # No place comes twice in a row.
            share = abs(number % 20 - 10) / 10
            element, line = (round(a + share * (b - a)) for a, b in zip(here, there, strict=True))
            yield bench.shown(at((element, line)))
        bench.monitor.input.add(at((element, line), "release", LEFT))

    return shown


def hover(*labels: str) -> Callable[..., Iterator[Shown]]:
    """The pointer goes from one row of the menu to the next."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        places = [bench.place(label) for label in labels]
        for number in range(rounds):
            yield bench.shown(at(places[number % len(places)]))

    return shown


def menu(bench: Bench, rounds: int) -> Iterator[Shown]:
    """The pointer touches the right edge, and the menu comes; it goes before the next time."""
    for _ in range(rounds):
        bench.do(at((300, 60)))
        yield bench.shown(at((639, 60)))


def turn(title: str) -> Callable[..., Iterator[Shown]]:
    """A row of the main menu is clicked, and its screen comes."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        for _ in range(rounds):
            bench.turn_to("picture")
            bench.do(at((639, 60)))
            place = bench.place(title)
            bench.do(at(place), at(place, "press", LEFT))
            yield bench.shown(at(place, "release", LEFT))

    return shown


def across(start: Callable[[Bench], tuple[int, int]]) -> Callable[..., Iterator[Shown]]:
    """A drag over the picture that goes to the right from a place."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        element, line = start(bench)
        bench.do(at((element, line), "press", LEFT), at((element + 6, line)))
        for number in range(rounds):
            place = element + 6 + 3 * (number + 1), line + number % 2
            yield bench.shown(at(place))
        bench.monitor.input.add(at(place, "release", LEFT))

    return shown


def background(bench: Bench) -> tuple[int, int]:
    """A place where a drag turns the object."""
    return 250, 60


def legend_of(bench: Bench) -> tuple[int, int]:
    """A place on the legend of a scalar, which is in the upper left corner of the picture."""
    session = bench.viewer.session
    session.edit(session.scene.with_scalar(name="z", legend_place=(0.0, 0.0)))
    bench.viewer.tell("")
    return bench.place("the legend")


def split(bench: Bench) -> None:
    """A color that is compared with the color before, side by side."""
    session = bench.viewer.session
    change_paint(session, object_color="#2040b0")
    switch_split(session)
    bench.viewer.tell("")


def wheel(label: str) -> Callable[..., Iterator[Shown]]:
    """The wheel goes to and fro over a widget."""

    def shown(bench: Bench, rounds: int) -> Iterator[Shown]:
        place = bench.place(label)
        for number in range(rounds):
            yield bench.shown(at(place, ("wheel up", "wheel down")[number % 2]))

    return shown


def pick(label: str, share: Share = (0.5, 0.5)) -> Callable[[Bench], object]:
    """What is clicked before a case."""

    def prepare(bench: Bench) -> None:
        place = bench.place(label, share)
        bench.do(at(place), at(place, "press", LEFT), at(place, "release", LEFT))

    return prepare


def curve(mapping: str) -> Callable[[Bench], object]:
    """The mapping that a case begins with."""

    def prepare(bench: Bench) -> None:
        session = bench.viewer.session
        session.edit(session.scene.replace(mapping=mapping))
        bench.viewer.tell("")

    return prepare


CASES: Sequence[Case] = (
    Case("color, by a key", "picture", 4, key("c")),
    Case("blend, by a key", "picture", 4, key("[", "]")),
    Case("color mixing: red, dragged", "mixing", 4, drag("object, red")),
    Case("color mixing: white, dragged", "mixing", 4, drag("object, white")),
    Case("color mixing: hue, dragged", "mixing", 4, drag("object, hue")),
    Case("color mixing: blend, dragged", "mixing", 4, drag("blend bar")),
    Case("light blending: level, dragged", "blending", 4, drag("blend level", (0.5, 0.3), (0.5, 0.7))),
    Case("mapping: a point, dragged", "mapping", 8, drag("intensity 0."), pick("straight")),
    Case("mapping: equalize", "mapping", 20, wheel("mapping"), curve("logarithm")),
    Case("lights: intensity, dragged", "lights", 10, drag("intensity")),
    Case("lights: intensity, dragged in the list", "lights", 10, drag("light list.back.intensity")),
    Case("lights: a highlight, dragged", "lights", 20, drag("highlight of back")),
    Case("lights: position, dragged", "lights", 10, drag("position x")),
    Case("light & view: a light, dragged", "light and view", 10, drag("key: x")),
    Case("light & view: an aim, dragged", "light and view", 10, drag("key: aim")),
    Case("scalar: the legend, dragged", "picture", 20, across(legend_of)),
    Case("split: the line, dragged", "picture", 10, across(background), split),
    Case("the menu comes", "picture", 20, menu),
    Case("the menu: over its rows", "lights", 20, hover("intensity", "on", "cone angle")),
    Case("the lights screen comes", "picture", 20, turn("lights")),
    Case("the mapping screen comes", "picture", 20, turn("mapping")),
    Case("the page of three views comes", "picture", 50, turn("views")),
)
"""On the coupe. A new screen is a line here."""

CASES_OF_MANY: Sequence[Case] = (
    Case("a light, dragged by its bar", "lights", 33, drag("position x")),
    Case("a light, dragged in a view", "light and view", 33, drag("key: x")),
    Case("the view, dragged", "picture", 33, across(background)),
)
"""On a mesh of 100,000 polygons; the picture may be coarse while it moves."""


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """The rows of both scenes; with `quick` of the coupe alone."""
    missing = [program for program in ("Xvfb",) if shutil.which(program) is None]
    rows = []
    with nullcontext() if missing else screen(), TemporaryDirectory() as folder:
        if missing:
            os.environ["SDL_VIDEODRIVER"] = "dummy"
        scenes: list[tuple[str, autocolor.Scene, Sequence[Case]]] = [
            ("the coupe", autocolor.read_scene(COUPE), CASES)
        ]
        if not quick:
            many = autocolor.scene_of(hills(side_of(MANY_POLYGONS)))
            scenes.append((f"{MANY_POLYGONS:,} polygons", many, CASES_OF_MANY))
        for name, scene, cases in scenes:
            for case in cases:
                with opened(scene, Path(folder)) as bench:
                    rows.append({"scene": name, **row(case, bench, rounds)})
    return {"rounds": rounds, "absent": missing, "targets": rows}


@contextmanager
def opened(scene: autocolor.Scene, folder: Path) -> Iterator[Bench]:
    """A window for one case, so that none inherits from another."""
    bench = Bench(scene, folder)
    try:
        yield bench
    finally:
        bench.close()


def row(case: Case, bench: Bench, rounds: int) -> dict[str, Any]:
    """What is told of a case."""
    found: dict[str, Any] = {"case": case.name, "limit": case.limit}
    try:
        bench.turn_to(case.screen)
        case.prepare(bench)
        shown = list(case.shown(bench, rounds + WARMING))[WARMING:]
    except AbsentError as absent:
        return found | {"verdict": "skipped", "reason": str(absent)}
    return found | figures(shown, case.limit) | {"left over": left_over(bench)}


def figures(shown: Sequence[Shown], limit: float) -> dict[str, Any]:
    """Milliseconds: the median and the worst on the wall, the median of the processor; and the verdict."""
    wall = sorted(1e3 * each.wall for each in shown)
    median = statistics.median(wall)
    return {
        "median": median,
        "worst": wall[-1],
        "processor": statistics.median(1e3 * each.processor for each in shown),
        "without a field": sum(not each.came for each in shown),
        "verdict": "met" if median <= limit else "MISSED",
    }


def left_over(bench: Bench) -> int:
    """Events that wait, and edits that are made, after the release and the field that showed it."""
    queue = bench.monitor.input
    while queue:
        bench.monitor.step(0)
    scene, late = bench.viewer.studio.scene, 0
    end = time.perf_counter() + 0.2
    while time.perf_counter() < end:
        bench.monitor.step(5)
        late += len(queue) + (bench.viewer.studio.scene is not scene)
        scene = bench.viewer.studio.scene
    return late


def text(measured: dict[str, Any]) -> str:
    """A line a case, under the name of its scene."""
    lines = []
    if measured["absent"]:
        lines.append(f"not installed: {', '.join(measured['absent'])}; the window is none\n")
    name = ""
    for each in measured["targets"]:
        if each["scene"] != name:
            name = each["scene"]
            head = f"{name}, milliseconds to the field"
            lines.append(
                f"{head:40}{'limit':>7}{'median':>9}{'of limit':>10}{'worst':>9}{'processor':>11}"
                f"{'left over':>11}"
            )
        if "median" not in each:
            lines.append(f"{each['case']:40}{each['limit']:7g}  {each['verdict']}: {each['reason']}")
            continue
        note = f"  {each['without a field']} without a field" if each["without a field"] else ""
        lines.append(
            f"{each['case']:40}{each['limit']:7g}{each['median']:9.1f}"
            f"{each['median'] / each['limit']:10.2f}{each['worst']:9.1f}{each['processor']:11.1f}"
            f"{each['left over']:11}  {each['verdict']}{note}"
        )
    return "\n".join(lines)
