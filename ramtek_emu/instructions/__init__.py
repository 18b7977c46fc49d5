"""Encoders for hosts: each returns the words of an instruction, or of several if one is too short.

A host calls them by these names, `instructions.write_text(...)`; each is in the room of its subject. Uses the
basic modules and instruction_set.
"""

from __future__ import annotations

from ramtek_emu.instructions.cursors import read_cursor as read_cursor
from ramtek_emu.instructions.cursors import write_cursor as write_cursor
from ramtek_emu.instructions.images import erase as erase
from ramtek_emu.instructions.images import read_image as read_image
from ramtek_emu.instructions.images import write_image as write_image
from ramtek_emu.instructions.settings import initialize as initialize
from ramtek_emu.instructions.settings import no_operation as no_operation
from ramtek_emu.instructions.settings import reset as reset
from ramtek_emu.instructions.settings import set_parameters as set_parameters
from ramtek_emu.instructions.settings import zoom as zoom
from ramtek_emu.instructions.shapes import fill as fill
from ramtek_emu.instructions.shapes import write_circles as write_circles
from ramtek_emu.instructions.streams import concatenate as concatenate
from ramtek_emu.instructions.table import load_entries as load_entries
from ramtek_emu.instructions.table import load_short_entries as load_short_entries
from ramtek_emu.instructions.table import park_table as park_table
from ramtek_emu.instructions.table import read_entries as read_entries
from ramtek_emu.instructions.text import write_text as write_text
from ramtek_emu.instructions.vectors import write_segments as write_segments
from ramtek_emu.instructions.vectors import write_vectors as write_vectors
