"""Labels: the names of numbers and of things, made short enough for a narrow row."""

from __future__ import annotations

from typing import Final

FEWEST: Final = 3
"""Letters that are left of a shortened word, before its period."""

VOWELS: Final = "aeiou"


def short_label(label: str, most: int) -> str:
    """A label with its longest words shortened, as far as needed for `most` characters, if that is possible.

    A shortened word ends in a consonant and a period.

    >>> short_label("normal reflectance", 12), short_label("x minimum", 7), short_label("cone angle", 10)
    ('normal refl.', 'x min.', 'cone angle')
    """
    words = label.split(" ")
    for number in sorted(range(len(words)), key=lambda each: -len(words[each])):
        excess = len(" ".join(words)) - most
        if excess <= 0:
            break
        word = words[number]
        stem = word[: max(FEWEST, len(word) - excess - 1)]
        while len(stem) > FEWEST and stem[-1] in VOWELS:
            stem = stem[:-1]
        if len(stem) + 1 < len(word):
            words[number] = f"{stem}."
    return " ".join(words)


def short_name(name: str, most: int) -> str:
    """A name of at most so many characters; of a longer one the middle is left out, as ends differ.

    >>> short_name("fender of the left door 12.obj", 16)
    'fender .. 12.obj'
    """
    if len(name) <= most:
        return name
    end = max(0, (most - 2) // 2)
    return f"{name[: max(0, most - 2 - end)]}..{name[len(name) - end :]}"[: max(0, most)]
