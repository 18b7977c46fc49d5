"""Disassembler: lists a stream of words; the listing can be edited and assembled again.

    00000: 0802 8000 000A 01F5            SET STRT=10,501
    00004: 0E01 0004                      WVL 4 bytes
    00006: 0064 01C3                        to 100,451

On the left are the index of the first word in the stream and the words; on the right is their meaning. The
assembler reads only the right side, and returns exactly the words on the left, for any words. `raw` marks
words that cannot be shown as an instruction: an illegal word, an instruction that the end of the stream cuts
off, or an instruction with flag bits that no source names. All data are listed; `0010*640` is 640 times 0010.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import Instruction, encode
from ramtek_emu.instruction_set.table import (
    ADDRESSING_NAMES,
    FLAG_NAMES,
    ILLEGAL,
    OPERANDS,
    OPERANDS_1,
    OPERANDS_2,
    Flags,
)

WORDS_PER_LINE: Final = 6
"""The largest number of words on the left of a line."""
IN_HEXADECIMAL: Final = frozenset(("mask", "read_mask", "texture", "scale", "conic"))
NUMBERS: Final = frozenset(("address", "element", "line"))
"""Operands of special instructions that are listed as numbers; all others are listed in hexadecimal."""
SIGNED: Final = frozenset(
    ("index_1", "index_2", "origin", "window", "write_window", "write_offset", "start", "element", "line")
)
VERTICES: Final = frozenset(("WVL", "WVU", "WPT"))
"""Instructions whose data are points."""


@dataclass(frozen=True, slots=True)
class ListingItem:
    """An instruction of a stream, or words that are no instruction."""

    place: int
    """The index in the stream of the first word."""
    words: Words
    instruction: Instruction | None = None
    note: str = ""
    """Why the words are no instruction."""
    odd_byte: bytes = b""

    def lines(self) -> Iterator[str]:
        """The lines of the listing: words on the left, their meaning on the right."""
        if self.odd_byte:
            yield _line(self.place, "", f"byte {self.odd_byte[0]:02X} ; {self.note}")
            return
        if self.instruction is None:
            for first in range(0, len(self.words), WORDS_PER_LINE):
                part = _hexadecimal(self.words[first : first + WORDS_PER_LINE])
                yield _line(self.place + first, part, f"raw {part} ; {self.note}")
            return
        head = len(self.words) - len(self.instruction.data)
        text = head_text(self.instruction)
        for first in range(0, head, WORDS_PER_LINE):
            yield _line(
                self.place + first, _hexadecimal(self.words[first : min(head, first + WORDS_PER_LINE)]), text
            )
            text = ""
        place = self.place + head
        for words, text in data_texts(self.instruction):
            yield _line(place, _hexadecimal(words) if len(words) <= WORDS_PER_LINE else "", f"  {text}")
            place += len(words)

    def to_plain(self, with_words: bool = True) -> dict[str, Any]:
        """The item in plain values, for JSON."""
        item: dict[str, Any] = {"place": self.place}
        if with_words:
            item["words"] = self.words.tolist()
        if self.instruction is None:
            item["note"] = self.note
            if self.odd_byte:
                item["byte"] = self.odd_byte[0]
            return item
        format, low_byte = self.instruction.format, self.instruction.low_byte
        item |= {"name": format.name, "meaning": format.meaning}
        item |= {"flags": flag_names(low_byte)} if format.is_normal else {"number": low_byte}
        item["operands"] = {name: list(words) for name, words in self.instruction.operands.items()}
        if self.instruction.length is not None:
            item["bytes"] = self.instruction.length
        return item


def items(pieces: Iterable[bytes], configuration: Configuration = GMR_9300) -> Iterator[ListingItem]:
    """The items of a stream; its bytes, low byte first, may be cut anywhere into pieces."""
    decoder = Decoder(configuration)
    place, odd_byte = 0, b""
    rest: Words = np.zeros(0, np.uint16)
    for piece in pieces:
        data = odd_byte + piece
        odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16)
        rest = np.concatenate((rest, words))
        taken = 0
        for instruction in decoder.feed(words):
            encoded = encode(instruction)
            item = rest[taken : taken + len(encoded)]
            if instruction.format is ILLEGAL:
                yield ListingItem(place, item, None, "begins no instruction")
            elif np.array_equal(item, encoded):
                yield ListingItem(place, item, instruction)
            else:
                yield ListingItem(
                    place, item, None, f"{instruction.format.name} with flag bits that no source names"
                )
            taken += len(encoded)
            place += len(encoded)
        rest = rest[taken:]
    if len(rest):
        yield ListingItem(place, rest, None, "the stream ends within this instruction")
    if odd_byte:
        yield ListingItem(place + len(rest), rest[:0], None, "half a word at the end of the stream", odd_byte)


def flag_names(low_byte: int) -> list[str]:
    """The names of the flags; flags that follow from the operands and the data are left out."""
    names = [name for flag, name in FLAG_NAMES.items() if low_byte & flag]
    addressing = ADDRESSING_NAMES.get(low_byte & Flags.ADDRESSING)
    return names if addressing is None else [*names, addressing]


def head_text(instruction: Instruction) -> str:
    """The text of an instruction without its data: name, flags, operands, length."""
    format = instruction.format
    parts = [format.name]
    if format.is_normal:
        parts += flag_names(instruction.low_byte)
        for flag, name, operands in (
            (Flags.OPERANDS_1, "OF1", OPERANDS_1),
            (Flags.OPERANDS_2, "OF2", OPERANDS_2),
        ):
            if instruction.low_byte & flag and not any(
                operand.name in instruction.operands for operand in operands
            ):
                parts.append(name)
    elif instruction.low_byte:
        parts.append(f"#{instruction.low_byte}")
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
    length = instruction.length or 0
    if name in VERTICES and len(data) % 2 == 0:
        points = data.view(np.int16).reshape(-1, 2)
        for first in range(0, len(points), WORDS_PER_LINE // 2):
            part = points[first : first + WORDS_PER_LINE // 2].tolist()
            text = "to " + "  ".join(f"{element},{line}" for element, line in part)
            yield data[2 * first : 2 * first + WORDS_PER_LINE], text
    elif name == "WT" and len(data) and not _has_pad(instruction, length):
        codes = instruction.data_bytes()
        for first in range(0, len(data), WORDS_PER_LINE):
            part = codes[2 * first : 2 * (first + WORDS_PER_LINE)]
            yield data[first : first + WORDS_PER_LINE], f'text "{"".join(map(_character, part))}"'
    else:
        yield from _runs(data)


def _has_pad(instruction: Instruction, length: int) -> bool:
    """Whether the padding byte in the last word is not 0."""
    if length % 2 == 0:
        return False
    low = instruction.low_byte & Flags.REVERSE_PACKING
    return bool(int(instruction.data[-1]) & (0xFF00 if low else 0x00FF))


def _runs(data: Words) -> Iterator[tuple[Words, str]]:
    """Yields words in hexadecimal, eight items a line at most; a repeated word is written as 0010*640."""
    edges = np.flatnonzero(np.diff(data)) + 1
    starts = [0, *edges.tolist(), len(data)] if len(data) else [0]
    texts: list[str] = []
    begin = 0
    for first, end in pairwise(starts):
        word = f"{int(data[first]):04X}"
        texts += [word] * (end - first) if end - first < 3 else [f"{word}*{end - first}"]
        if len(texts) >= 8:
            yield data[begin:end], "words " + " ".join(texts)
            begin, texts = end, []
    if texts:
        yield data[begin:], "words " + " ".join(texts)


def _character(code: int) -> str:
    character = chr(code)
    if character in '"\\':
        return f"\\{character}"
    return character if 32 <= code < 127 else f"\\x{code:02X}"


def _hexadecimal(words: Words) -> str:
    return " ".join(f"{word:04X}" for word in words.tolist())


def _line(place: int, words: str, text: str) -> str:
    return f"{place:05X}: {words:<{5 * WORDS_PER_LINE}} {text}".rstrip()
