"""The tokens of a listing: names, numbers, words and strings, checked and converted."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.errors import ListingError

LEFT: Final = re.compile(r"\s*[0-9A-Fa-f]{4,}:(?: [0-9A-Fa-f]{4})*(?=\s|$)")
TOKEN: Final = re.compile(r'\s+|;.*|"(?:[^"\\]|\\.)*"|[^\s";]+')
NUMBER: Final = re.compile(r"-?[0-9]{1,6}|0[xX][0-9A-Fa-f]{1,4}")
HEXADECIMAL: Final = re.compile(r"(?P<word>[0-9A-Fa-f]{1,4})(?:\*(?P<times>[0-9]{1,5}))?")
ESCAPE: Final = re.compile(r"\\x([0-9A-Fa-f]{2})|\\(.)")
MOST_TIMES: Final = 0x8000
MOST_LINE: Final = 1 << 16
"""The largest number of characters in a line."""


def tokens_of(line: str, number: int) -> list[str]:
    """The tokens of a line, without the words on the left and the comment."""
    if len(line) > MOST_LINE:
        raise refusal(number, f"a line must be at most {MOST_LINE} characters, not {len(line)}; break it")
    left = LEFT.match(line)
    text = line[left.end() if left else 0 :].strip()
    tokens, place = [], 0
    while place < len(text):
        found = TOKEN.match(text, place)
        if found is None:
            raise refusal(
                number, f"a string must end with a quotation mark, not as {text[place:][:40]!r}; add it"
            )
        place = found.end()
        if not found[0].isspace() and not found[0].startswith(";"):
            tokens.append(found[0])
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
    """Words such as 0010 and products such as 0010*640."""
    values, times = [], []
    for token in tokens:
        found = HEXADECIMAL.fullmatch(token)
        if found is None or int(found["times"] or 1) > MOST_TIMES:
            raise refusal(
                number,
                f"a word must be 0000 to FFFF, or one with *times to {MOST_TIMES}, not {token!r}; mend it",
            )
        values.append(int(found["word"], 16))
        times.append(int(found["times"] or 1))
    if sum(times) > MOST_TIMES:
        raise refusal(number, f"a line must be at most {MOST_TIMES} words, not {sum(times)}; break it")
    return np.repeat(np.array(values, np.uint16), times)


def string_of(token: str, number: int) -> bytes:
    r"""The bytes of a string in quotation marks; the escapes are `\"`, `\\` and, for any byte, `\x1B`."""
    text = ESCAPE.sub(lambda found: chr(int(found[1], 16)) if found[1] else found[2], token[1:-1])
    if len(token) < 2 or token[0] != '"' or not all(ord(character) < 256 for character in text):
        raise refusal(
            number, f"text must be in quotation marks, its codes 0 to 255, not {token!r}; write it so"
        )
    return text.encode("latin-1")


def refusal(number: int, sentence: str) -> ListingError:
    """The error for a line that cannot be assembled."""
    return ListingError(f"line {number}: {sentence}")
