"""Inspection: a display after any instruction of a stream, and the instructions that wrote a pixel.

Uses the basic modules, instruction_set, memory, display, host and monitor. The display does not know it.
Scripts use the names below: a `Replay` of a `Stream` goes to any instruction, `first_difference` compares two
streams, and the searches say which instructions wrote a word or an entry. `finished` runs a search whole.
"""

from __future__ import annotations

from ramtek_emu.inspection.differences import Difference as Difference
from ramtek_emu.inspection.differences import first_difference as first_difference
from ramtek_emu.inspection.histories import EntryRange as EntryRange
from ramtek_emu.inspection.histories import Write as Write
from ramtek_emu.inspection.histories import finished as finished
from ramtek_emu.inspection.histories import history_of as history_of
from ramtek_emu.inspection.histories import last_change as last_change
from ramtek_emu.inspection.histories import next_change as next_change
from ramtek_emu.inspection.replay import Replay as Replay
from ramtek_emu.inspection.stream import Stream as Stream
from ramtek_emu.memory.scan_orders import Window as Window
