"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import (
    bringing_paints,
    normals_option,
    paints_option,
    paper_option,
    with_normals,
)
from autocolor.commands.scenes import (
    SceneSource,
    created_again,
    ended,
    read,
    scene_options,
    set_option,
)
from autocolor.commands.window import Waiting, show
from autocolor.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from autocolor.files.scene_report import SceneReport
    from autocolor.journal.history import History
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
@partial(scene_options, required=False)
@set_option
@click.option(
    "--recover",
    is_flag=False,
    flag_value="newest",
    metavar="[SESSION]",
    help="Instead of SCENE, continue the newest session that was not closed, or the session of a name.",
)
@click.option("--sessions", is_flag=True, help="List the sessions that were not closed, and exit.")
@click.option("--forget", metavar="SESSION", help="Remove a session that was not closed, and exit.")
@normals_option
@paper_option
@paints_option
@click.option("--full-screen", is_flag=True, help="Open the window in full screen.")
@click.option("--fit", is_flag=True, help="Scale the picture to fill the window; pixels may become uneven.")
@click.pass_context
def view(
    context: click.Context,
    source: SceneSource | None,
    settings: tuple[str, ...],
    normals: bool,
    paper: bool,
    paints: str | None,
    recover: str | None,
    sessions: bool,
    forget: str | None,
    full_screen: bool,
    fit: bool,
) -> None:
    """Show SCENE in an interactive window; F1 there lists the keys."""
    asked = [source is not None, recover is not None, sessions, forget is not None]
    if sum(asked) != 1:
        raise UsageError(
            f"view must have one of SCENE, --recover, --sessions and --forget, not {sum(asked)}; name a scene"
        )
    for option, is_given in (("--set", bool(settings)), ("--normals", normals), ("--paper", paper)):
        if is_given and source is None:
            raise UsageError(f"{option} is for SCENE, not for sessions; leave it out")
    if paints is not None and (sessions or forget is not None):
        raise UsageError("--paints is for a scene or a session that is shown; leave it out")
    bring = bringing_paints(paints)
    if sessions or forget is not None:
        from autocolor.commands.sessions import forget_session, list_sessions

        list_sessions() if forget is None else forget_session(forget)
    elif recover is not None:
        waiting = Waiting("the session", full_screen, fit)
        folder, session = waiting.until("reading", lambda: left_session(recover))
        show(session.history, left=folder, prepare=bring, waiting=waiting)
    elif source is not None:
        waiting = Waiting(Path(source.path).name or source.path, full_screen, fit)
        report, history = waiting.until("reading", lambda: session_of(source, settings, normals, paper))

        def prepare(viewer: Viewer) -> None:
            # Meshes that the user opens later get the same up axis and scale.
            viewer.session.place_meshes(source.up, source.scale)
            bring(viewer)

        show(history, prepare=prepare, waiting=waiting)
        context.exit(ended(report, source))


def left_session(name: str) -> tuple[Path, JournalSession]:
    """The folder of a session that was not closed, and the session; see `chosen_session`."""
    from autocolor.commands.sessions import chosen_session

    return chosen_session(name)


def session_of(
    source: SceneSource, settings: tuple[str, ...], normals: bool, paper: bool = False
) -> tuple[SceneReport, History]:
    """The report of reading a scene, and a session with it, in which the settings are a step."""
    from autocolor.commands.settings import with_settings
    from autocolor.files.state import note_file
    from autocolor.journal.history import History
    from autocolor.journal.places import Source, place_of

    place = place_of(Source(source.path, source.up, source.surfaces, source.scale))
    report = read(source)
    start = report.scene.as_in_1983() if paper else report.scene
    edited = created_again(report, with_normals(with_settings(start, settings), normals))
    note_file(source.path)
    history = History(report.scene, place)
    if edited is not report.scene:
        history.take(edited)
    return report, history


def show_demo(
    full_screen: bool = False, fit: bool = False, prepare: Callable[[Viewer], object] = lambda _: None
) -> None:
    """Show the built-in demo in a window; `prepare` is as in `show`."""
    from autocolor.commands.demo import demo_session

    waiting = Waiting("the coupe", full_screen, fit)
    show(waiting.until("reading", demo_session), prepare=prepare, waiting=waiting)
