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
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.errors import InstructionError, ListingError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, NO_WORDS, Instruction, encode
from ramtek_emu.instruction_set.table import (
    ADDRESSING_NAMES,
    FLAG_NAMES,
    FORMAT_OF_NAME,
    FORMATS,
    OPERANDS,
    OPERANDS_1,
    OPERANDS_2,
    Flags,
    InstructionFormat,
)

FLAG_OF_NAME: Final = {name: flag for flag, name in (FLAG_NAMES | ADDRESSING_NAMES).items()} | {
    "OF1": Flags.OPERANDS_1,
    "OF2": Flags.OPERANDS_2,
}
FORMAT_OF_WORD: Final = {"WV": FORMAT_OF_NAME["WVL"]} | {format.name.upper(): format for format in FORMATS}
OPERAND_OF_WORD: Final = {
    word.upper(): operand for operand in OPERANDS.values() for word in (operand.name, operand.mnemonic)
}


def assemble(lines: Iterable[str]) -> Iterator[bytes]:
    """Yields the bytes of the stream, low byte first, by instructions; ListingError names the wrong line."""
    pending: Draft | None = None
    ended = 0
    for number, line in enumerate(lines, 1):
        if number == 1:
            # A UTF-8 mark, decoded as UTF-8 or, as the texts of a listing are, as Latin-1.
            line = line.removeprefix("\ufeff").removeprefix("\xef\xbb\xbf")
        tokens = tokens_of(line, number)
        if not tokens:
            continue
        if ended:
            raise refusal(
                number, f"the byte of line {ended} must be the last of the stream; delete one of them"
            )
        word = tokens[0].lower()
        if word in ("to", "text", "words"):
            if pending is None or not pending.takes_data:
                raise refusal(
                    number,
                    f"data must follow an instruction that takes them, not {word!r}; put one before it",
                )
            pending.add(word, tokens[1:], number)
            continue
        if pending is not None:
            yield pending.stream()
            pending = None
        if word == "raw":
            yield hexadecimal_words(tokens[1:], number).astype("<u2").tobytes()
        elif word == "byte":
            (value,) = hexadecimal_words(tokens[1:2], number).tolist() or (0x100,)
            if value > 0xFF or len(tokens) != 2:
                raise refusal(number, f"a byte must be 00 to FF, not {' '.join(tokens[1:])!r}; write one")
            ended = number
            yield bytes((value,))
        else:
            pending = Draft(tokens, number)
    if pending is not None:
        yield pending.stream()


