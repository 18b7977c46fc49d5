"""ScanOut: words through the lookup table, one field at a time.

What is modelled: every visible word selects its entry; with fewer planes than the table has address bits,
the upper bits of the table's address counter pick the part that is shown. What is **not**: interlace,
blanking and the time of the beam.

Hardware: GM (one word selects all three components); LIN, JPL, BTL (parking the address counter).
"""

import numpy as np
from numpy.typing import NDArray

from .configuration import Configuration
from .frame_buffer import FrameBuffer
from .lookup_table import LookupTable


class ScanOut:
    """Makes fields from a frame buffer and a lookup table."""

    def __init__(
        self, configuration: Configuration, frame_buffer: FrameBuffer, lookup_table: LookupTable
    ) -> None:
        self.lines = configuration.shown_lines
        self.elements = configuration.shown_elements
        self._frame_buffer = frame_buffer
        self._lookup_table = lookup_table
        self._words = configuration.largest_word + 1
        # np.take is fastest with indices of the machine's own size; they are renewed when words were written.
        self._indices = np.zeros((self.lines, self.elements), np.intp)
        self._written = 0

    @property
    def stamp(self) -> tuple[int, ...]:
        """A value that moves whenever the field may have changed."""
        return self._frame_buffer.written, self._lookup_table.written, self._partition()

    def scan_out_into(self, pixels: NDArray[np.uint32]) -> None:
        """Write the field as 0x00RRGGBB into a (lines, elements) uint32 array."""
        if self._written != self._frame_buffer.written:
            self._written = self._frame_buffer.written
            np.copyto(self._indices, self._frame_buffer.words[: self.lines, : self.elements])
        first = self._partition()
        table = self._lookup_table.packed
        (table[first:] if first else table).take(self._indices, out=pixels, mode="wrap")

    def field(self) -> NDArray[np.uint8]:
        """The field, (lines, elements, 3) uint8: red, green, blue."""
        pixels = np.empty((self.lines, self.elements), "<u4")
        self.scan_out_into(pixels)
        return pixels.view(np.uint8).reshape(self.lines, self.elements, 4)[:, :, 2::-1].copy()

    def _partition(self) -> int:
        part = self._words
        return self._lookup_table.addressed_entry // part * part if part < self._lookup_table.size else 0
