"""`autocolor show`: render a scene and show it on a display over TCP."""

from __future__ import annotations

from typing import Final

import click

from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.errors import UsageError

EXAMPLES: Final = """\b
Examples:
  ramtek serve --port 9300 --window                      (on the machine with the screen)
  autocolor show scenes/coupe --to tcp://127.0.0.1:9300
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.option("--to", "address", required=True, metavar="tcp://HOST:PORT", help="Address of the display.")
@click.pass_context
def show(context: click.Context, source: SceneSource, address: str) -> None:
    """Render SCENE and show it on the display that listens at an address, such as `ramtek serve`."""
    from ramtek_emu import PortError
    from ramtek_emu.host.tcp_port import host_and_port

    try:
        host_and_port(address)
    except PortError as error:
        raise UsageError(f"--to: {error}") from None

    from autocolor.studio import Studio
    from ramtek_emu import TcpPort, instructions

    report = read(source)
    with TcpPort(address) as port:
        Studio(report.scene, port)
        # The reply to this read arrives only after everything sent before it was executed.
        port.send(instructions.read_entries(0, 2))
        port.receive(2)
    click.echo(f"shown on {address}", err=True)
    context.exit(ended(report, source))
