"""Assembler: converts a listing, or a program that you wrote in the same form, to words.

A line is an instruction: name, flags, operands by name or mnemonic, and the length of the data.

    SET FORE=1 BK
    ERS BACK=2 WIN=100,331..200,411       ; a filled box
    WVL STRT=10,501                       ; a comment follows a semicolon
      to 100,451  200,300                 ; points; `text "HELLO"` for characters, `words 0010*640` for others

Numbers are decimal or, after 0x, hexadecimal. `raw` and `words` take hexadecimal words, `byte` takes the odd
byte at the end of a stream. If the length is left out, the data are counted. The words on the left of a
listing are ignored.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.errors import InstructionError, ListingError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, NO_WORDS, Instruction, encode, flag_words_of
from ramtek_emu.instruction_set.table import (
    FLAG_OF_NAME,
    FORMAT_OF_NAME,
    FORMATS,
    OPERANDS,
    Flags,
)

FORMAT_OF_WORD: Final = {"WV": FORMAT_OF_NAME["WVL"]} | {format.name.upper(): format for format in FORMATS}
OPERAND_OF_WORD: Final = {
    word.upper(): operand.name for operand in OPERANDS.values() for word in (operand.name, operand.mnemonic)
}
UTF_16: Final = ("\xff\xfe", "\xfe\xff", "\ufffe")
"""Marks of UTF-16, decoded as Latin-1 or in the wrong order."""


def assemble(lines: Iterable[str]) -> Iterator[bytes]:
    """Yields the bytes of the stream, low byte first, by instructions; ListingError names the wrong line."""
    draft: Draft | None = None
    ended = 0
    for number, line in enumerate(lines, 1):
        with at_line(number):
            if number == 1 and line.startswith(UTF_16):
                raise InstructionError("a listing must be text in UTF-8, not in UTF-16; save it as UTF-8")
            # A UTF-8 mark, decoded as UTF-8 or, as the texts of a listing are, as Latin-1.
            marks = r"\A(\ufeff|\xef\xbb\xbf)" if number == 1 else r"\A"
            tokens = tokens_of(re.sub(marks, "", line))
            if not tokens:
                continue
            kind = tokens[0].lower()
            if ended:
                raise InstructionError(
                    f"the byte of line {ended} must be the last of the stream; delete one of them"
                )
            if kind in ("to", "text", "words"):
                if draft is None or not draft.format.sends_data:
                    raise InstructionError(
                        f"data must follow an instruction that takes them, not {kind!r}; put one before it"
                    )
                draft.add(kind, tokens[1:])
                continue
        if draft is not None:
            yield draft.stream()
            draft = None
        with at_line(number):
            if kind == "raw":
                part = hexadecimal_words(tokens[1:]).astype("<u2").tobytes()
            elif kind == "byte":
                (value,) = hexadecimal_words(tokens[1:2]).tolist() or (0x100,)
                if value > 0xFF or len(tokens) != 2:
                    raise InstructionError(
                        f"a byte must be 00 to FF, not {' '.join(tokens[1:])!r:.60}; write one"
                    )
                ended, part = number, bytes((value,))
            else:
                draft = Draft(number, tokens)
                continue
        yield part
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
        self.bytes = 0
        self.data: list[Words] = []
        rest = iter(tokens[1:])
        for token in rest:
            if token.isascii() and token.isdigit():
                if next(rest, "").lower() != "bytes" or int(token[:6]) > MOST_BYTES:
                    raise InstructionError(
                        f"a length must be 0 to {MOST_BYTES} and stand before the word bytes, "
                        f"not {token!r:.60}; write it so"
                    )
                self.length = int(token)
            else:
                self._take(token)

    def _take(self, token: str) -> None:
        """Add a flag, a number or an operand."""
        name, equals, value = token.partition("=")
        flag, operand = FLAG_OF_NAME.get(name.upper(), 0), OPERAND_OF_WORD.get(name.upper())
        if self.format.fixed is not None:
            flag, operand = 0, name if name in self.format.fixed and name != "length" else None
        if flag and not equals:
            self.low_byte |= flag
        elif operand:
            words = numbers_of(value) if value else ()
            allowed: tuple[int, ...] = (OPERANDS[operand].words,) if operand in OPERANDS else (1,)
            if operand == "conic" and self.format.name == "WC":
                allowed = (6, 12)
            if self.format.requests_operands:
                allowed = (0,)
            if len(words) not in allowed:
                raise InstructionError(
                    f"{name} must be {' or '.join(map(str, allowed))} numbers, not {value!r:.60}; give all"
                )
            self.operands[operand] = words
        elif self.format.fixed is not None and re.fullmatch(
            r"#0*(1?\d?\d|2[0-4]\d|25[0-5])", token, re.ASCII
        ):
            self.low_byte = int(token[1:])
        else:
            raise InstructionError(
                f"what follows {self.format.name} must be a flag, an operand or a length, not {token!r:.60}; "
                "see `ramtek list`"
            )

    def add(self, kind: str, tokens: list[str]) -> None:
        """Add a line of data."""
        if kind == "text":
            if self.bytes % 2:
                raise InstructionError(
                    "text must follow an even number of bytes; join it with the line before"
                )
            codes = b"".join(map(string_of, tokens))
            self.bytes += len(codes)
            order = "<u2" if self.low_byte & Flags.REVERSE_PACKING else ">u2"
            words = np.frombuffer(codes + bytes(len(codes) % 2), order).astype(np.uint16)
        else:
            words = hexadecimal_words(tokens) if kind == "words" else points_of(tokens)
            self.bytes += 2 * len(words)
        self.data.append(words)
        if self.bytes > MOST_BYTES + 1:
            raise InstructionError(
                f"the data must be at most {MOST_BYTES} bytes, not {self.bytes}; write two instructions"
            )

    def stream(self) -> bytes:
        """The bytes of the whole instruction."""
        fixed = self.format.fixed or ()
        data = np.concatenate(self.data) if self.data else NO_WORDS
        length = self.length
        if length is None and (len(data) or "length" in fixed):
            length = self.bytes
        missing = ", ".join(name for name in fixed if name not in self.operands and name != "length")
        with at_line(self.number):
            if len(data) != (0 if self.format.replies else ((length or 0) + 1) // 2):
                raise InstructionError(
                    f"{self.format.name} must have data of {length or 0} bytes, not of {2 * len(data)}; "
                    "leave the length out to have it counted"
                )
            if missing:
                raise InstructionError(f"{self.format.name} must have all its operands; add {missing}")
        low_byte = self.low_byte
        if self.format.is_normal:
            first, second = flag_words_of(self.operands)
            low_byte |= Flags.DATA if length is not None else 0
            low_byte |= (Flags.OPERANDS_1 if first else 0) | (Flags.OPERANDS_2 if second else 0)
        words = encode(Instruction(self.format, low_byte, self.operands, length, data))
        return words.astype("<u2", copy=False).tobytes()


LEFT: Final = re.compile(r"\s*[0-9A-Fa-f]{4,}:(?: [0-9A-Fa-f]{4})*(?=\s|$)")
TOKEN: Final = re.compile(r'\s+|;.*|"(?:[^"\\]|\\.)*"|[^\s";]+')
NUMBER: Final = re.compile(r"-?[0-9]{1,6}|0[xX][0-9A-Fa-f]{1,4}")
HEXADECIMAL: Final = re.compile(r"(?P<word>[0-9A-Fa-f]{1,4})(?:\*(?P<times>[0-9]{1,5}))?")
ESCAPE: Final = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)")
MOST_WORDS: Final = 0x8000
"""The most words in a line: the data of an instruction have no more."""


def tokens_of(line: str) -> list[str]:
    """The tokens of a line, without the words on the left and the comment."""
    left = LEFT.match(line)
    text = line[left.end() if left else 0 :].strip()
    tokens, place = [], 0
    while place < len(text):
        token = TOKEN.match(text, place)
        if token is None:
            raise InstructionError(
                f"a string must end with a quotation mark, not as {text[place:]!r:.60}; add it"
            )
        place = token.end()
        if not token[0].isspace() and not token[0].startswith(";"):
            tokens.append(token[0])
    return tokens


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
    if sum(times) > MOST_WORDS:
        raise InstructionError(f"a line must be at most {MOST_WORDS} words, not {sum(times)}; break it")
    return np.repeat(np.array(values, np.uint16), times)


def string_of(token: str) -> bytes:
    r"""The bytes of a string in quotation marks; the escapes are `\"`, `\\` and, for any byte, `\x1B`."""
    text = ESCAPE.sub(lambda escape: chr(int(escape[1], 16)) if escape[1] else escape[2], token[1:-1])
    if len(token) < 2 or token[0] != '"' or not all(ord(character) < 256 for character in text):
        raise InstructionError(
            f"text must be in quotation marks, its codes 0 to 255, not {token!r:.60}; write it so"
        )
    return text.encode("latin-1")
