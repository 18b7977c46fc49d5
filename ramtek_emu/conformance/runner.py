"""Runs claims on the display of this package, or on a command that serves a display on a pipe.

A function returns the failure as text, or "" if the claim holds.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.configuration import checked_configuration
from ramtek_emu.conformance.claims import JOYSTICK, Claim, text_of, words_of
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import ListingError
from ramtek_emu.host.joystick import actions
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items


def failure_here(claim: Claim) -> str:
    """The failure of a claim on the display of this package."""
    display = Ramtek9300(claim.display)
    for write in claim.streams:
        if write.startswith(JOYSTICK):
            for action in actions(write.removeprefix(JOYSTICK), display.joystick, display.reset):
                action()
        else:
            display.send(words_of(write))
        if "field" in claim.in_process:
            # A field is made of the last one and of what changed.
            display.field()
    failure = difference(claim, display.receive(display.processor.waiting))
    failure = failure or failure_of_the_display(claim, display) or failure_of_the_text(claim)
    if failure or any(write.startswith(JOYSTICK) for write in claim.writes):
        return failure
    for how, pieces in cuts(claim):
        display = Ramtek9300(claim.display)
        for piece in pieces:
            display.send(piece)
        failure = difference(claim, display.receive(display.processor.waiting))
        if failure:
            return f"{how}: {failure}"
    return ""


def cuts(claim: Claim) -> Iterator[tuple[str, Sequence[Words]]]:
    """The stream of a claim in pieces: all words alone, and if the claim asks for it, every cut in two."""
    words = claim.words
    yield "a word at a time", np.split(words, len(words))
    if claim.cut == "every":
        for place in range(1, len(words)):
            yield f"cut before word {place}", np.split(words, [place])


def failure_of_the_display(claim: Claim, display: Ramtek9300) -> str:
    """The failure of what is seen at the display: the status register, and colors of the field."""
    status = claim.in_process.get("status")
    if status is not None and status != (given := str(display.status.name)):
        return f"the status is {given}, not {status}"
    for place, colors in claim.in_process.get("field", {}).items():
        element, line = map(int, place.split(","))
        row = display.field()[line, element : element + len(colors.split())]
        given = " ".join(bytes(color).hex().upper() for color in row)
        if given != colors:
            return f"the colors from {place} on are {given}, not {colors}"
    return ""


def failure_of_the_text(claim: Claim) -> str:
    """The failure of the writes as text: of their listing, or of a program that assembles to them."""
    listing, program = claim.in_process.get("listing"), claim.in_process.get("program")
    if listing is program is None:
        return ""
    words = words_of(" ".join(claim.writes))
    listed = items([words.astype("<u2").tobytes()], checked_configuration(claim.display))
    given = [line for item in listed for line in item.lines()]
    if listing is not None and given != listing:
        return f"the listing is {given}, not {listing}"
    for lines in filter(None, (listing, program)):
        assembled = np.frombuffer(b"".join(assemble(lines)), "<u2")
        if not np.array_equal(assembled, words):
            return f"the text assembles to {text_of(assembled)}"
    for wrong in claim.in_process.get("refused", ()):
        with suppress(ListingError):
            list(assemble(wrong.split("|")))
            return f"the text {wrong!r} is not refused"
    return ""


def failure_on(claim: Claim, command: Sequence[str], seconds: float) -> str:
    """The failure of a claim on a command, which gets the words on stdin and replies on stdout.

    `{}` in the command is the name of the display. A process that has not ended after `seconds` is killed.
    OSError if the command cannot be started.
    """
    try:
        done = subprocess.run(
            [part.replace("{}", claim.display) for part in command],
            input=claim.words.astype("<u2").tobytes(),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"the emulator did not end in {seconds:g} s"
    return difference(claim, np.frombuffer(done.stdout, "<u2", len(done.stdout) // 2))


def difference(claim: Claim, given: Words) -> str:
    """The first difference of the replies from the claim's."""
    expected = words_of(claim.replies)
    if np.array_equal(expected, given):
        return ""
    alike = np.flatnonzero(expected[: len(given)] != given[: len(expected)])
    place = int(alike[0]) if len(alike) else min(len(expected), len(given))
    texts = [text_of(words[place:]) or "nothing" for words in (expected, given)]
    return f"from reply word {place} on, expected {texts[0]:.160}, given {texts[1]:.160}"