class Draft:
    """An instruction to which lines of data can be added."""

    def __init__(self, tokens: list[str], number: int) -> None:
        self.number = number
        name = tokens[0].upper()
        if name not in FORMAT_OF_WORD:
            raise refusal(
                number,
                f"an instruction must be one of the table, not {tokens[0]!r}; write its words after raw",
            )
        self.format: InstructionFormat = FORMAT_OF_WORD[name]
        self.low_byte = 0
        self.operands: dict[str, tuple[int, ...]] = {}
        self.length: int | None = None
        self.bytes = 0
        self.data: list[Words] = []
        rest = iter(tokens[1:])
        for token in rest:
            if token.isascii() and token.isdigit():
                if next(rest, "").lower() != "bytes" or int(token[:6]) > MOST_BYTES:
                    raise refusal(
                        number,
                        f"a length must be 0 to {MOST_BYTES} and stand before the word bytes, not {token!r}; "
                        "write it so",
                    )
                self.length = int(token)
            else:
                self._take(token)

    @property
    def takes_data(self) -> bool:
        """Whether words follow this instruction."""
        return not self.format.replies and (self.format.is_normal or "length" in (self.format.fixed or ()))

    def _take(self, token: str) -> None:
        """Add a flag, a number or an operand."""
        name, _, value = token.partition("=")
        upper = name.upper()
        if self.format.is_normal and upper in FLAG_OF_NAME and not value:
            self.low_byte |= FLAG_OF_NAME[upper]
        elif self.format.is_normal and upper in OPERAND_OF_WORD:
            operand = OPERAND_OF_WORD[upper]
            words = numbers_of(value, self.number) if value else ()
            allowed: tuple[int, ...] = (6, 12) if operand.name == "conic" else (operand.words,)
            if self.format.requests_operands:
                allowed = (0,)
            if len(words) not in allowed:
                raise refusal(
                    self.number,
                    f"{name} must be {' or '.join(map(str, allowed))} numbers, not {value!r}; give all",
                )
            self.operands[operand.name] = words
        elif not self.format.is_normal and name in (self.format.fixed or ()) and name != "length":
            words = numbers_of(value, self.number)
            if len(words) != 1:
                raise refusal(self.number, f"{name} must be one number, not {value!r}; give one")
            self.operands[name] = words
        elif not self.format.is_normal and re.fullmatch(r"#[0-9]{1,3}", token) and int(token[1:]) <= 0xFF:
            self.low_byte = int(token[1:])
        else:
            raise refusal(
                self.number,
                f"what follows {self.format.name} must be a flag, an operand or a length, not {token!r}; "
                "see `ramtek list`",
            )

    def add(self, kind: str, tokens: list[str], number: int) -> None:
        """Add a line of data."""
        if kind == "text":
            codes = b"".join(string_of(token, number) for token in tokens)
            if self.bytes % 2:
                raise refusal(
                    number, "text must follow an even number of bytes; join it with the line before"
                )
            self.bytes += len(codes)
            order = "<u2" if self.low_byte & Flags.REVERSE_PACKING else ">u2"
            words = np.frombuffer(codes + bytes(len(codes) % 2), order).astype(np.uint16)
        else:
            if kind == "to":
                points = [numbers_of(token, number) for token in tokens]
                if any(len(point) != 2 for point in points):
                    raise refusal(
                        number, f"a point must be element,line, not {' '.join(tokens)!r}; write it so"
                    )
                words = np.array(points, np.uint16).reshape(-1)
            else:
                words = hexadecimal_words(tokens, number)
            self.bytes += 2 * len(words)
        self.data.append(words)
        if self.bytes > MOST_BYTES + 1:
            raise refusal(
                number,
                f"the data must be at most {MOST_BYTES} bytes, not {self.bytes}; write two instructions",
            )

    def stream(self) -> bytes:
        """The bytes of the whole instruction."""
        data = np.concatenate(self.data) if self.data else NO_WORDS
        length = self.length
        if length is None and (len(data) or "length" in (self.format.fixed or ())):
            length = self.bytes
        expected = 0 if self.format.replies else ((length or 0) + 1) // 2
        if len(data) != expected:
            raise refusal(
                self.number,
                f"{self.format.name} must have data of {length or 0} bytes, not of {2 * len(data)}; "
                "leave the length out to have it counted",
            )
        missing = [name for name in self.format.fixed or () if name not in self.operands and name != "length"]
        if missing:
            raise refusal(
                self.number, f"{self.format.name} must have all its operands; add {', '.join(missing)}"
            )
        low_byte = self.low_byte
        if self.format.is_normal:
            low_byte |= Flags.DATA if length is not None else 0
            low_byte |= Flags.OPERANDS_1 if any(row.name in self.operands for row in OPERANDS_1) else 0
            low_byte |= Flags.OPERANDS_2 if any(row.name in self.operands for row in OPERANDS_2) else 0
        # Send the operands in the order of the table, in whatever order they were written.
        named = {
            name: self.operands[name] for name in (self.format.fixed or OPERANDS) if name in self.operands
        }
        try:
            words = encode(Instruction(self.format, int(low_byte), named, length, data))
        except InstructionError as cause:
            raise refusal(self.number, str(cause)) from cause
        return words.astype("<u2", copy=False).tobytes()


