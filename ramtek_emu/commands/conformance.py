"""`ramtek conformance`: tests this display, or another emulator on a pipe, with the conformance suite."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Final

import click

EXAMPLES: Final = """\b
Examples:
  ramtek conformance
  ramtek conformance --only BTL
  ramtek conformance -- ramtek serve --stdio --configuration {}
  ramtek conformance --only princeton-9300 -- ./my_emulator
"""


@click.command(epilog=EXAMPLES)
@click.option("--only", multiple=True, metavar="KEY", help="Only claims of KEY; given twice, of both.")
@click.option(
    "--seconds",
    type=click.FloatRange(0, min_open=True),
    default=20.0,
    show_default=True,
    help="How long a process of COMMAND may take.",
)
@click.argument("command", nargs=-1)
@click.pass_context
def conformance(
    context: click.Context, only: tuple[str, ...], seconds: float, command: tuple[str, ...]
) -> None:
    """Run the claims of the conformance suite and print a table; the exit code is 1 if a claim fails.

    Without COMMAND they run on the display of this package. COMMAND is an emulator: for each claim it is
    started, gets the words on stdin, low byte first, and must write its replies to stdout and end. {} in it
    becomes the name of the display. KEY is a subject, a source, sourced, assumed, a display, or part of a
    claim's name.
    """
    from ramtek_emu.conformance.claims import all_claims
    from ramtek_emu.conformance.runner import failure_here, failure_on

    claims = [claim for claim in all_claims() if all(map(claim.is_about, only))]
    if command:
        claims = [claim for claim in claims if not claim.in_process]
    if not claims:
        testable = " that a pipe can test" if command else ""
        raise click.UsageError(
            f"--only must be the key of a claim{testable}, not {' and '.join(only)}; "
            "see the first column of the table"
        )
    run = partial(failure_on, command=command, seconds=seconds) if command else failure_here
    with ThreadPoolExecutor(os.cpu_count() if command else 1) as pool:
        try:
            failures = list(pool.map(run, claims))
        except OSError as cause:
            raise click.UsageError(
                f"COMMAND must be a program, not {command[0]!r} ({cause.strerror}); give its path"
            ) from cause

    click.echo(f"{'subject':<14}{'claims':>7}{'passed':>8}{'failed':>8}")
    for subject in dict.fromkeys(claim.subject for claim in claims):
        rows = [
            (claim, failure)
            for claim, failure in zip(claims, failures, strict=True)
            if claim.subject == subject
        ]
        failed = [row for row in rows if row[1]]
        click.echo(f"{subject:<14}{len(rows):>7}{len(rows) - len(failed):>8}{len(failed):>8}")
        for claim, failure in failed:
            click.echo(f"  {claim.name} ({claim.display}, {claim.source}, {claim.kind})\n    {failure}")
    failed_in_all = sum(map(bool, failures))
    click.echo(f"{'all':<14}{len(claims):>7}{len(claims) - failed_in_all:>8}{failed_in_all:>8}")
    context.exit(1 if failed_in_all else 0)
