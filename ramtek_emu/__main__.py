"""The `ramtek` command: the test pattern in a window, or in a picture file."""

from pathlib import Path

import click

from .command_line import run_command, version_option

EXAMPLES = """\b
Examples:
  ramtek                      the test pattern in a window
  ramtek -o pattern.png       the same in a picture file, without a screen
"""


@click.group(
    invoke_without_command=True, epilog=EXAMPLES, context_settings={"help_option_names": ["-h", "--help"]}
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="PNG",
    help="Write the picture, open no window.",
)
@click.option("--force", is_flag=True, help="Overwrite the picture if it exists.")
@click.option("--full-screen", is_flag=True, help="Fill the screen.")
@click.option("--fit", is_flag=True, help="Fill the window, at the cost of uneven pixels.")
@click.option("--debug", is_flag=True, help="Show a traceback when something fails.")
@version_option
@click.pass_context
def ramtek(
    context: click.Context, output: Path | None, force: bool, full_screen: bool, fit: bool, debug: bool
) -> None:
    """A RAMTEK 9300 display.

    Without a command it shows the test pattern. F11 is full screen, F12 saves a screenshot, Ctrl+Q quits.
    """
    if context.invoked_subcommand is not None:
        return
    from .display import Ramtek9300
    from .pattern import pattern

    display = Ramtek9300()
    display.send(pattern())
    if output is not None:
        display.save_png(output, overwrite=force)
        return
    from .window import Monitor

    Monitor(display, "RAMTEK 9300 test pattern", full_screen=full_screen, fit=fit).run()


def main() -> None:
    """Run the command and leave with its exit code."""
    run_command(ramtek, "ramtek")


if __name__ == "__main__":
    main()
