"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.commands.settings import created_again, set_option, with_settings

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from autocolor.journal.history import History
    from autocolor.journal.script import Source
    from autocolor.scene.scene import Scene
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Monitor

EXAMPLES: Final = """\b
Examples:
  autocolor view scenes/coupe
  autocolor view car.obj --up y --full-screen
  autocolor view --recover
  autocolor view scenes/coupe --set background=navy --set lights.key.cone_angle=none
"""


@click.command(epilog=EXAMPLES)
@scene_options
@set_option
@click.option(
    "--recover",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=lambda context, _, asked: recover(context) if asked else None,
    help="Go on with the last session that did not end orderly; without SCENE.",
)
@click.option("--full-screen", is_flag=True, help="Open the window in full screen.")
@click.option("--fit", is_flag=True, help="Scale the picture to fill the window; pixels may become uneven.")
@click.pass_context
def view(
    context: click.Context,
    source: SceneSource,
    settings: tuple[str, ...],
    full_screen: bool,
    fit: bool,
) -> None:
    """Show SCENE in an interactive window; press F1 there for a list of keys."""
    from autocolor.journal.script import Source

    report = read(source)
    edited = created_again(report, with_settings(report.scene, settings))
    show(edited, Source(source.path, source.up, source.surfaces), full_screen, fit)
    context.exit(ended(report, source))


def show_demo() -> None:
    """Show the built-in demo in a window."""
    from autocolor.commands.demo import demo_folder
    from autocolor.files.scene_sources import read_scene
    from autocolor.journal.script import Source

    folder = demo_folder()
    show(read_scene(folder), Source(str(folder)))


def recover(context: click.Context) -> None:
    """Go on with the last session that did not end orderly, and exit."""
    from autocolor.errors import InputError, MissingInputError
    from autocolor.journal.autosave import JOURNAL, left_sessions
    from autocolor.journal.reading import read_journal

    if context.resilient_parsing:
        return
    for left in left_sessions():
        try:
            session = read_journal(left / JOURNAL)
        except InputError as error:
            click.echo(f"autocolor: {left}: {error}", err=True)
        else:
            show(session.history, session.source, left=left)
            context.exit()
    raise MissingInputError(
        "--recover: there must be a session that did not end orderly and can be read, and there is none;"
        " name a scene"
    )


def show(
    scene: Scene | History,
    source: Source,
    full_screen: bool = False,
    fit: bool = False,
    left: Path | None = None,
) -> None:
    """Show a scene, or the session whose folder was left, in a window until that is closed.

    `source` is what the first scene was read from. The journal of the session is kept in the state folder
    until then. Raises UnavailableError if there is no screen.
    """
    from autocolor.commands.kept_session import kept_session
    from autocolor.errors import UnavailableError
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import NoScreenError, Ramtek9300
    from ramtek_emu.monitor.window import open_screen

    try:
        # Fail before rendering if there is no screen.
        open_screen()
        display = Ramtek9300()
        viewer = Viewer(scene, display)
        with kept_session(viewer, source, left) as update:
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
    """A window, not yet open, that shows the display of a viewer and hands keys and the mouse to it.

    `update` is called after each change, and often.
    """
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

    monitor = Monitor(
        display,
        viewer.caption,
        full_screen=full_screen,
        fit=fit,
        screenshot_name="autocolor",
        on_key=on_key,
        on_pointer=on_pointer,
        on_release=viewer.on_release,
        on_drop=viewer.on_drop,
        on_tick=on_tick,
        on_close=viewer.on_close,
        on_message=viewer.tell,
    )
    return monitor
