"""What input checks share: how messages show values and lists, and which name was probably meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Final

Vector = tuple[float, float, float]
Color = tuple[int, int, int]

LONGEST_NAME: Final = 200
"""Assumed: letters of a name that are compared; the time to compare names grows with their lengths."""

LARGEST_COORDINATE: Final = 1e30
"""Assumed: far larger than any object; its square is still well within the float64 range."""


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
"""Assumed: as many names can be listed in a message."""


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
"""The symbols of the paper, and words of other programs, with ours."""


def nearest(name: object, names: Iterable[str]) -> str:
    """A clause for a message: the closest of `names`, else all of them if they are few, else nothing.

    Closest is one that another word stands for, then one that differs in capitals alone, then one that begins
    with the name, then one of whose words, between underscores, the name is one, and then the one that is
    spelled most alike.

    >>> nearest("color", ["blend", "object_color"]), nearest("N", ["exponent"])
    ("; did you mean 'object_color'?", "; did you mean 'exponent'?")
    """
    names = list(names)
    name = (name if isinstance(name, str) else shown(name))[:LONGEST_NAME]
    other = OTHER_WORDS.get(name)
    close = (
        [known for known in names if known == other]
        or [known for known in names if known.casefold() == name.casefold()]
        or [known for known in names if known.startswith(name)]
        or [known for known in names if name in known.split("_")]
        or difflib.get_close_matches(name, names, n=1)
    )
    if close:
        return f"; did you mean {close[0]!r}?"
    if 0 < len(names) <= FEW:
        return f"; known are {', '.join(map(repr, names))}"
    return ""