LEFT: Final = re.compile(r"\s*[0-9A-Fa-f]{4,}:(?: [0-9A-Fa-f]{4})*(?=\s|$)")
TOKEN: Final = re.compile(r'\s+|;.*|"(?:[^"\\]|\\.)*"|[^\s";]+')
NUMBER: Final = re.compile(r"-?[0-9]{1,6}|0[xX][0-9A-Fa-f]{1,4}")
HEXADECIMAL: Final = re.compile(r"(?P<word>[0-9A-Fa-f]{1,4})(?:\*(?P<times>[0-9]{1,5}))?")
ESCAPE: Final = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)")
MOST_WORDS: Final = 0x8000
"""The most words in a line: the data of an instruction have no more."""
MOST_LINE: Final = 1 << 16
"""Limit: the most characters in a line."""


def tokens_of(line: str, number: int) -> list[str]:
    """The tokens of a line, without the words on the left and the comment."""
    if len(line) > MOST_LINE:
        raise refusal(number, f"a line must be at most {MOST_LINE} characters, not {len(line)}; break it")
    left = LEFT.match(line)
    text = line[left.end() if left else 0 :].strip()
    tokens, place = [], 0
    while place < len(text):
        token = TOKEN.match(text, place)
        if token is None:
            raise refusal(
                number, f"a string must end with a quotation mark, not as {text[place:][:40]!r}; add it"
            )
        place = token.end()
        if not token[0].isspace() and not token[0].startswith(";"):
            tokens.append(token[0])
    return tokens


def numbers_of(text: str, number: int) -> tuple[int, ...]:
    """Numbers separated by commas, or the two points of a window, as 16-bit words."""
    words = []
    for part in text.replace("..", ",").split(","):
        if not NUMBER.fullmatch(part) or not -0x8000 <= int(part, 0 if "x" in part.lower() else 10) <= 0xFFFF:
            raise refusal(
                number, f"a number must be -32768 to 65535, decimal or after 0x, not {part!r}; write it so"
            )
        words.append(int(part, 0 if "x" in part.lower() else 10) & 0xFFFF)
    return tuple(words)


def hexadecimal_words(tokens: list[str], number: int) -> Words:
    """The words of tokens such as 0010, or 0010*640 for a word that repeats 640 times."""
    values, times = [], []
    for token in tokens:
        parts = HEXADECIMAL.fullmatch(token)
        if parts is None or int(parts["times"] or 1) > MOST_WORDS:
            raise refusal(
                number,
                f"a word must be 0000 to FFFF, or one with *times to {MOST_WORDS}, not {token!r}; mend it",
            )
        values.append(int(parts["word"], 16))
        times.append(int(parts["times"] or 1))
    if sum(times) > MOST_WORDS:
        raise refusal(number, f"a line must be at most {MOST_WORDS} words, not {sum(times)}; break it")
    return np.repeat(np.array(values, np.uint16), times)


def string_of(token: str, number: int) -> bytes:
    r"""The bytes of a string in quotation marks; the escapes are `\"`, `\\` and, for any byte, `\x1B`."""
    text = ESCAPE.sub(lambda escape: chr(int(escape[1], 16)) if escape[1] else escape[2], token[1:-1])
    if len(token) < 2 or token[0] != '"' or not all(ord(character) < 256 for character in text):
        raise refusal(
            number, f"text must be in quotation marks, its codes 0 to 255, not {token!r}; write it so"
        )
    return text.encode("latin-1")


OVERLONG: Final = re.compile(r"(, not .{60}).{20,}(; )")
"""Limit: the quoted part of a message is cut after 60 characters."""


def refusal(number: int, sentence: str) -> ListingError:
    """The error for a line that cannot be assembled."""
    shortened = OVERLONG.sub(r"\1...\2", sentence)
    return ListingError(f"line {number}: {shortened}")
