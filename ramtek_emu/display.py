"""Ramtek9300: the display, its boxes wired together.

host port -> decoder -> processor -> frame buffer, lookup table -> scan-out -> field
"""

from os import PathLike

import numpy as np
from numpy.typing import NDArray

from .checks import checked_stream
from .configuration import GMR_9300, Configuration
from .decoder import Decoder
from .frame_buffer import FrameBuffer
from .lookup_table import LookupTable
from .processor import Processor, Status
from .scan_out import ScanOut

Words = NDArray[np.uint16]


class Ramtek9300:
    """A display in this process; itself the host port that a host sends to."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.configuration = configuration
        self.frame_buffer = FrameBuffer(configuration)
        self.lookup_table = LookupTable(configuration)
        self.processor = Processor(configuration, self.frame_buffer, self.lookup_table)
        self.decoder = Decoder(configuration)
        self.scan_out = ScanOut(configuration, self.frame_buffer, self.lookup_table)

    def send(self, words: Words) -> None:
        """Send 16-bit words as a host does, cut anywhere; WordsError when they are no words at all."""
        for instruction in self.decoder.feed(checked_stream(words)):
            self.processor.execute(instruction)

    def receive(self, count: int) -> Words:
        """The next `count` words that a reading instruction left, uint16; ReplyError when there are fewer."""
        return self.processor.take_reply(count)

    def field(self) -> NDArray[np.uint8]:
        """What the monitor shows, (lines, elements, 3) uint8."""
        return self.scan_out.field()

    @property
    def words(self) -> Words:
        """The words, (lines, elements) uint16, read-only; always the present ones."""
        return self.frame_buffer.words

    @property
    def entries(self) -> NDArray[np.uint8]:
        """The entries of the lookup table, (1024, 3) uint8, read-only; a copy of this moment."""
        return self.lookup_table.entries

    @property
    def status(self) -> Status:
        """The bits of the interface's status register."""
        return self.processor.status

    def save_png(self, path: str | PathLike[str], overwrite: bool = True) -> None:
        """Write the field to a PNG file, wholly or not at all; OutputExistsError or WriteError if not."""
        from .png import save_png

        save_png(self.field(), path, overwrite)

    def _repr_png_(self) -> bytes:
        """The field for a notebook."""
        from .png import png_bytes

        return png_bytes(self.field())
