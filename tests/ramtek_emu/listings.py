"""Streams as the lines of a listing."""

from __future__ import annotations

from ramtek_emu import GMR_9300, Configuration
from ramtek_emu.instruction_set.disassembler import items


def listing(stream: bytes, configuration: Configuration = GMR_9300) -> list[str]:
    return [line for item in items([stream], configuration) for line in item.lines()]
