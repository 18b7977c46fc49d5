"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import bringing_paints, flag, option, paints_option, recover_option
from autocolor.commands.scenes import SceneSource, ended, scene_options, session_of
from autocolor.commands.window import Waiting, show
from autocolor.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from autocolor.journal.journal import JournalSession
    from autocolor.screens.viewer import Viewer

EXAMPLES: Final = """\b
Examples:
  autocolor view scenes/coupe
  autocolor view car.obj --up y --full-screen
  autocolor view scenes/coupe --normals
  autocolor view scenes/coupe --paints paints.gpl
  autocolor view --recover
  autocolor view scenes/coupe --set background=navy --set lights.key.cone_angle=none
"""


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", "normals", "paper", required=False)
@recover_option
@flag("--sessions", "List the sessions that were not closed, and exit.")
@option("--forget", "SESSION", "Remove a session that was not closed, and exit.", str)
@paints_option
@flag("--full-screen", "Open the window in full screen.")
@flag("--fit", "Scale the picture to fill the window; pixels may become uneven.")
def view(
    source: SceneSource,
    paints: str | None,
    recover: str | None,
    sessions: bool,
    forget: str | None,
    full_screen: bool,
    fit: bool,
) -> int:
    """Show SCENE in an interactive window; F1 there lists the keys."""
    asked = [source.scene is not None, recover is not None, sessions, forget is not None]
    if sum(asked) != 1:
        raise UsageError(
            f"view must have one of SCENE, --recover, --sessions and --forget, not {sum(asked)}; name a scene"
        )
    options = {"--set": source.settings, "--normals": source.normals, "--paper": source.paper}
    if source.scene is None and (of_scene := [option for option, value in options.items() if value]):
        raise UsageError(f"{of_scene[0]} is for SCENE, not for sessions; leave it out")
    if paints is not None and (sessions or forget is not None):
        raise UsageError("--paints is for a scene or a session that is shown; leave it out")
    bring = bringing_paints(paints)
    if sessions or forget is not None:
        from autocolor.commands.sessions import forget_session, list_sessions

        list_sessions() if forget is None else forget_session(forget)
        return 0
    if recover is not None:

        def recovered() -> tuple[Path, JournalSession]:
            from autocolor.commands.sessions import chosen_session

            return chosen_session(recover)

        waiting = Waiting("the session", full_screen, fit)
        folder, session = waiting.until("reading", recovered)
        show(session.history, left=folder, prepare=bring, waiting=waiting)
        return 0
    from autocolor.files.state import note_file

    waiting = Waiting(Path(source.path).name or source.path, full_screen, fit)
    report, history = waiting.until("reading", lambda: session_of(source))
    note_file(source.path)

    def prepare(viewer: Viewer) -> None:
        # Meshes that the user opens later get the same up axis and scale.
        viewer.session.mesh_up, viewer.session.mesh_scale = source.up, source.scale
        bring(viewer)

    show(history, prepare=prepare, waiting=waiting)
    return ended(report, source)


def show_demo(
    full_screen: bool = False, fit: bool = False, prepare: Callable[[Viewer], object] = lambda _: None
) -> None:
    """Show the built-in demo in a window; `prepare` is as in `show`."""
    from autocolor.commands.demo import demo_session

    waiting = Waiting("the coupe", full_screen, fit)
    show(waiting.until("reading", demo_session), prepare=prepare, waiting=waiting)
