"""Disassembler: lists a stream of words; the listing can be edited and assembled again.

    00000: 0802 8000 000A 01F5            SET STRT=10,501
    00004: 0E01 0004                      WVL 4 bytes
    00006: 0064 01C3                        to 100,451

On the left are the index of the first word in the stream and the words; on the right is their meaning. The
assembler reads only the right side, and returns exactly the words on the left, for any words. `raw` marks
words that cannot be shown as an instruction: illegal words, an instruction that the end of the stream cuts
off, or an instruction with flags that name nothing. All data are listed; `0010*640` is 640 times 0010.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.decoder import Decoder, instruction_of
from ramtek_emu.instruction_set.instruction import NO_WORDS, Instruction, encode
from ramtek_emu.instruction_set.table import FLAG_OF_NAME, ILLEGAL, OPERANDS, Flags

WORDS_PER_LINE: Final = 6
"""The largest number of words on the left of a line."""
RUN_WORDS: Final = 1 << 15
"""The most words of a line on the right."""
IN_HEXADECIMAL: Final = frozenset(("mask", "read_mask", "texture", "scale", "conic"))
NUMBERS: Final = frozenset(("address", "element", "line"))
"""Operands of special instructions that are listed as numbers; all others are listed in hexadecimal."""
SIGNED: Final = frozenset(
    ("index_1", "index_2", "origin", "window", "write_window", "write_offset", "start", "element", "line")
)
VERTICES: Final = frozenset(("WVL", "WVU", "WPT"))
"""Instructions whose data are points."""

ILLEGAL_NOTE: Final = "begins no instruction"


@dataclass(frozen=True, slots=True)
class ListingItem:
    """An instruction of a stream, or words that are no instruction."""

    place: int
    """The index in the stream of the first word."""
    words: Words
    instruction: Instruction | None = None
    note: str = ""
    """Why the words are no instruction."""

    def lines(self) -> Iterator[str]:
        """The lines of the listing: words on the left, their meaning on the right."""
        place = self.place
        if self.instruction is None:
            texts = runs(self.words) if len(self.words) else [(NO_WORDS, "")]
            rest = ((words, f"raw {text} ; {self.note}") for words, text in texts)
        else:
            head = self.words[: len(self.words) - len(self.instruction.data)]
            text = head_text(self.instruction)
            for first in range(0, len(head), WORDS_PER_LINE):
                yield _line(place + first, head[first : first + WORDS_PER_LINE], text)
                text = ""
            place += len(head)
            rest = ((words, f"  {text}") for words, text in data_texts(self.instruction))
        for words, text in rest:
            yield _line(place, words, text)
            place += len(words)

    def to_plain(self) -> dict[str, Any]:
        """The item in plain values, for JSON."""
        item: dict[str, Any] = {"place": self.place}
        if self.instruction is None:
            return item | {"note": self.note}
        format, low_byte = self.instruction.format, self.instruction.low_byte
        item |= {"name": format.name, "meaning": format.meaning}
        item |= {"flags": flag_names(low_byte)} if format.is_normal else {"number": low_byte}
        item["operands"] = {name: list(words) for name, words in self.instruction.operands.items()}
        if self.instruction.length is not None:
            item["bytes"] = self.instruction.length
        return item


def items(pieces: Iterable[bytes], configuration: Configuration = GMR_9300) -> Iterator[ListingItem]:
    """The items of a stream; its bytes, low byte first, may be cut anywhere into pieces.

    A row of illegal words is one item, even if the pieces cut it. An odd byte at the end is only noted.
    """
    decoder = Decoder(configuration)
    place, odd_byte, row = 0, b"", bytearray()
    for piece in pieces:
        data = odd_byte + piece
        odd_byte = data[len(data) & ~1 :]
        for words in decoder.split(np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)):
            item = item_of(place, words, configuration.extended)
            place += len(words)
            if item.note == ILLEGAL_NOTE:
                row += words.tobytes()
                continue
            if row:
                yield raw(item.place, row, ILLEGAL_NOTE)
                row = bytearray()
            yield item
    if row:
        yield raw(place, row, ILLEGAL_NOTE)
    place += decoder.pending_words
    if decoder.pending or odd_byte:
        whole = "a word" if odd_byte else "this instruction"
        yield raw(place, decoder.pending, f"the stream ends within {whole}")


def raw(end: int, data: bytearray, note: str) -> ListingItem:
    """The item of words that end at a place of the stream and are no instruction, from their bytes."""
    return ListingItem(end - len(data) // 2, np.frombuffer(data, np.uint16), None, note)


def item_of(place: int, words: Words, extended: bool) -> ListingItem:
    """The item of a whole instruction, or of a row of illegal words, at a place of the stream."""
    instruction = instruction_of(words, extended)
    if instruction.format is ILLEGAL:
        return ListingItem(place, words, None, ILLEGAL_NOTE)
    if np.array_equal(words, encode(instruction)):
        return ListingItem(place, words, instruction)
    return ListingItem(place, words, None, f"{instruction.format.name} with flags that name nothing")


def flag_names(low_byte: int) -> list[str]:
    """The names of the flags; flags that follow from the operands and the data are left out."""
    addressing = low_byte & Flags.ADDRESSING
    return [
        name
        for name, flag in FLAG_OF_NAME.items()
        if (addressing == flag if flag & Flags.ADDRESSING else low_byte & flag)
    ]


def head_text(instruction: Instruction) -> str:
    """The text of an instruction without its data: name, flags, operands, length."""
    low_byte, parts = instruction.low_byte, [instruction.format.name]
    if instruction.format.is_normal:
        parts += flag_names(low_byte)
    elif low_byte:
        parts.append(f"#{low_byte}")
    for name, words in instruction.operands.items():
        mnemonic = OPERANDS[name].mnemonic if name in OPERANDS else name
        parts.append(f"{mnemonic}={operand_text(name, words)}" if words else mnemonic)
    if instruction.length is not None:
        parts.append(f"{instruction.length} bytes")
    return " ".join(parts)


def operand_text(name: str, words: tuple[int, ...]) -> str:
    """The text of an operand: coordinates as signed numbers, masks and bits in hexadecimal."""
    if name in IN_HEXADECIMAL or (name not in OPERANDS and name not in NUMBERS):
        return ",".join(f"0x{word:04X}" for word in words)
    numbers = [word - 0x10000 if name in SIGNED and word & 0x8000 else word for word in words]
    if name in ("window", "write_window"):
        left, top, right, bottom = numbers
        return f"{left},{top}..{right},{bottom}"
    return ",".join(map(str, numbers))


def data_texts(instruction: Instruction) -> Iterator[tuple[Words, str]]:
    """Yields the data of an instruction by lines: the words and their text."""
    data, name = instruction.data, instruction.format.name
    if name in VERTICES and len(data) % 2 == 0:
        for first in range(0, len(data), WORDS_PER_LINE):
            part = data[first : first + WORDS_PER_LINE]
            points = part.view(np.int16).reshape(-1, 2).tolist()
            yield part, "to " + "  ".join(f"{element},{line}" for element, line in points)
    elif name == "WT" and len(data) and not _has_pad(instruction):
        codes = instruction.data_bytes()
        for first in range(0, len(data), WORDS_PER_LINE):
            text = "".join(map(_character, codes[2 * first : 2 * (first + WORDS_PER_LINE)]))
            yield data[first : first + WORDS_PER_LINE], f'text "{text}"'
    else:
        for words, text in runs(data):
            yield words, f"words {text}"


def runs(data: Words) -> Iterator[tuple[Words, str]]:
    """Yields words in hexadecimal, eight items a line at most; a repeated word is written as 0010*640."""
    for begin in range(0, len(data), RUN_WORDS):
        block = data[begin : begin + RUN_WORDS]
        edges = [0, *(np.flatnonzero(np.diff(block)) + 1).tolist(), len(block)]
        texts: list[str] = []
        start = 0
        for first, end in pairwise(edges):
            word = f"{int(block[first]):04X}"
            texts += [word] * (end - first) if end - first < 3 else [f"{word}*{end - first}"]
            if len(texts) >= 8 or end == len(block):
                yield block[start:end], " ".join(texts)
                start, texts = end, []


def _has_pad(instruction: Instruction) -> bool:
    """Whether the padding byte in the last word is not 0."""
    pad = 0xFF00 if instruction.low_byte & Flags.REVERSE_PACKING else 0x00FF
    return (instruction.length or 0) % 2 == 1 and bool(int(instruction.data[-1]) & pad)


def _character(code: int) -> str:
    character = chr(code)
    if character in '"\\':
        return f"\\{character}"
    return character if 32 <= code < 127 else f"\\x{code:02X}"


def _line(place: int, words: Words, text: str) -> str:
    left = " ".join(f"{word:04X}" for word in words.tolist()) if len(words) <= WORDS_PER_LINE else ""
    return f"{place:05X}: {left:<{5 * WORDS_PER_LINE}} {text}".rstrip()
