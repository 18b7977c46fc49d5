"""`autocolor tutorial`: the interactive system step by step, on the built-in demo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import verbose_option
from autocolor.commands.show import refuse_address, session_elsewhere

if TYPE_CHECKING:
    from autocolor.screens.viewer import Viewer

EXAMPLES: Final = """\b
Examples:
  autocolor tutorial
  autocolor tutorial --to tcp://127.0.0.1:9300
"""


@click.command(epilog=EXAMPLES)
@click.option(
    "--to",
    "address",
    metavar="tcp://HOST:PORT",
    help="Address of a display elsewhere, or the path of its Unix socket, instead of a window.",
)
@click.option("--full-screen", is_flag=True, help="Open the window in full screen.")
@click.option("--fit", is_flag=True, help="Scale the picture to fill the window; pixels may become uneven.")
@verbose_option
def tutorial(address: str | None, full_screen: bool, fit: bool) -> None:
    """Light and paint a car step by step: a panel says what to do, and notices when you have done it.

    Files are saved in the current folder.
    """
    from pathlib import Path

    from autocolor.commands.demo import demo_session
    from autocolor.commands.view import show

    if address is None:
        show(demo_session(), full_screen, fit, prepare=teach)
        return
    refuse_address(address)
    session_elsewhere(demo_session(), address, Path.cwd(), prepare=teach)


def teach(viewer: Viewer) -> None:
    """Put the panel of the tutorial over the screens of a viewer."""
    from autocolor.screens.tutorial import Tutorial

    viewer.board.over = Tutorial(viewer.session).widgets
    viewer.tell("")
