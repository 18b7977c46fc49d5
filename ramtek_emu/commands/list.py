"""`ramtek list`: a stream as instructions with named operands."""

from __future__ import annotations

import json
from typing import Final

import click

from ramtek_emu.commands.displays import configuration_option, open_stream
from ramtek_emu.configuration import GMR_9300, checked_configuration

EXAMPLES: Final = """\b
Examples:
  ramtek list drawing.ramtek
  ramtek list drawing.ramtek --json | jq '.[].name'
  ramtek list drawing.ramtek > drawing.txt; ramtek assemble drawing.txt -o again.ramtek
"""

PIECE: Final = 1 << 18


@click.command(name="list", epilog=EXAMPLES)
@click.argument("stream", type=click.Path())
@configuration_option
@click.option(
    "--json", "as_json", is_flag=True, help="One object for each instruction, with its words in hexadecimal."
)
def list_command(stream: str, configuration: str | None, as_json: bool) -> None:
    """List STREAM, a file of 16-bit words with the low byte first, as instructions; - is stdin.

    `ramtek assemble` turns the listing into the same stream again, word for word.
    """
    chosen = GMR_9300 if configuration is None else checked_configuration(configuration)
    file = open_stream(stream)

    from ramtek_emu.instruction_set.disassembler import items

    listed = items(iter(lambda: file.read(PIECE), b""), chosen)
    if not as_json:
        for item in listed:
            click.echo("\n".join(item.lines()))
        return
    separator = "["
    for item in listed:
        # A row of illegal words may be as long as the file.
        click.echo(f'{separator}{json.dumps(item.to_plain())[:-1]}, "words": "', nl=False)
        for first in range(0, len(item.words), PIECE):
            words = item.words[first : first + PIECE].astype(">u2").tobytes().hex(" ", 2).upper()
            click.echo((" " if first else "") + words, nl=False)
        click.echo('"}', nl=False)
        separator = ",\n "
    click.echo("[]" if separator == "[" else "]")
