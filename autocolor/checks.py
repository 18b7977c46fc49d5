"""Whether a number is whole; and parts of messages about invalid input: a value, names, the name meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from numbers import Integral
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Final, NoReturn

Vector = tuple[float, float, float]
Color = tuple[int, int, int]

LONGEST_NAME: Final = 200
"""Limit: letters of a name that are compared; the time to compare names grows with their lengths."""

MOST_COMPARED: Final = 1000
"""Limit: names whose spelling is compared with a wrong name; each takes some ten microseconds."""

LARGEST_COORDINATE: Final = 1e30
"""Limit: a coordinate. Its square is still well within the float64 range."""


def is_whole(value: object, least: int, most: int) -> bool:
    """Whether a value is a whole number from `least` to `most`, of any type but bool.

    >>> is_whole(3, 1, 4), is_whole(True, 0, 1), is_whole(2.0, 1, 4)
    (True, False, False)
    """
    return isinstance(value, Integral) and not isinstance(value, bool) and least <= int(value) <= most


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
        # A whole number of thousands of digits, or deeply nested lists.
        text = f"a very large {type(value).__name__}"
    return text if len(text) <= most else f"{text[:most]}..."


def brief(text: str, most: int = 80) -> str:
    """The text for a message, at most `most` characters: of a longer text the beginning and the end.

    >>> brief("lights.key.intensity", most=11)
    'ligh...sity'
    """
    part = (most - 3) // 2
    return text if len(text) <= most else f"{text[:part]}...{text[-part:]}"


def printable(text: str) -> str:
    """The text with a question mark instead of each unprintable character, such as a line break."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def listed(names: Iterable[str]) -> str:
    """The names as a list in English.

    >>> listed(["x", "y", "z"])
    'x, y and z'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def either(names: Iterable[str]) -> str:
    """The names, quoted, as alternatives in English.

    >>> either(["x", "y", "z"])
    "'x', 'y' or 'z'"
    """
    *others, last = map(repr, names)
    return f"{', '.join(others)} or {last}" if others else last


FEW: Final = 20
"""Limit: names that a message lists."""

OTHER_WORDS: Final = {
    "A": "cone_angle",
    "C": "concentration",
    "D": "diffuse",
    "N": "exponent",
    "S": "specular",
    "brightness": "intensity",
    "camera": "view",
    "colour": "object_color",
    "faces": "node_numbers",
    "fov": "field_of_view",
    "nodes": "coordinates",
    "polygons": "node_numbers",
    "power": "intensity",
    "shininess": "exponent",
    "vertices": "coordinates",
}
"""The field names for symbols of the paper and for words of other programs."""

FUNCTIONS: Final = {
    "image": ("image",),
    "load": ("read_scene",),
    "load_mesh": ("read_scene",),
    "open": ("read_scene",),
    "read": ("read_scene",),
    "read_mesh": ("read_scene",),
    "read_obj": ("read_scene",),
    "recolor": ("Studio.recolor",),
    "render": ("render",),
    "save": ("save_image", "write_scene", "write_picture"),
    "save_image": ("save_image",),
    "save_palette": ("write_palette",),
    "save_picture": ("write_picture",),
    "save_png": ("save_image",),
    "save_scene": ("write_scene",),
    "show": ("view",),
    "sweep": ("batch",),
    "write": ("write_scene", "write_picture"),
    "write_image": ("save_image",),
    "write_page": ("save_page",),
}
"""The functions of autocolor for words of other programs, and for methods that no scene or picture has."""


def nearest(name: object, names: Iterable[object]) -> str:
    """The end of a message about an unknown name: the closest of `names`, else all of them if they are few.

    Values in `names` that are not text are ignored.

    >>> nearest("x", ["blend", "levels"])
    "; choose 'blend' or 'levels'"
    """
    texts = [text for text in names if isinstance(text, str)]
    return closest(name, texts) or (f"; choose {either(texts)}" if 0 < len(texts) <= FEW else "")


def closest(name: object, names: Iterable[str]) -> str:
    """The end of a message about an unknown name: the closest of `names`; empty if none is close.

    The order of preference: our name for another program's word; a name that differs in capitals only; the
    shortest name that begins with the given name; a name with the given name between underscores or periods;
    the most similar spelling among the first MOST_COMPARED names.

    >>> closest("color", ["blend", "object_color"]), closest("N", ["exponent"])
    ("; did you mean 'object_color'?", "; did you mean 'exponent'?")
    """
    texts = list(names)
    name = (name if isinstance(name, str) else shown(name))[:LONGEST_NAME]
    other = OTHER_WORDS.get(name)
    close = (
        [text for text in texts if text == other]
        or [text for text in texts if text.casefold() == name.casefold()]
        or sorted((text for text in texts if text.startswith(name)), key=len)
        or [text for text in texts if name in text.replace(".", "_").split("_")]
        or difflib.get_close_matches(name, texts[:MOST_COMPARED], n=1)
    )
    return f"; did you mean {close[0]!r}?" if close else ""


def missing_attribute(
    owner: str, name: str, names: Iterable[str], elsewhere: Mapping[str, str] = MappingProxyType({})
) -> AttributeError:
    """The error for an unknown attribute, with the name that was meant: a function, or one of `names`.

    `elsewhere` has advice for names that mean something elsewhere.

    >>> print(missing_attribute("'Scene' object", "render", []))
    'Scene' object has no attribute 'render'; did you mean 'autocolor.render'?
    """
    advice = elsewhere.get(name, "")
    if not advice and name in FUNCTIONS:
        advice = f"; did you mean {either(f'autocolor.{each}' for each in FUNCTIONS[name])}?"
    elif not advice and not name.startswith("_"):
        advice = closest(name, names)
    # Without the object, Python adds no suggestion of its own.
    return AttributeError(f"{owner} has no attribute {name!r}{advice}", name=name)


class Suggesting:
    """A base class whose objects answer an unknown attribute by the name that was meant."""

    elsewhere: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """The ends of messages about names that mean something elsewhere."""

    def _meant(self) -> Iterable[str]:
        """The names that may be meant."""
        return (name for name in dir(self) if not name.startswith("_"))

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            # A property that raised AttributeError raises it again.
            if name.startswith("_") or hasattr(type(self), name):
                return object.__getattribute__(self, name)
            owner = f"{type(self).__name__!r} object"
            raise missing_attribute(owner, name, self._meant(), type(self).elsewhere)
