"""The built-in demo, the coupe: one of the example scenes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from autocolor.errors import MissingInputError
from autocolor.files.paths import DEMO, EXAMPLE_PLACES, example_scenes

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.journal.history import History
    from autocolor.scene.scene import Scene


def demo_folder() -> Path:
    """The folder of the demo scene. Raises MissingInputError if it is not installed."""
    folder = example_scenes().get(DEMO)
    if folder is None:
        place = EXAMPLE_PLACES[0] / DEMO
        raise MissingInputError(
            f"the built-in demo must be at {place}, but no scene is there; install autocolor again"
        )
    return folder


def demo() -> Scene:
    """The scene of the built-in demo, the coupe. Raises MissingInputError if it is not installed."""
    return demo_report().scene


def demo_report() -> SceneReport:
    """The scene of `demo`, with its report. Raises MissingInputError if it is not installed."""
    from autocolor.files.opening import read_scene_with_report

    return read_scene_with_report(demo_folder())


def demo_session() -> History:
    """A session with the demo. Raises MissingInputError if it is not installed."""
    from autocolor.journal.history import History
    from autocolor.journal.places import ScenePlace, Source

    folder = demo_folder()
    # The user has not named the demo's files, so saving makes new files.
    return History(demo(), ScenePlace(Source(str(folder))))
