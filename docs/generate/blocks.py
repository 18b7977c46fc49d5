"""The code blocks of the documents, and the commands in them, for tests and pictures that run them."""

from __future__ import annotations

import re
from typing import NamedTuple


class Block(NamedTuple):
    """A code block of a document; its language may be empty."""

    language: str
    text: str


class Command(NamedTuple):
    """A command of a document, and the output that the document shows below it; None if it shows none."""

    line: str
    output: str | None


def blocks_of(text: str) -> list[Block]:
    """The code blocks of a document."""
    return [Block(*found) for found in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)]


def commands_of(block: Block) -> list[Command]:
    """The commands in a code block. After a line with a prompt, "$ ", its output follows."""
    commands = []
    prompt, *parts = re.split(r"^\$ ", block.text.replace("\\\n", " "), flags=re.MULTILINE)
    lines = [(line, None) for line in prompt.splitlines()]
    for line, output in [*lines, *((part.split("\n", 1)) for part in parts)]:
        for command in line.split(" && "):
            command = re.sub(r"\s+#\s.*", "", command.strip()).removeprefix(".venv/bin/")
            if command.startswith(("autocolor ", "ramtek ")):
                commands.append(Command(command, output))
    return commands
