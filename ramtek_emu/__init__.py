"""An emulator of the RAMTEK RM-9300 raster display, driven by the 16-bit words that its programs sent.

What is modeled
    the instruction stream: one continuous stream of words, cut anywhere, with its sticky operands
    the instructions: instruction_set names their sources; if only a name is known, the words are skipped
    the frame buffer: planes behind a write mask, a write window, image windows, scan orders, bytes or words
    drawing: text, rasters, vectors with texture, points, conics, circles, areas, copies
    the video lookup table: 1024 parallel entries of 24 bits, or of 12; the section that is shown
    the characters: cells of 7 x 9 with dots that were drawn for this emulator; a host can load others
    cursors and the joystick unit: positions, shapes, blinking, TRACK and ENTER, over the field, not in memory
    scan-out: words through the table to a field of colors, with display origin and zoom; also black and white
    time, if the configuration has it: a beam, retrace, waiting (timing holds every rate; all are assumed)
    the status bits of the interface: illegal instruction, cursor interrupt

What is **not** modeled
    logical functions other than replacement, and write-enable offsets: no source tells what they do
    keyboard, tablet, display lists, matrices, detection, arcs, packed images: known by name only
    the alphanumeric overlay of the 9460: the words of its table go nowhere
    interlace, blanking levels, phosphor
    the UNIBUS registers: a host port of two methods stands for them
    interrupts: the request bits can be read, but nothing is interrupted
    the errors of a driver: PRG DRIVER.c resets the display at an open that finds it not ready, fails with EIO
        after an illegal instruction, and refuses a second open with EACCES; here a host waits in line

The parts of the package, each of which uses only those before it: the basic modules (errors, arrays, checks,
timing, configuration, writing, png, command_line), instruction_set, memory, drawing, video, processor,
instructions, display, host, monitor, conformance, snapshot, inspection, commands.

The sources are named by keys, such as LIN for Linton's C library of 1978. docs/SOURCES.md lists them with
their repositories, revisions and files.
"""

from __future__ import annotations

# Nothing is imported at once: a command can handle Ctrl+C only afterwards.
TYPE_CHECKING: Final = False
if TYPE_CHECKING:
    from typing import Final

    __version__: str
    from ramtek_emu.configuration import FAMILY as FAMILY
    from ramtek_emu.configuration import GMR_9300 as GMR_9300
    from ramtek_emu.configuration import JPL_9460 as JPL_9460
    from ramtek_emu.configuration import NCAR_9460 as NCAR_9460
    from ramtek_emu.configuration import PRINCETON_9300 as PRINCETON_9300
    from ramtek_emu.configuration import Configuration as Configuration
    from ramtek_emu.configuration import EntryFormat as EntryFormat
    from ramtek_emu.display import Ramtek9300 as Ramtek9300
    from ramtek_emu.errors import ColorsError as ColorsError
    from ramtek_emu.errors import ConfigurationError as ConfigurationError
    from ramtek_emu.errors import InstructionError as InstructionError
    from ramtek_emu.errors import ListingError as ListingError
    from ramtek_emu.errors import MissingInputError as MissingInputError
    from ramtek_emu.errors import NoScreenError as NoScreenError
    from ramtek_emu.errors import OutputError as OutputError
    from ramtek_emu.errors import OutputExistsError as OutputExistsError
    from ramtek_emu.errors import PortError as PortError
    from ramtek_emu.errors import RamtekError as RamtekError
    from ramtek_emu.errors import ReplyError as ReplyError
    from ramtek_emu.errors import SnapshotError as SnapshotError
    from ramtek_emu.errors import WordsError as WordsError
    from ramtek_emu.errors import WriteError as WriteError
    from ramtek_emu.host.port import HostPort as HostPort
    from ramtek_emu.host.port import Recorder as Recorder
    from ramtek_emu.host.port import TcpPort as TcpPort
    from ramtek_emu.host.port import UnixPort as UnixPort
    from ramtek_emu.memory.cursors import Joystick as Joystick
    from ramtek_emu.snapshot import read_snapshot as read_snapshot
    from ramtek_emu.snapshot import write_snapshot as write_snapshot
    from ramtek_emu.timing import Timing as Timing

_NAMES: Final = {
    "configuration": "Configuration EntryFormat FAMILY GMR_9300 JPL_9460 NCAR_9460 PRINCETON_9300",
    "display": "Ramtek9300",
    "errors": "ColorsError ConfigurationError InstructionError ListingError MissingInputError NoScreenError "
    "OutputError OutputExistsError PortError RamtekError ReplyError SnapshotError WordsError WriteError",
    "host.port": "HostPort Recorder TcpPort UnixPort",
    "memory.cursors": "Joystick",
    "snapshot": "read_snapshot write_snapshot",
    "timing": "Timing",
}
"""The public names of each module."""
_HOME: Final = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = list(_HOME)


def __getattr__(name: str) -> object:
    """A public name; its module is loaded when the name is first used.

    `__version__` is the version of the installed package, or `0+unknown` in a checkout that is not installed.
    """
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("autocolor")
        except PackageNotFoundError:
            return "0+unknown"
    from importlib import import_module

    if name == "instructions":
        # A module that is used whole: `ramtek_emu.instructions.write_text(...)`.
        return import_module(f"{__name__}.{name}")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value: object = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    own = [name for name in globals() if name.startswith("__") and name.endswith("__")]
    return sorted({*own, *__all__, "__version__"})
