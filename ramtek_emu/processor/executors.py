"""The registry: importing this module enters the executors of all instructions in EXECUTORS.

A new instruction is one row of the instruction table and one function in one of these modules.
"""

from __future__ import annotations

from typing import Final

from ramtek_emu.processor import cursor_executors, drawing_executors, environment_executors, image_executors
from ramtek_emu.processor import image_executors as table_executors
from ramtek_emu.processor.processor import EXECUTORS as EXECUTORS

SUBJECTS: Final = (
    image_executors,
    drawing_executors,
    table_executors,
    cursor_executors,
    environment_executors,
)
"""The modules of the executors, one for each subject."""
