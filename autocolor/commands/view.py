"""`autocolor view`: the interactive system in the window of an emulated display."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.scenes import ended, read, scene_options

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

EXAMPLES: Final = """\b
Examples:
  autocolor view scenes/coupe
  autocolor view car.obj --up y --full-screen
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--full-screen", is_flag=True, help="Fill the screen.")
@click.option("--fit", is_flag=True, help="Fill the window, at the cost of uneven pixels.")
@click.pass_context
def view(context: click.Context, scene: str, up: str, strict: bool, full_screen: bool, fit: bool) -> None:
    """Show SCENE in the window; F1 there lists the keys."""
    report = read(scene, up)
    show(report.scene, full_screen, fit)
    context.exit(ended(report, strict))


def show_demo() -> None:
    """Show the built-in demo in the window."""
    from autocolor.commands.demo import demo_folder
    from autocolor.files.scene_sources import read_scene

    show(read_scene(demo_folder()))


def show(scene: Scene, full_screen: bool = False, fit: bool = False) -> None:
    """Hold a window open on a scene; UnavailableError where there is no screen."""
    from autocolor.errors import UnavailableError
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import NoScreenError, Ramtek9300
    from ramtek_emu.monitor.window import Key, Monitor, open_screen

    try:
        # Say so before anything is rendered.
        open_screen()
        display = Ramtek9300()
        viewer = Viewer(scene, display)
        monitor = Monitor(
            display, viewer.caption, full_screen=full_screen, fit=fit, screenshot_name="autocolor"
        )

        def tell(message: str) -> None:
            viewer.message = message
            monitor.caption = viewer.caption

        def on_key(key: Key) -> bool:
            taken = viewer.on_key(key.name, key.control, key.shift, key.text, key.repeated)
            monitor.caption = viewer.caption
            return taken

        def on_close() -> bool:
            may_close = viewer.on_close()
            monitor.caption = viewer.caption
            return may_close

        def on_drop(path: Path) -> None:
            viewer.on_drop(path)
            monitor.caption = viewer.caption

        monitor.on_key, monitor.on_close, monitor.on_drop, monitor.on_message = (
            on_key,
            on_close,
            on_drop,
            tell,
        )
        monitor.run()
    except NoScreenError as error:
        raise UnavailableError(
            f"{error}; `autocolor render SCENE -o PNG` makes the picture without a screen"
        ) from None
