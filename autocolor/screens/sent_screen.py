"""The sent screen: what the last edit sent to the display, as instructions in the form of `ramtek list`.

An edit of a color sends a load of entries, and an edit of the view sends the words of the picture. The
listing has these words in the order in which they were sent. The words for menus and panels are only
counted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice
from textwrap import wrap
from typing import Final, NamedTuple

from autocolor.journal.description import describe
from autocolor.screens.cached import Cached
from autocolor.screens.comparing import MOST_DESCRIBED
from autocolor.screens.screen import Content, Pages, Surroundings, page_of
from autocolor.screens.session import SENT, LastEdit, Session
from autocolor.sending import configuration_of
from autocolor.widgets.items import CHARACTER, LIGHT_GRAY, WHITE, WIDTH, YELLOW, Item, text
from ramtek_emu import Configuration, EntryFormat
from ramtek_emu.instruction_set.disassembler import ListingItem, items

TITLE: Final = "LAST EDIT"
LEFT: Final = 8
MIDDLE: Final = 160
TOP: Final = 50
STEP: Final = 13
"""The lines from row to row."""
END: Final = 462
ROWS_A_PAGE: Final = (END - TOP) // STEP
CHARACTERS: Final = (WIDTH - 2 * LEFT) // CHARACTER

MOST_LINES: Final = 12
"""Assumed: lines of the listing of one instruction; its further data are left out."""

OTHERS: Final = "menus, panels and other parts of the screen"
"""The things whose words are counted and not listed."""

INDENT: Final = " " * 40
"""Before the rest of a line of the listing that is wider than the screen."""


class ListingRow(NamedTuple):
    """A row of the screen, and the word of its characters."""

    text: str = ""
    ink: int = WHITE


class SentScreen(Pages):
    """The last edit: what it was, how many words it sent, and their listing."""

    name = SENT
    title = "last edit"
    help = "The instructions that the last edit sent to the display"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._rows: Cached[Sequence[ListingRow]] = Cached()
        self._shown: LastEdit | None = None

    def items(self) -> Sequence[Item]:
        """The title, and the rows of this page."""
        last = self._shown = self.session.last_edit
        rows: Sequence[ListingRow] = ()
        if last is not None:
            configuration = configuration_of(self.session.display)
            rows = self._rows.of(lambda: rows_of_edit(last, configuration), last)
        shown, turn = page_of(rows, self.page, ROWS_A_PAGE)
        return [
            text(TITLE, LEFT, 22, YELLOW, size=2),
            *([text(turn, MIDDLE, 28, LIGHT_GRAY)] if turn else []),
            *[
                text(row.text, LEFT, TOP + STEP * number, row.ink)
                for number, row in enumerate(shown)
                if row.text
            ],
        ]

    def build(self, around: Surroundings) -> Content:
        # An edit on this screen is listed once it has been sent.
        return replace(super().build(around), idle=lambda: self._shown is not self.session.last_edit)


def rows_of_edit(edit: LastEdit, configuration: Configuration) -> list[ListingRow]:
    """The rows of an edit: its description, numbers of words, shares of instructions, and the listing."""
    listed = list(items([edit.words.astype("<u2").tobytes()], configuration))
    what = describe(edit.before, edit.after, MOST_DESCRIBED) or "no change"
    return [
        ListingRow("the scene was opened" if edit.before is edit.after else what, YELLOW),
        ListingRow(f"{counted(len(edit.words), 'word')}: {_effect(listed, configuration)}"),
        ListingRow(f"besides, {counted(edit.other_words, 'word')} for {OTHERS}"),
        ListingRow(),
        *_shares(listed, len(edit.words)),
        ListingRow(),
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
    data: Counter[str] = Counter()
    for item in listed:
        if item.instruction is not None:
            data[item.instruction.format.name] += len(item.instruction.data)
    entries = data["LAM"] // (1 if configuration.entry_format is EntryFormat.WORD_12 else 2)
    return (
        f"{counted(entries, 'entry')} of the lookup table, and {counted(data['WI'], 'word')} of the picture"
    )


def _shares(listed: Sequence[ListingItem], words: int) -> Iterator[ListingRow]:
    """A row for each kind of instruction: its number, its words, and their share, the largest share first."""
    counts: Counter[str] = Counter()
    lengths: Counter[str] = Counter()
    meanings = {}
    for item in listed:
        name = "raw" if item.instruction is None else item.instruction.format.name
        meanings[name] = item.note if item.instruction is None else item.instruction.format.meaning
        counts[name] += 1
        lengths[name] += len(item.words)
    for name, length in lengths.most_common():
        count, length_text = counted(counts[name], "instruction"), counted(length, "word")
        yield ListingRow(f"{name:4} {count:>16} {length_text:>14} {length / words:>6.1%}  {meanings[name]}")


def _listing(item: ListingItem) -> Iterator[ListingRow]:
    """The lines of an instruction; of long data, the first lines and the number of words left out."""
    lines = item.lines()
    for number, line in enumerate(islice(lines, MOST_LINES)):
        for part in wrap(line, CHARACTERS, subsequent_indent=INDENT, break_on_hyphens=False):
            yield ListingRow(part, LIGHT_GRAY if number else WHITE)
    following = next(lines, None)
    if following is not None:
        place = int(following.partition(":")[0], 16)
        left_out = item.place + len(item.words) - place
        yield ListingRow(f"{INDENT}and {counted(left_out, 'word')} more of this instruction", LIGHT_GRAY)
