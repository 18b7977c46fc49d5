"""Assembler: converts a listing, or a program that you wrote in the same form, to words.

A line is an instruction: name, flags, operands by name or mnemonic, and the length of the data.

    SET FORE=1 BK
    ERS BACK=2 WIN=100,331..200,411       ; a filled box
    WVL STRT=10,501                       ; a comment follows a semicolon
      to 100,451  200,300                 ; points; `text "HELLO"` for characters, `words 0010*640` for others

Numbers are decimal or, after 0x, hexadecimal. `raw` and `words` take hexadecimal words. If the length is left
out, the data are counted. The words on the left of a listing are ignored.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.errors import InstructionError, ListingError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, Instruction, encode
from ramtek_emu.instruction_set.table import FLAG_OF_NAME, FORMAT_OF_NAME, FORMATS, OPERANDS, Flags

FORMAT_OF_WORD: Final = {"WV": FORMAT_OF_NAME["WVL"]} | {format.name.upper(): format for format in FORMATS}
OPERAND_OF_WORD: Final = {
    word.upper(): operand.name for operand in OPERANDS.values() for word in (operand.name, operand.mnemonic)
}


def assemble(lines: Iterable[str]) -> Iterator[bytes]:
    """Yields the bytes of the stream, low byte first, by instructions; ListingError names the wrong line."""
    draft: Draft | None = None
    for number, line in enumerate(lines, 1):
        with at_line(number):
            tokens = tokens_of(line)
            kind = tokens[0].lower() if tokens else ""
            if kind in ("to", "text", "words"):
                if draft is None or not draft.format.sends_data:
                    raise InstructionError(
                        f"data must follow an instruction that takes them, not {kind!r}; put one before it"
                    )
                draft.add(kind, tokens[1:])
            elif kind:
                if draft is not None:
                    yield draft.stream()
                    draft = None
                if kind == "raw":
                    yield hexadecimal_words(tokens[1:]).astype("<u2").tobytes()
                else:
                    draft = Draft(number, tokens)
    if draft is not None:
        yield draft.stream()


@contextmanager
def at_line(number: int) -> Iterator[None]:
    """Turn an InstructionError into a ListingError that names the line."""
    try:
        yield
    except InstructionError as cause:
        raise ListingError(f"line {number}: {cause}") from cause


class Draft:
    """An instruction to which lines of data can be added."""

    def __init__(self, number: int, tokens: list[str]) -> None:
        self.number = number
        if tokens[0].upper() not in FORMAT_OF_WORD:
            raise InstructionError(
                f"an instruction must be one of the table, not {tokens[0]!r:.60}; write its words after raw"
            )
        self.format = FORMAT_OF_WORD[tokens[0].upper()]
        self.low_byte = 0
        self.operands: dict[str, tuple[int, ...]] = {}
        self.length: int | None = None
        self.data = bytearray()
        for token in tokens[1:]:
            self._take(token)

    @property
    def order(self) -> str:
        """The type of data words whose bytes are in the order of the text."""
        return "<u2" if self.low_byte & Flags.REVERSE_PACKING else ">u2"

    def _take(self, token: str) -> None:
        """Add a length, a flag, a number or an operand."""
        name, equals, value = token.partition("=")
        flag, operand = FLAG_OF_NAME.get(name.upper(), 0), OPERAND_OF_WORD.get(name.upper())
        is_normal = self.format.is_normal
        if not is_normal:
            operand = name if name in (self.format.fixed or ()) and name != "length" else None
        if length := LENGTH.fullmatch(token):
            (self.length,) = numbers_of(length[1])
        elif is_normal and flag and not equals:
            self.low_byte |= flag
        elif operand:
            words = numbers_of(value) if value else ()
            counts: tuple[int, ...] = (OPERANDS[operand].words,) if is_normal else (1,)
            if self.format.requests_operands:
                counts = (0,)
            elif operand == "conic" and self.format.name == "WC":
                counts = (6, 12)
            if len(words) not in counts:
                raise InstructionError(
                    f"{name} must be {' or '.join(map(str, counts))} numbers, not {value!r:.60}; give all"
                )
            self.operands[operand] = words
        elif not is_normal and (number := DEVICE.fullmatch(token)) and int(number[1]) <= 0xFF:
            self.low_byte = int(number[1])
        else:
            raise InstructionError(
                f"what follows {self.format.name} must be a flag, an operand or a length, not {token!r:.60}; "
                "see `ramtek list`"
            )

    def add(self, kind: str, tokens: list[str]) -> None:
        """Add a line of data."""
        if kind == "text":
            self.data += b"".join(map(string_of, tokens))
        else:
            words = hexadecimal_words(tokens) if kind == "words" else points_of(tokens)
            self.data += words.astype(self.order).tobytes()

    def stream(self) -> bytes:
        """The bytes of the whole instruction."""
        fixed = self.format.fixed or ()
        length = self.length
        if length is None and (self.data or "length" in fixed):
            length = len(self.data)
        size = (length or 0) + 1 & ~1
        missing = ", ".join(name for name in fixed if name not in (*self.operands, "length"))
        with at_line(self.number):
            if (length or 0) > MOST_BYTES:
                raise InstructionError(
                    f"the data must be at most {MOST_BYTES} bytes, not {length}; write two instructions"
                )
            if len(self.data) + len(self.data) % 2 != (0 if self.format.replies else size):
                raise InstructionError(
                    f"{self.format.name} must have data of {length or 0} bytes, not of {len(self.data)}; "
                    "leave the length out to have it counted"
                )
            if missing:
                raise InstructionError(f"{self.format.name} must have all its operands; add {missing}")
        data = np.frombuffer(self.data + bytes(len(self.data) % 2), self.order).astype(np.uint16)
        words = encode(Instruction(self.format, self.low_byte, self.operands, length, data))
        return words.astype("<u2", copy=False).tobytes()


LEFT: Final = re.compile(r"\s*[0-9A-Fa-f]{4,}:(?: [0-9A-Fa-f]{4})*(?=\s|$)")
STRING: Final = re.compile(r'"((?:[^"\\]|\\.)*)"')
LENGTH: Final = re.compile(r"([0-9]{1,6})\s+bytes", re.IGNORECASE)
DEVICE: Final = re.compile(r"#([0-9]{1,3})")
TOKEN: Final = re.compile(rf';.*|{STRING.pattern}|{LENGTH.pattern}\b|"|[^\s";]+', re.IGNORECASE)
NUMBER: Final = re.compile(r"-?[0-9]{1,6}|0[xX][0-9A-Fa-f]{1,4}")
HEXADECIMAL: Final = re.compile(r"(?P<word>[0-9A-Fa-f]{1,4})(?:\*(?P<times>[0-9]{1,5}))?")
ESCAPE: Final = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)")


def tokens_of(line: str) -> list[str]:
    """The tokens of a line, without the words on the left and the comment."""
    if "\0" in line:
        raise InstructionError("a listing must be text in UTF-8, not in UTF-16; save it as UTF-8")
    left = LEFT.match(line)
    tokens = [token[0] for token in TOKEN.finditer(line, left.end() if left else 0)]
    return [token for token in tokens if not token.startswith(";")]


def numbers_of(text: str) -> tuple[int, ...]:
    """Numbers separated by commas, or the two points of a window, as 16-bit words."""
    words = []
    for part in text.replace("..", ",").split(","):
        value = int(part, 16 if "x" in part.lower() else 10) if NUMBER.fullmatch(part) else 0x10000
        if not -0x8000 <= value <= 0xFFFF:
            raise InstructionError(
                f"a number must be -32768 to 65535, decimal or after 0x, not {part!r:.60}; write it so"
            )
        words.append(value & 0xFFFF)
    return tuple(words)


def points_of(tokens: list[str]) -> Words:
    """The words of points such as 100,451."""
    points = [numbers_of(token) for token in tokens]
    if any(len(point) != 2 for point in points):
        raise InstructionError(f"a point must be element,line, not {' '.join(tokens)!r:.60}; write it so")
    return np.array(points, np.uint16).reshape(-1)


def hexadecimal_words(tokens: list[str]) -> Words:
    """The words of tokens such as 0010, or 0010*640 for a word that repeats 640 times."""
    values, times = [], []
    for token in tokens:
        parts = HEXADECIMAL.fullmatch(token)
        if parts is None:
            raise InstructionError(
                f"a word must be 0000 to FFFF, or one with *times, not {token!r:.60}; mend it"
            )
        values.append(int(parts["word"], 16))
        times.append(int(parts["times"] or 1))
    return np.repeat(np.array(values, np.uint16), times)


def string_of(token: str) -> bytes:
    r"""The bytes of a string in quotation marks; the escapes are `\"`, `\\` and, for any byte, `\x1B`."""
    string = STRING.fullmatch(token)
    text = ESCAPE.sub(lambda part: chr(int(part[1], 16)) if part[1] else part[2], string[1] if string else "")
    if string is None or not all(ord(character) < 256 for character in text):
        raise InstructionError(
            f"text must be in quotation marks, its codes 0 to 255, not {token!r:.60}; write it so"
        )
    return text.encode("latin-1")
