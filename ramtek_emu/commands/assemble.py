"""`ramtek assemble`: converts a listing to its stream."""

from __future__ import annotations

import io
import sys
from typing import Final

import click

from ramtek_emu.command_line import report
from ramtek_emu.commands.displays import open_stream, refuse_outputs
from ramtek_emu.writing import write_atomically

EXAMPLES: Final = """\b
Examples:
  ramtek assemble drawing.txt -o drawing.ramtek
  ramtek list drawing.ramtek | ramtek assemble - -o same.ramtek
  echo 'WVL FORE=255 STRT=10,10  ; a line' | ramtek assemble - -o - | ramtek play -
"""


@click.command(epilog=EXAMPLES)
@click.argument("listing", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), metavar="STREAM", required=True, help="The stream; - is stdout."
)
@click.option("--force", is_flag=True, help="Overwrite what exists.")
def assemble(listing: str, output: str, force: bool) -> None:
    """Assemble LISTING, which `ramtek list` printed or you wrote in the same form; - is stdin."""
    if output != "-":
        refuse_outputs(force, output)
    file = io.TextIOWrapper(open_stream(listing), encoding="utf-8-sig", errors="replace")

    from ramtek_emu.instruction_set.assembler import assemble as assembled

    data = b"".join(assembled(file))
    if output == "-":
        sys.stdout.buffer.write(data)
        return
    write_atomically(output, data, overwrite=force)
    report(f"wrote {output}")
