"""Claims: the lines of the `.jsonl` files, each a JSON object with words in hexadecimal.

docs/CONFORMANCE.md describes the keys. Data are edited by hand; no program writes them.

>>> words_of("0010*3 00FF").tolist()
[16, 16, 16, 255]
>>> text_of(words_of("0010 0010 0010 00FF"))
'0010*3 00FF'
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from ramtek_emu.arrays import Words
from ramtek_emu.instruction_set.assembler import hexadecimal_words
from ramtek_emu.instruction_set.disassembler import runs

JOYSTICK: Final = "joystick "
"""The prefix of a write that is a line for the joystick unit."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """What a display must reply to some words."""

    subject: str
    """The name of the file, without its suffix."""
    name: str
    display: str
    """The name of a configuration, in lower case."""
    writes: tuple[str, ...]
    """The host's writes: words in hexadecimal, or a line for the joystick unit."""
    of: str
    """A description of the data that `ask` reads: a window, entries, an operating point."""
    ask: str
    replies: str
    """All words that the display replies, to the writes and to `ask`."""
    source: str
    """A key of docs/SOURCES.md and a file; for assumed claims, the source of the instruction."""
    kind: str
    """`sourced` or `assumed`."""
    cut: str = ""
    """`every` if the stream is also sent in two parts, cut at every place."""
    in_process: dict[str, Any] = field(default_factory=dict)
    """What a pipe cannot see: `status`, `field`, `listing`."""

    @property
    def streams(self) -> tuple[str, ...]:
        """The writes and the request, in the order in which they are sent."""
        return (*self.writes, self.ask) if self.ask else self.writes

    @property
    def words(self) -> Words:
        """The words of all writes and of the request, (n,) uint16."""
        return words_of(" ".join(self.streams))

    def is_about(self, key: str) -> bool:
        """Whether the key names this claim: its subject, source, kind or display, or a part of its name."""
        asked = key.lower().replace("_", "-")
        named = self.subject, self.source.partition(" ")[0].lower(), self.kind, self.display
        return asked in named or asked in self.name.lower()


def all_claims() -> list[Claim]:
    """The claims of all files, in the order of subjects and lines."""
    return [
        Claim(
            subject=path.stem,
            **{name.replace(" ", "_"): value for name, value in json.loads(line).items()},
        )
        for path in sorted(Path(__file__).parent.glob("*.jsonl"))
        for line in path.read_text("utf-8").splitlines()
    ]


def words_of(text: str) -> Words:
    """The words of a text, (n,) uint16: `0010` is a word, `0010*640` is a word 640 times."""
    return hexadecimal_words(text.split())


def text_of(words: Words) -> str:
    """The text of words, in which a word that repeats three times or more is written once."""
    return " ".join(text for _, text in runs(words))
