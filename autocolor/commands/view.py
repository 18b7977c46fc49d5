"""`autocolor view`: show a scene in an interactive window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.scenes import ended, read, scene_options

if TYPE_CHECKING:
    from autocolor.scene.creation import SurfaceSource
    from autocolor.scene.scene import Scene
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import Ramtek9300
    from ramtek_emu.monitor.window import Monitor

EXAMPLES: Final = """\b
Examples:
  autocolor view scenes/coupe
  autocolor view car.obj --up y --full-screen
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--full-screen", is_flag=True, help="Open the window in full screen.")
@click.option("--fit", is_flag=True, help="Scale the picture to fill the window; pixels may become uneven.")
@click.pass_context
def view(
    context: click.Context,
    scene: str,
    up: str,
    surfaces: SurfaceSource,
    strict: bool,
    full_screen: bool,
    fit: bool,
) -> None:
    """Show SCENE in an interactive window; press F1 there for a list of keys."""
    report = read(scene, up, surfaces)
    show(report.scene, full_screen, fit)
    context.exit(ended(report, strict))


def show_demo() -> None:
    """Show the built-in demo in a window."""
    from autocolor.commands.demo import demo_folder
    from autocolor.files.scene_sources import read_scene

    show(read_scene(demo_folder()))


def show(scene: Scene, full_screen: bool = False, fit: bool = False) -> None:
    """Show a scene in a window until that is closed. Raises UnavailableError if there is no screen."""
    from autocolor.errors import UnavailableError
    from autocolor.screens.viewer import Viewer
    from ramtek_emu import NoScreenError, Ramtek9300
    from ramtek_emu.monitor.window import open_screen

    try:
        # Fail before rendering if there is no screen.
        open_screen()
        display = Ramtek9300()
        monitor_of(Viewer(scene, display), display, full_screen, fit).run()
    except NoScreenError as error:
        raise UnavailableError(f"{error}; `autocolor render SCENE -o PNG` renders without a screen") from None


def monitor_of(viewer: Viewer, display: Ramtek9300, full_screen: bool = False, fit: bool = False) -> Monitor:
    """A window, not yet open, that shows the display of a viewer and hands keys and the mouse to it."""
    from ramtek_emu.monitor.window import Key, Monitor, Pointer

    def on_key(key: Key) -> bool:
        return viewer.on_key(key.name, key.control, key.shift, key.text, key.repeated)

    def on_pointer(pointer: Pointer) -> None:
        viewer.on_pointer(pointer.element, pointer.line, pointer.action, pointer.button, pointer.steps)

    def on_tick() -> None:
        viewer.on_tick(monitor.is_at_rest, monitor.full_screen)
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
        on_drop=viewer.on_drop,
        on_tick=on_tick,
        on_close=viewer.on_close,
        on_message=viewer.tell,
    )
    return monitor
