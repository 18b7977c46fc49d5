"""`ramtek inspect`: a stream at any of its instructions, and who wrote a pixel."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from ramtek_emu.command_line import report
from ramtek_emu.commands.displays import (
    Run,
    configuration_option,
    display_asked_for,
    read_stream,
    refuse_outputs,
    show,
    start_option,
    table_option,
)
from ramtek_emu.writing import write_atomically

if TYPE_CHECKING:
    from ramtek_emu.inspection.replay import Replay

EXAMPLES: Final = """\b
Examples:
  ramtek inspect drawing.ramtek                            step and scrub in a window
  ramtek inspect drawing.ramtek --at 120 -o drawing.png    the picture after 120 instructions
  ramtek inspect drawing.ramtek --at 120 --snapshot s.png  the display after 120 instructions, to go on with
  ramtek inspect drawing.ramtek --range 80..120 -o part    the words of instructions 80 to 120
  ramtek inspect drawing.ramtek --who 150,200              the instructions that wrote element 150, line 200
"""


def pair(thing: str, sign: str) -> Callable[[str], tuple[int, int]]:
    """A function that converts text to two numbers, at least 0, with a sign between them; BadParameter."""

    def convert(value: str) -> tuple[int, int]:
        first, _, second = value.partition(sign)
        if not (first + second).isdecimal() or not first or not second:
            raise click.BadParameter(f"{thing} must be two numbers with {sign} between them, not {value!r}")
        return int(first), int(second)

    return convert


@click.command(epilog=EXAMPLES)
@click.argument("stream", type=click.Path())
@click.option(
    "--at",
    type=click.IntRange(min=0),
    metavar="N",
    help="The instruction: its line in `ramtek list --json`, or 0 for power-on. The last if not given.",
)
@click.option(
    "-o", "--output", type=click.Path(), metavar="OUT", help="Write the picture, or the words of --range."
)
@click.option(
    "--snapshot", type=click.Path(), metavar="PNG", help="Save the display: words, table, parameters."
)
@click.option(
    "--range",
    "numbers",
    type=pair("a range of instructions", ".."),
    metavar="A..B",
    help="The instructions A to B, for -o.",
)
@click.option(
    "--who",
    type=pair("a pixel", ","),
    metavar="ELEMENT,LINE",
    help="List the instructions that wrote a word of the memory, the newest first.",
)
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="The answer as JSON; without a question: the instruction and the parameters after it.",
)
@click.option("--force", is_flag=True, help="Overwrite what exists.")
@configuration_option
@table_option
@start_option
def inspect(
    stream: str,
    at: int | None,
    output: str | None,
    snapshot: str | None,
    numbers: tuple[int, int] | None,
    who: tuple[int, int] | None,
    as_json: bool,
    force: bool,
    configuration: str | None,
    table: str | None,
    start: str | None,
) -> None:
    """Stop a display at any instruction of STREAM, a file of 16-bit words, low byte first; - is stdin.

    It opens a window, unless a picture, a question or JSON is asked for.
    """
    if numbers is not None:
        refuse_range(numbers, at, output)
    refuse_outputs(force, *([output] if numbers else ()), pictures=[snapshot, None if numbers else output])
    display = display_asked_for(configuration, start, table)

    from ramtek_emu.inspection.replay import Replay

    sizes = display.configuration
    refuse_outside("an element", None if who is None else who[0], sizes.elements - 1)
    refuse_outside("a line", None if who is None else who[1], sizes.lines - 1)
    replay = Replay(read_stream(stream, sizes), display)
    run, last = Run(), len(replay.stream)
    refuse_outside("an instruction", at, last, stream)
    refuse_outside("an instruction", None if numbers is None else numbers[1], last, stream)
    if output is None and snapshot is None and who is None and not as_json:
        from ramtek_emu.inspection.inspector import Inspector
        from ramtek_emu.inspection.session import inspection_of

        replay.go_to(0 if at is None else at)
        caption = f"{os.path.basename(stream)} - RAMTEK {sizes.name.replace('_', ' ')}"
        inspector = Inspector(inspection_of(replay), caption)
        # Before the end, the stream may still load the table.
        show(inspector.monitor, run, inspector.is_busy, lambda: replay.number == last)
        return
    number = last if at is None else at
    if numbers is not None and output is not None:
        words = replay.stream.words_between(numbers[0] - 1, numbers[1])
        write_atomically(Path(output), words.astype("<u2").tobytes(), overwrite=force)
        report(f"wrote {output}")
    elif output is not None:
        replay.go_to(number)
        run.hint(replay.display)
        replay.display.save_png(output, overwrite=force)
        report(f"wrote {output}")
    if snapshot is not None:
        from ramtek_emu.snapshot import write_snapshot

        replay.go_to(number)
        write_snapshot(replay.display, snapshot, overwrite=force)
        report(f"wrote {snapshot}")
    if who is not None:
        answer(replay, who, number, as_json)
    elif as_json:
        from ramtek_emu.inspection.differences import plain_values

        replay.go_to(number)
        instruction = replay.stream.item(number).to_plain() if number else None
        moment = {"number": number, "of": last, "instruction": instruction, "reply": replay.reply.tolist()}
        click.echo(json.dumps(moment | plain_values(replay.display)))


def refuse_range(numbers: tuple[int, int], at: int | None, output: str | None) -> None:
    """Refuse a range that is empty, or that other options do not go with."""
    if output is None:
        raise click.UsageError("a range must have an output; add -o OUT")
    if at is not None:
        raise click.UsageError("a stream must be asked for --at or --range, not both; ask twice")
    first, last = numbers
    if not 1 <= first <= last:
        raise click.UsageError(f"a range must be A..B with 1 <= A <= B, not {first}..{last}; correct it")


def refuse_outside(thing: str, value: int | None, most: int, place: str = "") -> None:
    """Refuse a number beyond the last."""
    if value is not None and value > most:
        where = f" ({place})" if place else ""
        raise click.UsageError(f"{thing} must be 0 to {most}, not {value}{where}; choose a smaller number")


def answer(replay: Replay, pixel: tuple[int, int], until: int, as_json: bool) -> None:
    """Print the instructions that wrote a word of the memory, the newest first."""
    from ramtek_emu.inspection.histories import finished, history_of
    from ramtek_emu.memory.scan_orders import Window

    writes = finished(history_of(replay, Window(*pixel, *pixel), until))[::-1]
    if as_json:
        rows = (
            write._asdict() | {"instruction": replay.stream.item(write.number).to_plain()} for write in writes
        )
        click.echo("[" + ",\n ".join(map(json.dumps, rows)) + "]")
        return
    for write in writes:
        listed = next(replay.stream.item(write.number).lines())
        click.echo(f"{write.number:>8}  {write.before:04X} -> {write.after:04X}  {listed}")
    if not writes:
        report(f"none of the first {until} instructions writes element {pixel[0]}, line {pixel[1]}")
