"""`autocolor show`: the interactive system with a scene, on a display elsewhere."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.demo import PLACES
from autocolor.commands.displays_elsewhere import port_to, refuse_address, session_elsewhere
from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.commands.settings import created_again, set_option, with_settings
from autocolor.errors import UsageError

if TYPE_CHECKING:
    from autocolor.journal.places import Source
    from autocolor.scene.scene import Scene

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
    help="Go on with the newest session that did not end orderly, or with another; without SCENE.",
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

    All that `view` does can be done there by pointing: ENTER picks, TRACK drags, and the right edge brings
    the menu. Files are opened and saved in the folder of the scene alone. It ends by `leave` in the menu or
    by Ctrl+C.
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
    """Show a scene on the display at an address, and leave it for others."""
    from autocolor.studio import Studio
    from ramtek_emu import instructions

    with port_to(address) as port:
        Studio(scene, port)
        # The reply to this read arrives only after everything sent before it was executed.
        port.send(instructions.read_entries(0, 2))
        port.receive(2)
    click.echo(f"shown on {address}", err=True)


def folder_of(source: Source) -> Path:
    """The folder that a scene is in, or that is one; for the built-in demo, the current folder."""
    path = Path(source.path).absolute()
    folder = path if path.is_dir() else path.parent
    return Path.cwd() if folder in PLACES else folder
