"""`autocolor show`: the interactive system with a scene, on a display elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.demo import PLACES
from autocolor.commands.scenes import SceneSource, created_again, ended, read, scene_options, set_option
from autocolor.errors import UnavailableError, UsageError

if TYPE_CHECKING:
    from autocolor.journal.history import History
    from autocolor.journal.places import Source
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


@click.command(epilog=EXAMPLES)
@partial(scene_options, required=False)
@set_option
@click.option(
    "--to",
    "address",
    required=True,
    metavar="tcp://HOST:PORT",
    help="Address of the display, or the path of its Unix socket.",
)
@click.option(
    "--recover",
    is_flag=False,
    flag_value="newest",
    metavar="[SESSION]",
    help="Continue the newest session that did not end orderly, or another; without SCENE.",
)
@click.option("--once", is_flag=True, help="Show the picture, and leave the display at once.")
@click.pass_context
def show(
    context: click.Context,
    source: SceneSource | None,
    settings: tuple[str, ...],
    address: str,
    recover: str | None,
    once: bool,
) -> None:
    """Show SCENE on the display that listens at an address, such as `ramtek serve`, and obey its joystick.

    You can do everything there that `view` does, by pointing: ENTER picks, TRACK drags, and the right edge
    brings the menu. Files are opened and saved only in the folder of the scene. `leave` in the menu ends the
    command, and so does Ctrl+C.
    """
    refuse_address(address)
    if (source is None) == (recover is None):
        raise UsageError("show must have SCENE or --recover, one of them; name a scene")
    if recover is not None and (settings or once):
        raise UsageError("--set and --once are for SCENE, not for sessions; leave them out")
    if recover is not None:
        from autocolor.commands.sessions import chosen_session

        left, session = chosen_session(recover)
        session_elsewhere(session.history, address, folder_of(session.source), left)
    elif source is not None:
        from autocolor.commands.settings import with_settings
        from autocolor.journal.history import History
        from autocolor.journal.places import Source, place_of

        origin = Source(source.path, source.up, source.surfaces, source.scale)
        place = place_of(origin)
        report = read(source)
        scene = created_again(report, with_settings(report.scene, settings))
        if once:
            show_once(scene, address)
        else:
            session_elsewhere(History(scene, place), address, folder_of(origin))
        context.exit(ended(report, source))


def show_once(scene: Scene, address: str) -> None:
    """Show a scene on the display at an address, and leave the display to other hosts."""
    from autocolor.studio import Studio
    from ramtek_emu import instructions

    with port_to(address) as port:
        Studio(scene, port)
        # The reply to this read arrives only after everything sent before it was executed.
        port.send(instructions.read_entries(0, 2))
        port.receive(2)
    click.echo(f"shown on {address}", err=True)


def folder_of(source: Source) -> Path:
    """The folder of a scene, or the scene's file; for the built-in demo, the current folder."""
    path = Path(source.path).absolute()
    folder = path if path.is_dir() else path.parent
    return Path.cwd() if folder in PLACES else folder


def session_elsewhere(
    history: History,
    address: str,
    folder: Path,
    left: Path | None = None,
    prepare: Callable[[Viewer], object] = lambda _: None,
) -> None:
    """Run the interactive system with a session on the display at an address, until its user leaves.

    Files are opened and saved in the folder. Until then the state folder has the journal; `left` is its
    folder there if the session was left before. `prepare` is called with the viewer at the beginning.

    The unit is polled for the only input: a place, ENTER and TRACK. Everything else is a row of a menu.
    Raises UnavailableError if the display goes away or does not answer, PortError if it is not reached.
    """
    from autocolor.commands.sessions import autosaved_session
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import PortError, ReplyError

    with port_to(address) as port:
        try:
            viewer = Viewer(history, port, folder)
            viewer.tell("the right edge brings the menu; ENTER picks, TRACK drags", persistent=True)
            prepare(viewer)
            click.echo(f"shown on {address}; pick `leave` in the menu there, or press Ctrl+C here", err=True)
            with autosaved_session(viewer, left) as update:
                attend(viewer, update)
            viewer.clear()
        except (PortError, ReplyError) as error:
            told = str(error)
            if isinstance(error, ReplyError):
                told = (
                    f"a display must answer within {port.timeout:g} seconds, and {address} does not; it may"
                    " be serving another host first"
                )
            if history.steps:
                told += "; `autocolor show --recover --to ADDRESS` goes on with the session"
            raise UnavailableError(told) from None


def attend(viewer: Viewer, update: Callable[[], object]) -> None:
    """Poll the unit until the user leaves; call `update` after each poll, and sleep between the polls."""
    from autocolor.screens.input import POLL_SECONDS

    due = time.monotonic()
    while not viewer.session.leaves:
        viewer.poll()
        viewer.on_tick()
        update()
        # After a late poll, the next one is no sooner than usual.
        due = max(due + POLL_SECONDS, time.monotonic())
        time.sleep(max(0.0, due - time.monotonic()))


def refuse_address(address: str) -> None:
    """Check an address: tcp://host:port, or the path of a Unix socket, which has a slash.

    Raises UsageError for any other.
    """
    from ramtek_emu import PortError
    from ramtek_emu.host.port import host_and_port

    if _is_path(address):
        return
    try:
        host_and_port(address)
    except PortError as error:
        raise UsageError(f"--to: {error}, or the path of a Unix socket with a slash in it") from None


def port_to(address: str) -> TcpPort | UnixPort:
    """A port to the display at an address. Raises PortError if no display answers."""
    from ramtek_emu import TcpPort, UnixPort

    return UnixPort(address) if _is_path(address) else TcpPort(address)


def _is_path(address: str) -> bool:
    return "/" in address and "://" not in address
