"""`ramtek diff`: the first instruction after which two streams have made different displays."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, Final

import click

from ramtek_emu.commands.displays import configuration_option, display_asked_for, read_stream, start_option

EXAMPLES: Final = """\b
Examples:
  ramtek diff yesterday.ramtek today.ramtek
  ramtek diff yesterday.ramtek today.ramtek --json
  ramtek inspect today.ramtek --at 120        the display after the instruction that was found
"""


@click.command(epilog=EXAMPLES)
@click.argument("first", type=click.Path())
@click.argument("second", type=click.Path())
@configuration_option
@start_option
@click.option("--json", "as_json", is_flag=True, help="The answer as JSON; null if there is no difference.")
@click.pass_context
def diff(
    context: click.Context,
    first: str,
    second: str,
    configuration: str | None,
    start: str | None,
    as_json: bool,
) -> None:
    """Find the first instruction after which the streams FIRST and SECOND have made different displays.

    Instructions are paired by their numbers. The exit code is 1 if there is a difference.
    """
    if first == second == "-":
        raise click.UsageError("only one of the streams can be stdin, not both; name a file")
    display = display_asked_for(configuration, start)

    from ramtek_emu.inspection.differences import first_difference, first_different_instruction

    streams = [read_stream(path, display.configuration) for path in (first, second)]
    found = first_difference(streams[0], streams[1], display)
    listed = [
        stream.item(found.number) if found is not None and found.number <= len(stream) else None
        for stream in streams
    ]
    if as_json:
        instructions = [None if item is None else item.to_plain() for item in listed]
        plain = {} if found is None else {"number": found.number, "instructions": instructions} | found.where
        click.echo(json.dumps(plain or None))
    elif found is None:
        number = first_different_instruction(streams[0], streams[1])
        if number > max(map(len, streams)):
            click.echo(f"the streams are the same: {len(streams[0])} instructions")
        else:
            click.echo(f"the displays are alike after every instruction; the streams differ from {number} on")
    else:
        click.echo(f"the displays differ after instruction {found.number}")
        for path, item in zip((first, second), listed, strict=True):
            click.echo(f"  {path}: {'ended before' if item is None else next(item.lines())}")
        for line in lines_of(found.where):
            click.echo(f"  {line}")
    context.exit(0 if found is None else 1)


def lines_of(where: dict[str, Any]) -> Iterator[str]:
    """The differences as text."""
    for name, value in where.items():
        if name == "words":
            left, top, right, bottom = value["window"]
            yield (
                f"words: {value['count']} differ, in {left},{top}..{right},{bottom}; the first at line "
                f"{value['line']}, element {value['element']}: {value['values'][0]} and {value['values'][1]}"
            )
        elif name == "entries":
            yield (
                f"entries: {value['count']} differ; the first is {value['first']}: "
                f"{value['values'][0]} and {value['values'][1]}"
            )
        elif name == "reply":
            first, second = value
            pairs = enumerate(zip(first, second, strict=False))
            alike = next((n for n, (one, other) in pairs if one != other), min(len(first), len(second)))
            yield f"reply: {len(first):,} and {len(second):,} words, which differ from word {alike} on"
        elif isinstance(value, str):
            yield f"{name}: they {value}"
        else:
            yield f"{name}: {json.dumps(value[0])} and {json.dumps(value[1])}"
