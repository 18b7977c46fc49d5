"""Every instruction's function: importing this module enters them all in the processor's table.

A new instruction is a row of the instruction set and one function in one of these rooms.
"""

from ramtek_emu import cursor_instructions as _cursor_instructions  # noqa: F401
from ramtek_emu import drawing_instructions as _drawing_instructions  # noqa: F401
from ramtek_emu import environment_instructions as _environment_instructions  # noqa: F401
from ramtek_emu import image_instructions as _image_instructions  # noqa: F401
from ramtek_emu import table_instructions as _table_instructions  # noqa: F401
from ramtek_emu.processor import EXECUTORS as EXECUTORS
