"""The sent screen: what the last edit sent to the display, as instructions in the form of `ramtek list`.

An edit of a color sends a load of entries, and an edit of the view sends the words of the picture. The
listing has these words in the order in which they were sent. The words for menus and panels are only
counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice
from textwrap import wrap
from typing import Final

from autocolor.journal.description import describe
from autocolor.screens.cached import Cached
from autocolor.screens.comparing import MOST_DESCRIBED
from autocolor.screens.pages import CHARACTERS, PageRow, Pages
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import SENT, LastEdit, Session
from autocolor.sending import configuration_of
from autocolor.widgets.items import LIGHT_GRAY, WHITE, YELLOW
from ramtek_emu import Configuration, EntryFormat
from ramtek_emu.instruction_set.disassembler import ListingItem, items

MOST_LINES: Final = 12
"""Assumed: lines of the listing of one instruction; its further data are left out."""

INDENT: Final = " " * 40
"""Before the rest of a line of the listing that is wider than the screen."""


class SentScreen(Pages):
    """The last edit: what it was, how many words it sent, and their listing."""

    name = SENT
    title = "last edit"
    help = "The instructions that the last edit sent to the display"
    heading = "LAST EDIT"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._rows: Cached[Sequence[PageRow]] = Cached()

    def rows(self) -> Sequence[PageRow]:
        last = self.session.last_edit
        if last is None:
            return ()
        return self._rows.of(lambda: rows_of_edit(last, configuration_of(self.session.display)), last)

    def build(self, around: Surroundings) -> Content:
        # An edit on this screen is listed once it has been sent.
        shown = self.session.last_edit
        return replace(super().build(around), idle=lambda: shown is not self.session.last_edit)


def rows_of_edit(edit: LastEdit, configuration: Configuration) -> list[PageRow]:
    """The rows of an edit: its description, numbers of words, shares of instructions, and the listing."""
    listed = list(items([edit.words.astype("<u2").tobytes()], configuration))
    what = describe(edit.before, edit.after, MOST_DESCRIBED) or "no change"
    return [
        PageRow("the scene was opened" if edit.before is edit.after else what, YELLOW),
        PageRow(f"{counted(len(edit.words), 'word')}: {_effect(listed, configuration)}"),
        PageRow(f"and {counted(edit.other_words, 'word')} for menus, panels and other parts of the screen"),
        PageRow(),
        *_shares(listed, len(edit.words)),
        PageRow(),
        *[row for item in listed for row in _listing(item)],
    ]


def counted(count: int, noun: str) -> str:
    """A number of things.

    >>> counted(0, "entry"), counted(1, "word"), counted(1024, "entry")
    ('no entry', '1 word', '1,024 entries')
    """
    plural = f"{noun[:-1]}ies" if noun.endswith("y") else f"{noun}s"
    return f"{count:,} {plural}" if count > 1 else f"1 {noun}" if count else f"no {noun}"


def _effect(listed: Sequence[ListingItem], configuration: Configuration) -> str:
    """The numbers of the entries and of the words of the picture that instructions write."""
    lengths = {"LAM": 0, "WI": 0}
    for item in listed:
        if item.instruction is not None and item.instruction.format.name in lengths:
            lengths[item.instruction.format.name] += len(item.instruction.data)
    entries = lengths["LAM"] // (1 if configuration.entry_format is EntryFormat.WORD_12 else 2)
    words = counted(lengths["WI"], "word")
    return f"{counted(entries, 'entry')} of the lookup table, and {words} of the picture"


def _shares(listed: Sequence[ListingItem], words: int) -> Iterator[PageRow]:
    """A row for each kind of instruction: its number, its words, and their share, the largest share first."""
    lengths: dict[tuple[str, str], list[int]] = {}
    for item in listed:
        if item.instruction is not None:
            form = item.instruction.format
            lengths.setdefault((form.name, form.meaning), []).append(len(item.words))
    for (name, meaning), each in sorted(lengths.items(), key=lambda row: -sum(row[1])):
        count, length = counted(len(each), "instruction"), counted(sum(each), "word")
        yield PageRow(f"{name:4} {count:>16} {length:>14} {sum(each) / words:>6.1%}  {meaning}")


def _listing(item: ListingItem) -> Iterator[PageRow]:
    """The lines of an instruction; of long data, the first lines and the number of words left out."""
    lines = item.lines()
    for number, line in enumerate(islice(lines, MOST_LINES)):
        for part in wrap(line, CHARACTERS, subsequent_indent=INDENT, break_on_hyphens=False):
            yield PageRow(part, LIGHT_GRAY if number else WHITE)
    following = next(lines, None)
    if following is not None:
        place = int(following.partition(":")[0], 16)
        left_out = item.place + len(item.words) - place
        yield PageRow(f"{INDENT}and {counted(left_out, 'word')} more of this instruction", LIGHT_GRAY)
