"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

import threading
import time
from concurrent.futures import Future
from contextvars import copy_context
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

import click

from autocolor.commands.options import bringing_paints, flag, option, paints_option, recover_option
from autocolor.commands.scenes import SceneSource, ended, scene_options, session_of
from autocolor.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from autocolor.arrays import Words
    from autocolor.journal.history import History
    from autocolor.journal.journal import JournalSession
    from autocolor.screens.viewer import Viewer
    from ramtek_emu.monitor.window import Key, Monitor, Pointer

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
@scene_options("settings", "normals", "paper", required=False)
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
        viewer.session.place_meshes(source.up, source.scale)
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


def show(
    history: History,
    left: Path | None = None,
    prepare: Callable[[Viewer], object] = lambda _: None,
    waiting: Waiting | None = None,
) -> None:
    """Show the scene of a session in a window, until the window is closed.

    `left` is the folder of a recovered session's journal. `prepare` is called with the viewer at the
    beginning. `waiting` is the window in which the user waited for the session. Raises UnavailableError
    without a screen.
    """
    from autocolor.errors import UnavailableError
    from ramtek_emu import NoScreenError, Ramtek9300
    from ramtek_emu.monitor.window import open_screen

    waiting = waiting or Waiting(history.scene.name)
    try:
        # Fail before rendering if there is no screen.
        open_screen()
        display = Ramtek9300()

        def begun() -> Viewer:
            from autocolor.screens.viewer import Viewer

            return Viewer(history, display)

        viewer = waiting.until("rendering", begun)
        viewer.session.is_at_hand = True
        prepare(viewer)
        waiting.monitor.display = display
        # Importing it takes long; the thread did.
        from autocolor.commands.sessions import autosaved_session

        with autosaved_session(viewer, left) as update:
            connected(waiting.monitor, viewer, update).run()
    except NoScreenError as error:
        raise UnavailableError(
            f"{error}; `autocolor render` writes the demo to coupe.png, and `autocolor render SCENE -o PNG`"
            " renders any scene"
        ) from None


# Reading a large scene takes seconds, and so does its first picture. They are computed in a thread, while the
# main thread shows a window with a message, answers the user who closes it, and gets the signals.

FIRST_SIGN_SECONDS: Final = 0.2
"""Assumed: after this time the window opens. Most errors are found before, so that no window flashes up."""

TICK_MILLISECONDS: Final = 15
TEXT_ELEMENTS: Final = 7
"""The elements of a character."""

Result = TypeVar("Result")


class Waiting:
    """The window in which the user waits for the picture of a scene of this name.

    `monitor` shows a display of its own; it is opened when the work takes a while.
    """

    def __init__(self, name: str, full_screen: bool = False, fit: bool = False) -> None:
        from ramtek_emu import Ramtek9300
        from ramtek_emu.monitor.window import Monitor

        self.monitor = Monitor(Ramtek9300(), full_screen=full_screen, fit=fit, on_key=lambda _: True)
        self._name = name
        self._opens_at = time.monotonic() + FIRST_SIGN_SECONDS

    def until(self, doing: str, work: Callable[[], Result]) -> Result:
        """The result of a function, while the window says what it is doing, such as "reading".

        An error of the function closes the window and is raised. If the user closes the window, the command
        ends; the thread is abandoned, and ends with the process.
        """
        done: Future[Result] = Future()

        def run() -> None:
            try:
                done.set_result(work())
            except BaseException as error:
                done.set_exception(error)

        thread = threading.Thread(target=copy_context().run, args=(run,), daemon=True)
        thread.start()
        thread.join(max(0.0, self._opens_at - time.monotonic()))
        try:
            if thread.is_alive():
                self._wait(f"{doing} {self._name} ...", thread)
            return done.result()
        except BaseException:
            self.monitor.close()
            raise

    def _wait(self, message: str, thread: threading.Thread) -> None:
        """Show a message until the thread ends. Without a screen, wait for its errors, which come first."""
        from ramtek_emu import NoScreenError

        monitor = self.monitor
        try:
            if not monitor.is_open:
                monitor.open()
        except NoScreenError:
            thread.join()
            return
        monitor.caption = f"autocolor - {message}"
        monitor.display.send(message_alone(message))
        while thread.is_alive():
            if not monitor.step(TICK_MILLISECONDS):
                raise click.exceptions.Exit(0)


def message_alone(message: str) -> Words:
    """The instructions that show a message in the middle of a black field; its end, if it is too long."""
    from ramtek_emu import GMR_9300, instructions

    elements, lines = GMR_9300.shown_elements, GMR_9300.shown_lines
    text = message[-(elements // TEXT_ELEMENTS) :]
    left, top = (elements - TEXT_ELEMENTS * len(text)) // 2, lines // 2
    return instructions.concatenate(
        instructions.load_entries(0, ((0, 0, 0), (255, 255, 255))),
        instructions.erase((0, 0, elements - 1, lines - 1), 0),
        instructions.write_text(text, left, top, 1, 0),
    )


def connected(monitor: Monitor, viewer: Viewer, update: Callable[[], None] = lambda: None) -> Monitor:
    """The monitor, which then passes its input to a viewer; `update` is called at every tick."""
    from autocolor.screens.session import Clipboard

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

    monitor.caption = viewer.caption
    monitor.on_key, monitor.on_release = on_key, viewer.on_release
    monitor.on_pointer, monitor.on_drop = on_pointer, viewer.on_drop
    monitor.on_tick, monitor.on_close, monitor.on_message = on_tick, viewer.on_close, viewer.tell
    monitor.screenshots, monitor.file_name = viewer.folder, "autocolor"
    viewer.session.clipboard = Clipboard(monitor.copy, monitor.paste)
    return monitor
