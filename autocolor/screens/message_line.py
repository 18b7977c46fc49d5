"""The message line: the bottom lines of every screen, for errors, results, hints and what is typed.

A message that does not fit takes further lines over the screen while it stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import Final, NamedTuple

from autocolor.screens.session import Offer, Session
from autocolor.widgets.items import BLACK, CHARACTER, HEIGHT, WIDTH, YELLOW, Area, Item, filled, text
from autocolor.widgets.menu import MESSAGE_CHARACTERS, MESSAGE_LINES
from autocolor.widgets.widget import MARGIN, Entry, PanelButton, Widget

MESSAGE: Final = Area(0, HEIGHT - MESSAGE_LINES, WIDTH - 1, HEIGHT - 1)
LINE_STEP: Final = 12
"""Lines from one line of a message to the next."""

MOST_LINES: Final = 2
"""Assumed: lines of a message, and of a typed text; longer texts are cut."""


class MessagePart(NamedTuple):
    """A part of a message: its text, and the word of its color."""

    text: str
    ink: int
    selected: int | None = None
    """Of a typed text, the number of the first character that is selected; None for other texts."""


def message_items(parts: Sequence[MessagePart], end: int = WIDTH) -> list[Item]:
    """The parts of a message one below the other, the last line in the message line.

    Lines above the message line end before element `end`.
    """
    is_short = len(parts) == 1 and len(parts[0].text) <= MESSAGE_CHARACTERS
    most = MESSAGE_CHARACTERS if is_short else (end - 16) // CHARACTER
    lines = [line for part in parts for line in lines_of_message(part, most)]
    first = MESSAGE.top - LINE_STEP * (len(lines) - 1)
    items = [filled(MESSAGE, BLACK)]
    if len(lines) > 1:
        items.append(filled(Area(0, first, end - 1, MESSAGE.top - 1), BLACK))
    for number, (line, ink, selected) in enumerate(lines):
        top, place = first + LINE_STEP * number + 3, len(line) if selected is None else selected
        parts_of_line = (line[:place], 8, ink, BLACK), (line[place:], 8 + CHARACTER * place, BLACK, ink)
        items += [text(part, left, top, word, ground) for part, left, word, ground in parts_of_line if part]
    return items


def lines_of_message(part: MessagePart, most: int) -> list[MessagePart]:
    """A part of a message in lines of at most `most` characters.

    A long text is cut at its end; a typed text at its beginning, so that the last typed letters are seen.
    """
    line, ink, selected = part
    if selected is None:
        rows = wrap(line, most, max_lines=MOST_LINES, placeholder="..", tabsize=1) or [""]
        return [MessagePart(row, ink) for row in rows]
    cut = max(0, len(line) - MOST_LINES * most)
    if cut:
        line, selected = f"..{line[cut + 2 :]}", max(2, selected - cut)
    firsts = range(0, len(line), most)
    return [MessagePart(line[first : first + most], ink, max(0, selected - first)) for first in firsts]


def offer_button(offer: Offer | None) -> Widget | None:
    """The button of an offer, at the right end of the message line."""
    if offer is None:
        return None
    left = WIDTH - CHARACTER * len(offer.label) - 2 * MARGIN
    return PanelButton(offer.label, area=MESSAGE._replace(left=left), run=offer.run, within="message")


NUMBERS: Final = "0123456789.-+"
"""The characters that begin a number, and so begin typing over a bar."""


class TypingLine:
    """The text that is being typed, if any."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._entry: Entry | None = None
        self._is_fresh = False
        """Whether the text is selected: the next character replaces it."""
        self.text = ""
        """The text that is being typed."""

    @property
    def is_on(self) -> bool:
        """Whether a text is being typed."""
        return self._entry is not None

    @property
    def is_by_letters(self) -> bool:
        """Whether a text is typed by the letter panel, because there is no keyboard."""
        return self.is_on and not self._session.has_keyboard

    @property
    def shown(self) -> MessagePart:
        """The text for the message line."""
        label = f"{self._entry.label}: " if self._entry else ""
        if self._is_fresh and self.text:
            return MessagePart(label + self.text, YELLOW, len(label))
        line = f"{label}{self.text}_"
        return MessagePart(line, YELLOW, len(line))

    def begin(self, entry: Entry, typed: str = "") -> None:
        """Begin with a character, or with the entry's text, which the first character replaces."""
        self._entry, self.text, self._is_fresh = entry, typed or entry.value, not typed

    def insert(self, text: str) -> None:
        """Append a text, or replace the selected text by it."""
        self.text, self._is_fresh = (text if self._is_fresh else self.text + text), False

    def end(self) -> None:
        """End typing without taking the text."""
        self._entry = None

    def take(self) -> None:
        """Take the text if it was changed or proposed. A refused text raises an error and stays, selected."""
        entry = self._entry
        if entry is not None and (entry.is_proposed or self.text != entry.value):
            self._is_fresh = True
            entry.take(self.text)
        self.end()

    def leave(self) -> None:
        """Take the text as `take` does, but give up a text that was proposed."""
        if self._entry is not None and self._entry.is_proposed:
            self.end()
        self.take()

    def key(self, name: str, typed: str) -> None:
        """Take a key. Raises the errors of the function that takes the text."""
        if name == "escape":
            self.end()
        elif name in ("return", "enter", "tab"):
            self.take()
        elif name == "backspace":
            self.text, self._is_fresh = ("" if self._is_fresh else self.text[:-1]), False
        elif name in ("end", "right"):
            self._is_fresh = False
        elif typed and typed.isprintable():
            self.insert(typed)
