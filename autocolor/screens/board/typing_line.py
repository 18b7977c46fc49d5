"""Typing: a text that is typed into a widget, and stands in the message line until it is taken."""

from __future__ import annotations

from typing import Final

from autocolor.screens.session import Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Typed, Widget

NUMBERS: Final = "0123456789.-+"
"""What begins a number."""


class TypingLine:
    """The text that is being typed, if any."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._label = ""
        self._text = ""
        self._typed: Typed | None = None
        self._is_fresh = False

    @property
    def is_on(self) -> bool:
        """Whether a text is being typed."""
        return self._typed is not None

    @property
    def shown(self) -> str:
        """What the message line says."""
        return f"{self._label}: {self._text}_"

    def would_begin(self, widget: Widget, typed: str) -> bool:
        """Whether typing a character over a widget begins to type into it."""
        return isinstance(widget, Bar) and not widget.why_not and typed != "" and typed in NUMBERS

    def begin(self, widget: Widget, typed: str = "") -> None:
        """Begin with the widget's text, which the first character replaces."""
        if not self._session.has_keyboard:
            self._session.tell(f"{widget.label}: typing needs a keyboard", is_warning=True)
            return
        self._typed = widget.typed
        self._label = widget.label
        self._text = typed or (self._typed.text if self._typed is not None else "")
        self._is_fresh = not typed

    def end(self) -> None:
        """Type no more, and take nothing."""
        self._typed = None

    def take(self) -> None:
        """Take the text if it was changed. One that is refused, with an error, stays to be mended."""
        if self._typed is not None and self._text != self._typed.text:
            self._typed.take(self._text)
        self.end()

    def key(self, name: str, typed: str) -> None:
        """Take a key. Raises the errors of what takes the text."""
        if name == "escape":
            self.end()
        elif name in ("return", "enter", "tab"):
            self.take()
        elif name == "backspace":
            self._text, self._is_fresh = ("" if self._is_fresh else self._text[:-1]), False
        elif typed and typed.isprintable():
            self._text, self._is_fresh = (typed if self._is_fresh else self._text + typed), False
