"""The page in a browser: `python -m benchmarks page` has the milliseconds of script that a change takes.

Sliders of the coupe's page are moved in Debian's Chromium, and the coupe is turned. A change is everything
that the script does before the browser paints: entries or words, colors of pixels, controls. The clock of a
page is precise to 0.1 ms. Without Chromium and playwright nothing is measured.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import autocolor
from benchmarks.cases import Spread, spread
from benchmarks.targets import MET, MISSED

CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
SCENE = Path(__file__).parents[1] / "scenes" / "coupe"
ROUNDS = 60
VIEWS = 12
COLOR, BLEND, STRENGTH = "Green of the object color of body", "Blend of body", "Strength of light key"


class Change(NamedTuple):
    """A slider that is moved on a page of the coupe with a smoothness; a turn if it is empty."""

    name: str
    slider: str
    smooth: int
    bound: float | None = None
    """The milliseconds that the median may take."""


CHANGES = (
    Change("a color, 640 x 480", COLOR, 1, 4),
    Change("a color, 1280 x 960", COLOR, 2, 4),
    Change("the blend, 1280 x 960", BLEND, 2, 4),
    Change("the strength of a light, 640 x 480", STRENGTH, 1, 4),
    Change("the strength of a light, 1280 x 960", STRENGTH, 2),
    Change("a turn, 1280 x 960", "", 2, 100),
)
MOVED = """async ([label, rounds]) => {
    const slider = document.querySelector(`input[aria-label^="${label}"]`);
    const seconds = [];
    for (let round = 0; round < rounds; round++) {
        await new Promise(requestAnimationFrame);
        if (!label) {
            const status = document.querySelector("[role=status]");
            const shown = new Promise(resolve =>
                new MutationObserver(resolve).observe(status, {childList: true}));
            const begun = performance.now();
            document.querySelector("[aria-label='Turn right']").click();
            await shown;
            seconds.push((performance.now() - begun) / 1000);
            continue;
        }
        slider.value = slider.max * (0.1 + 0.8 * (round * 0.618 % 1));
        const begun = performance.now();
        slider.dispatchEvent(new Event("input", {bubbles: true}));
        seconds.push((performance.now() - begun) / 1000);
    }
    return seconds;
}"""


@contextmanager
def browser() -> Iterator[Any]:
    """A headless Chromium. Raises ImportError without playwright."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield launched
        launched.close()


def change_seconds(rounds: int, changes: tuple[Change, ...] = CHANGES) -> dict[str, Spread]:
    """The seconds of script of each change, by name."""
    scene = autocolor.read_scene(SCENE)
    found = {}
    with browser() as launched, TemporaryDirectory() as folder:
        for change in changes:
            path = Path(folder) / f"{change.smooth}.html"
            if not path.exists():
                autocolor.save_page(path, scene, smooth=change.smooth, views=VIEWS, lights=True)
            page = launched.new_page()
            page.goto(path.as_uri())
            page.wait_for_selector(".desk")
            # The first changes are not compiled yet.
            seconds = page.evaluate(MOVED, [change.slider, rounds + rounds // 3])
            found[change.name] = spread(seconds[rounds // 3 :])
            page.close()
    return found


def page_kilobytes(views: int | None, lights: bool) -> float:
    """The size of the page of the coupe, as `autocolor page` writes it."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "coupe.html"
        autocolor.save_page(path, autocolor.read_scene(SCENE), views=views, lights=lights)
        return path.stat().st_size / 1000


def measure(rounds: int = ROUNDS, quick: bool = False) -> dict[str, Any]:
    """The milliseconds of each change, which changes keep to their bounds, and the sizes of pages."""
    if find_spec("playwright") is None or not Path(CHROMIUM).is_file():
        return {"skipped": f"playwright or {CHROMIUM} is not installed", "targets": []}
    changes = CHANGES[:1] if quick else CHANGES
    milliseconds = {name: each.times(1e3) for name, each in change_seconds(rounds, changes).items()}
    return {
        "changes ms": {name: each._asdict() for name, each in milliseconds.items()},
        "targets": [
            {
                "target": each.name,
                "bound": each.bound,
                "verdict": MET if milliseconds[each.name].median <= each.bound else MISSED,
            }
            for each in changes
            if each.bound is not None
        ],
        "pages kB": {
            f"coupe{turns}{lit}": page_kilobytes(views, bool(lit))
            for turns, views in (("", None), (f", {VIEWS} views", VIEWS))
            for lit in ("", ", lights")
        },
    }


def text(measured: dict[str, Any]) -> str:
    """The changes and the sizes as a table."""
    if "skipped" in measured:
        return f"skipped: {measured['skipped']}"
    verdicts = {row["target"]: f"<= {row['bound']:g}  {row['verdict']}" for row in measured["targets"]}
    lines = [f"{'a change':40}{'ms':>8}{'quartiles':>16}  bound"]
    for name, each in measured["changes ms"].items():
        quartiles = f"{each['low']:.1f} - {each['high']:.1f}"
        lines.append(f"{name:40}{each['median']:8.1f}{quartiles:>16}  {verdicts.get(name, '')}".rstrip())
    return "\n".join(
        lines + [f"page of the {name}: {size:.0f} kB" for name, size in measured["pages kB"].items()]
    )
