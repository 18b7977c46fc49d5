"""`autocolor show`: the interactive system with a scene, on another display."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import bringing_paints, flag, option, paints_option, recover_option
from autocolor.commands.scenes import SceneSource, ended, scene_options, session_of
from autocolor.errors import UnavailableError, UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from autocolor.arrays import Bytes
    from autocolor.journal.history import History
    from autocolor.scene.scene import Scene
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import TcpPort, UnixPort

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300 --window                      (on the machine with the screen)
  autocolor show scenes/coupe --to tcp://127.0.0.1:9300
  autocolor show scenes/coupe --to tcp://127.0.0.1:9300 --once
  autocolor show --recover --to tcp://127.0.0.1:9300
"""

BUTTONS: Final = "the right edge brings the menu; ENTER (left button) picks, TRACK (right button) drags"
"""The first message on the display. In the window of `ramtek serve`, the mouse is the joystick unit."""

TIMEOUT: Final = 30.0
"""The longest wait for the display, in seconds, unless the user gives another."""

timeout_option = option(
    "--timeout",
    "SECONDS",
    "Longest wait for the display. A slow line needs more.",
    click.FloatRange(0.1, 86400),
    default=TIMEOUT,
)


@click.command(epilog=EXAMPLES)
@scene_options("settings", "stage", required=False)
@option(
    "--to address",
    "tcp://HOST:PORT",
    "Address of the display, or the path of its Unix socket.",
    str,
    required=True,
)
@recover_option
@paints_option
@timeout_option
@flag("--once", "Send the picture and exit; the display keeps showing it.")
def show(
    source: SceneSource, address: str, recover: str | None, paints: str | None, timeout: float, once: bool
) -> int:
    """Show SCENE on another display, such as `ramtek serve`, and follow its joystick.

    All functions of `view` are available by pointing: ENTER picks, TRACK drags, and the right edge opens the
    menu. In the window of `ramtek serve`, the left button is ENTER, and the right button is TRACK. Files are
    opened and saved only in the folder of the scene. To end the command, pick `leave` in the menu, or press
    Ctrl+C.
    """
    refuse_address(address)
    if (source.scene is None) == (recover is None):
        raise UsageError("show must have either SCENE or --recover; name a scene")
    if recover is not None and (source.settings or once):
        raise UsageError("--set and --once are for SCENE, not for sessions; leave them out")
    if once and paints is not None:
        raise UsageError("--paints is for an interactive session, not for --once; leave one of them out")
    bring = bringing_paints(paints)
    if recover is not None:
        from autocolor.commands.sessions import chosen_session

        left, session = chosen_session(recover)
        session_elsewhere(session.history, address, folder_of(session.source.path), left, bring, timeout)
        return 0
    tell(f"reading {source.path}")
    report, history = session_of(source)
    if once:
        show_once(history.scene, address, timeout)
    else:
        session_elsewhere(history, address, folder_of(source.path), prepare=bring, timeout=timeout)
    return ended(report, source)


def show_once(scene: Scene, address: str, timeout: float = TIMEOUT) -> None:
    """Send the picture of a scene to a display. Raises UnavailableError if none answers at the address."""
    from autocolor.studio import Studio

    with port_to(address, timeout) as port:
        require_display(port, address, Studio(scene, port).entries)
    tell(f"shown on {address}")


def require_display(port: TcpPort | UnixPort, address: str, entries: Bytes) -> None:
    """Raise UnavailableError unless the display replies with the entries that were sent last.

    A server that is no display replies with other words or none. The display replies only after it has
    executed all earlier instructions.
    """
    from ramtek_emu import ReplyError, instructions

    # The display replies with the words of the load, without its instruction, address and length.
    _, _, _, *sent = instructions.load_entries(0, entries).tolist()
    port.send(instructions.read_entries(0, len(sent)))
    try:
        replied = port.receive(len(sent)).tolist()
    except ReplyError:
        raise _without_answer(port, address) from None
    if replied != sent:
        raise UnavailableError(
            f"a display must answer at {address}, and another server does; check the address, or start"
            " `ramtek serve` there"
        )


def _without_answer(port: TcpPort | UnixPort, address: str) -> UnavailableError:
    return UnavailableError(
        f"a display must answer within {port.timeout:g} seconds, and {address} does not; it may be serving"
        " another host first, or a slow line needs a longer --timeout"
    )


def folder_of(scene: str) -> Path:
    """The folder of a scene, or the scene's file; for the built-in demo, the current folder."""
    from autocolor.files.paths import DEMO, example_scenes

    path = Path(scene).absolute()
    folder = path if path.is_dir() else path.parent
    return Path.cwd() if folder == example_scenes().get(DEMO) else folder


def session_elsewhere(
    history: History,
    address: str,
    folder: Path,
    left: Path | None = None,
    prepare: Callable[[Viewer], object] = lambda _: None,
    timeout: float = TIMEOUT,
) -> None:
    """Run the interactive system with a session on the display at an address, until its user leaves.

    Files are opened and saved in `folder`. `left` is the folder of a recovered session's journal. `prepare`
    is called with the viewer at the beginning. The only input is polled: the cursor, ENTER and TRACK. All
    other input goes through menus. Raises UnavailableError if the display does not answer or disconnects,
    PortError if it cannot be reached.
    """
    from autocolor.commands.sessions import autosaved_session
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import PortError, ReplyError

    with port_to(address, timeout) as port:
        try:
            viewer = Viewer(history, port, folder)
            require_display(port, address, viewer.studio.entries)
            viewer.tell(BUTTONS, persistent=True)
            prepare(viewer)
            tell(f"shown on {address}; pick `leave` in the menu there, or press Ctrl+C here")
            with autosaved_session(viewer, left) as update:
                attend(viewer, update)
            viewer.clear()
        except (PortError, ReplyError, UnavailableError) as error:
            message = str(_without_answer(port, address) if isinstance(error, ReplyError) else error)
            if history.steps:
                message += "; `autocolor show --recover --to ADDRESS` continues the session"
            raise UnavailableError(message) from None


def attend(viewer: Viewer, update: Callable[[], object]) -> None:
    """Poll the display until the user leaves; after each poll, call `update` and sleep."""
    from autocolor.screens.input import POLL_SECONDS

    due = time.monotonic()
    while not viewer.session.leaves:
        viewer.poll()
        viewer.on_tick()
        update()
        # A late poll does not shorten the time until the next poll.
        due = max(due + POLL_SECONDS, time.monotonic())
        time.sleep(max(0.0, due - time.monotonic()))


def refuse_address(address: str) -> None:
    """Raise UsageError unless an address is tcp://host:port, or the path of a Unix socket with a slash."""
    from ramtek_emu import PortError
    from ramtek_emu.host.port import host_and_port

    try:
        if not _is_path(address):
            host_and_port(address)
    except PortError as error:
        raise UsageError(f"--to: {error}, or the path of a Unix socket with a slash in it") from None


def port_to(address: str, timeout: float = TIMEOUT) -> TcpPort | UnixPort:
    """A port to the display at an address. Raises PortError if no display answers in `timeout` seconds."""
    from ramtek_emu import TcpPort, UnixPort

    return UnixPort(address, timeout) if _is_path(address) else TcpPort(address, timeout)


def _is_path(address: str) -> bool:
    return "/" in address and "://" not in address
