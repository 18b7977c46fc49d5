"""The built-in demo, the coupe. It is inside the installed package, or in `scenes` of a checkout."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Final

from autocolor.errors import MissingInputError

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.journal.history import History
    from autocolor.scene.scene import Scene

PACKAGE: Final = Path(__file__).resolve().parents[1]
PLACES: Final = (PACKAGE / "demo_scene", PACKAGE.parent / "scenes" / "coupe")


def demo_folder() -> Path:
    """The folder of the demo scene. Raises MissingInputError if it is not installed."""
    for place in PLACES:
        if (place / "scene.toml").is_file():
            return place
    raise MissingInputError(
        f"the built-in demo must be at {PLACES[0]}, but no scene is there; install autocolor again"
    )


def demo() -> Scene:
    """The scene of the built-in demo, the coupe. Raises MissingInputError if it is not installed."""
    return demo_report().scene


def demo_report() -> SceneReport:
    """The scene of `demo`, with its report. Raises MissingInputError if it is not installed."""
    from autocolor.files.opening import read_scene_with_report

    report = read_scene_with_report(demo_folder())
    return dataclasses.replace(report, scene=report.scene.replace(name="coupe"))


def demo_session() -> History:
    """A session with the demo. Raises MissingInputError if it is not installed."""
    from autocolor.journal.history import History
    from autocolor.journal.places import ScenePlace, Source

    folder = demo_folder()
    # The user has not named the demo's files, so saving makes new files.
    return History(demo(), ScenePlace(Source(str(folder))))
