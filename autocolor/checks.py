"""Parts of messages about invalid input: values, lists of names, and the name that was probably meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Final

Vector = tuple[float, float, float]
Color = tuple[int, int, int]

LONGEST_NAME: Final = 200
"""Limit: letters of a name that are compared; the time to compare names grows with their lengths."""

LARGEST_COORDINATE: Final = 1e30
"""Limit: a coordinate. Its square is still well within the float64 range."""


def shown(value: object, most: int = 60) -> str:
    """The value as text for a message, at most about `most` characters; booleans are written as in TOML.

    >>> shown(True), shown("body"), shown((1, 2)), shown("x" * 100, most=3)
    ('true', "'body'", '(1, 2)', "'xxx'...")
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return repr(value) if len(value) <= most else f"{value[:most]!r}..."
    try:
        text = repr(value)
    except (ValueError, RecursionError):
        # A whole number of thousands of digits, or a list in lists in lists.
        text = f"a very large {type(value).__name__}"
    return text if len(text) <= most else f"{text[:most]}..."


def printable(text: str) -> str:
    """The text with a question mark for each letter that cannot be printed, such as the end of a line."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def listed(names: Iterable[str]) -> str:
    """The names as a list in English.

    >>> listed(["x", "y", "z"])
    'x, y and z'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def either(names: Iterable[str]) -> str:
    """The names as alternatives, as in a sentence.

    >>> either(["x", "y", "z"])
    "'x', 'y' or 'z'"
    """
    *others, last = map(repr, names)
    return f"{', '.join(others)} or {last}" if others else last


FEW: Final = 16
"""Limit: names that a message lists."""

OTHER_WORDS: Final = {
    "A": "cone_angle",
    "C": "concentration",
    "D": "diffuse",
    "N": "exponent",
    "S": "specular",
    "colour": "object_color",
    "fov": "field_of_view",
    "shininess": "exponent",
}
"""Our names for symbols of the paper and for words of other programs."""


def nearest(name: object, names: Iterable[object]) -> str:
    """A clause for a message: the closest of `names`, else all of them if they are few, else nothing.

    These are tried in turn: our name for another program's word; a name that differs in capitals only; one
    that begins with the given name; one that has it as a word between underscores; the most similar spelling.
    Only text is a name: anything else among `names` is left out.

    >>> nearest("color", ["blend", "object_color"]), nearest("N", ["exponent"])
    ("; did you mean 'object_color'?", "; did you mean 'exponent'?")
    """
    texts = [each for each in names if isinstance(each, str)]
    name = (name if isinstance(name, str) else shown(name))[:LONGEST_NAME]
    other = OTHER_WORDS.get(name)
    close = (
        [text for text in texts if text == other]
        or [text for text in texts if text.casefold() == name.casefold()]
        or [text for text in texts if text.startswith(name)]
        or [text for text in texts if name in text.split("_")]
        or difflib.get_close_matches(name, texts, n=1)
    )
    if close:
        return f"; did you mean {close[0]!r}?"
    if 0 < len(texts) <= FEW:
        return f"; known are {', '.join(map(repr, texts))}"
    return ""
