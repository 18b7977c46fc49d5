"""The interactive window on this machine: of a command, of `view`, and of a studio."""

from __future__ import annotations

import threading
import time
from concurrent.futures import Future
from contextlib import suppress
from contextvars import copy_context
from os import PathLike, fspath
from typing import TYPE_CHECKING, Final, TypeVar

import click

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from autocolor.arrays import Words
    from autocolor.journal.history import History
    from autocolor.scene.scene import Scene
    from autocolor.screens.viewer import Viewer
    from autocolor.studio import Studio
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Key, Monitor, Pointer


def view(
    scene: Scene | Studio | str | PathLike[str], *, full_screen: bool = False, fit: bool = False
) -> None:
    """Show a scene in an interactive window until the user closes it; F1 there lists the keys.

        autocolor.view("scenes/coupe")

    `scene` is a Scene, the path of a scene or a mesh (see `read_scene`), or a Studio, whose scene is then
    edited (see `Studio.view_window`). The edits of another scene are lost unless the user saves them. With
    `fit`, the picture fills the window, and its pixels may become uneven; so it does without `fit` if the
    screen has no room for twice its size. With `full_screen`, the window fills the screen.

    Raises UnavailableError without a screen, and the errors of `read_scene`.
    """
    from autocolor.journal.history import History
    from autocolor.journal.places import Source, opened
    from autocolor.scene.scene import check_scene
    from autocolor.studio import Studio

    if isinstance(scene, Studio):
        scene.view_window(full_screen=full_screen, fit=fit)
    elif isinstance(scene, (str, PathLike)):
        show_steps(History(*opened(Source(fspath(scene)))), full_screen, fit)
    else:
        check_scene(scene)
        show_steps(History(scene), full_screen, fit)


def show_steps(history: History, full_screen: bool, fit: bool, *, outlives_window: bool = False) -> None:
    """Show the scene of a session in a window, which the user may close before the first picture.

    If the session outlives the window, the user is not asked about unsaved changes.
    """

    def prepare(viewer: Viewer) -> None:
        viewer.session.outlives_window = outlives_window

    with suppress(click.exceptions.Exit):
        show(history, prepare=prepare, waiting=Waiting(history.scene.name, full_screen, fit))


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
    from ramtek_emu import NoScreenError
    from ramtek_emu.monitor.window import open_screen

    waiting = waiting or Waiting(history.scene.name)
    try:
        # Fail before rendering if there is no screen.
        open_screen()
        viewer, display = waiting.until("rendering", lambda: viewer_of(history))
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


def viewer_of(history: History) -> tuple[Viewer, Ramtek9300]:
    """The viewer of a session, and its display, which shows the picture."""
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300

    display = Ramtek9300()
    viewer = Viewer(history, display)
    viewer.session.is_at_hand = True
    return viewer, display


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

        self.monitor = Monitor(Ramtek9300(), full_screen=full_screen, fit=fit or None, on_key=lambda _: True)
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
        return viewer.on_key(key.name, key.control, key.shift, key.text, key.repeated, key.alt)

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
    viewer.session.clipboard = Clipboard(monitor.glass.copy, monitor.glass.paste)
    return monitor
