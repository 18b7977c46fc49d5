"""`autocolor tutorial`: the interactive system step by step, on the built-in demo."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import flag, option, verbose_option
from autocolor.commands.show import refuse_address, session_elsewhere, timeout_option

if TYPE_CHECKING:
    from autocolor.screens.viewer import Viewer

EXAMPLES: Final = """\b
Examples:
  autocolor tutorial
  autocolor tutorial --to tcp://127.0.0.1:9300
"""


@click.command(epilog=EXAMPLES)
@option(
    "--to address",
    "tcp://HOST:PORT",
    "Address of another display, or the path of its Unix socket, to use instead of a window.",
    str,
)
@timeout_option
@flag("--full-screen", "Open the window in full screen.")
@flag("--fit", "Scale the picture to fill the window; pixels may become uneven.")
@verbose_option
def tutorial(address: str | None, timeout: float, full_screen: bool, fit: bool) -> None:
    """Light and paint a car step by step. A panel shows the next step, and goes on when you have done it.

    Files are saved in the current folder.
    """
    from autocolor.commands.demo import demo_session
    from autocolor.commands.view import show_demo

    if address is None:
        show_demo(full_screen, fit, teach)
        return
    refuse_address(address)
    session_elsewhere(demo_session(), address, Path.cwd(), prepare=teach, timeout=timeout)


def teach(viewer: Viewer) -> None:
    """Add the panel of the tutorial to all screens of a viewer."""
    from autocolor.screens.tutorial import Tutorial

    viewer.board.over = Tutorial(viewer.session).widgets
    viewer.tell("")
