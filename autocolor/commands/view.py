"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import normals_option, with_normals
from autocolor.commands.scenes import SceneSource, created_again, ended, read, scene_options, set_option
from autocolor.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from autocolor.journal.history import History
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Monitor

EXAMPLES: Final = """\b
Examples:
  autocolor view scenes/coupe
  autocolor view car.obj --up y --full-screen
  autocolor view scenes/coupe --normals
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
@click.option("--full-screen", is_flag=True, help="Open the window in full screen.")
@click.option("--fit", is_flag=True, help="Scale the picture to fill the window; pixels may become uneven.")
@click.pass_context
def view(
    context: click.Context,
    source: SceneSource | None,
    settings: tuple[str, ...],
    normals: bool,
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
    for option, is_given in (("--set", bool(settings)), ("--normals", normals)):
        if is_given and source is None:
            raise UsageError(f"{option} is for SCENE, not for sessions; leave it out")
    if sessions or forget is not None:
        from autocolor.commands.sessions import forget_session, list_sessions

        list_sessions() if forget is None else forget_session(forget)
    elif recover is not None:
        from autocolor.commands.sessions import chosen_session

        folder, session = chosen_session(recover)
        show(session.history, full_screen, fit, folder)
    elif source is not None:
        from autocolor.commands.settings import with_settings
        from autocolor.files.state import note_file
        from autocolor.journal.history import History
        from autocolor.journal.places import Source, place_of

        place = place_of(Source(source.path, source.up, source.surfaces, source.scale))
        report = read(source)
        edited = created_again(report, with_normals(with_settings(report.scene, settings), normals))
        note_file(source.path)
        history = History(report.scene, place)
        if edited is not report.scene:
            history.take(edited)
        # Meshes that the user opens later get the same up axis and scale.
        show(
            history,
            full_screen,
            fit,
            prepare=lambda viewer: viewer.session.place_meshes(source.up, source.scale),
        )
        context.exit(ended(report, source))


def show_demo() -> None:
    """Show the built-in demo in a window."""
    from autocolor.commands.demo import demo_session

    show(demo_session())


def show(
    history: History,
    full_screen: bool = False,
    fit: bool = False,
    left: Path | None = None,
    prepare: Callable[[Viewer], object] = lambda _: None,
) -> None:
    """Show the scene of a session in a window, until the window is closed.

    `left` is the folder of a recovered session's journal. `prepare` is called with the viewer at the
    beginning. Raises UnavailableError without a screen.
    """
    from autocolor.commands.sessions import autosaved_session
    from autocolor.errors import UnavailableError
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import NoScreenError, Ramtek9300
    from ramtek_emu.monitor.window import open_screen

    try:
        # Fail before rendering if there is no screen.
        open_screen()
        display = Ramtek9300()
        viewer = Viewer(history, display)
        viewer.session.is_at_hand = True
        prepare(viewer)
        with autosaved_session(viewer, left) as update:
            monitor_of(viewer, display, full_screen, fit, update).run()
    except NoScreenError as error:
        raise UnavailableError(f"{error}; `autocolor render SCENE -o PNG` renders without a screen") from None


def monitor_of(
    viewer: Viewer,
    display: Ramtek9300,
    full_screen: bool = False,
    fit: bool = False,
    update: Callable[[], None] = lambda: None,
) -> Monitor:
    """A window, not yet open, that shows the display of a viewer and passes keys and the mouse to the viewer.

    `update` is called at every tick.
    """
    from autocolor.screens.session import Clipboard
    from ramtek_emu.monitor.window import Key, Monitor, Pointer

    def on_key(key: Key) -> bool:
        return viewer.on_key(key.name, key.control, key.shift, key.text, key.repeated)

    def on_pointer(pointer: Pointer) -> None:
        element, line, modifiers = pointer.element, pointer.line, (pointer.shift, pointer.control)
        viewer.on_pointer(element, line, pointer.action, pointer.button, pointer.steps, *modifiers)

    def on_tick() -> None:
        viewer.on_tick(monitor.is_at_rest)
        update()
        if monitor.caption != viewer.caption:
            monitor.caption = viewer.caption
        if viewer.session.leaves:
            monitor.close()

    monitor = Monitor(
        display,
        viewer.caption,
        full_screen=full_screen,
        fit=fit,
        on_key=on_key,
        on_pointer=on_pointer,
        on_release=viewer.on_release,
        on_drop=viewer.on_drop,
        on_tick=on_tick,
        on_close=viewer.on_close,
        on_message=viewer.tell,
    )
    viewer.session.clipboard = Clipboard(monitor.copy, monitor.paste)
    return monitor
