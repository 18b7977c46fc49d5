"""Configuration: the sizes and formats of a display, and the displays that the sources describe."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from operator import index
from typing import Final

from ramtek_emu.errors import ConfigurationError
from ramtek_emu.timing import Timing


class EntryFormat(Enum):
    """How the host sends an entry of the lookup table."""

    PAIR_24 = "two words an entry: green << 8 | blue, then red"
    """Hardware: JPL, NCAR."""
    WORD_12 = "one word an entry: red << 8 | green << 4 | blue, four bits each"
    """Hardware: LIN, BTL."""


KINDS: Final = {
    "name": str, "entry_format": EntryFormat, "extended": bool, "monochrome": bool, "timing": Timing | None,
}  # fmt: skip
"""The types of the fields that hold no whole number."""


@dataclass(frozen=True, kw_only=True)
class Configuration:
    """The sizes of a display. The part of the memory that is shown starts at line 0, element 0."""

    name: str
    elements: int
    lines: int
    planes: int
    visible_elements: int | None = None
    visible_lines: int | None = None
    entries: int = 1024
    entry_format: EntryFormat = EntryFormat.PAIR_24
    extended: bool = True
    """Whether the display has the instructions of the 9400/9460 and the second operand flag word."""
    cursors: int = 2
    monochrome: bool = False
    """Whether the monitor is black and white; it then shows the low eight bits of an entry."""
    timing: Timing | None = None
    """How long everything takes; None means that no time passes."""

    def __post_init__(self) -> None:
        for name, kind in KINDS.items():
            if not isinstance(getattr(self, name), kind):
                words = getattr(kind, "__name__", "Timing or None")
                raise ConfigurationError(
                    f"{name} of a display must be {words}, not {getattr(self, name)!r}; choose another value"
                )
        limits = {"elements": (1, 4096), "lines": (1, 4096), "planes": (1, 16), "cursors": (0, 8)}
        limits |= {"visible_elements": (1, self.elements), "visible_lines": (1, self.lines)}
        limits["entries"] = (256, 4096)
        for name, (least, most) in limits.items():
            size = getattr(self, name)
            if size is None and name in ("visible_elements", "visible_lines"):
                continue
            # Sizes may be numbers of numpy.
            if isinstance(size, bool) or not hasattr(size, "__index__") or not least <= size <= most:
                raise ConfigurationError(
                    f"{name} of {self.name} must be a whole number from {least} to {most}, not {size!r}; "
                    "choose another size"
                )
            object.__setattr__(self, name, index(size))
        if self.entries & (self.entries - 1):
            raise ConfigurationError(
                f"entries of {self.name} must be a power of 2, not {self.entries}; choose another size"
            )

    @property
    def shown_elements(self) -> int:
        """How many elements of a line the screen shows, without zoom."""
        return self.elements if self.visible_elements is None else self.visible_elements

    @property
    def shown_lines(self) -> int:
        """How many lines the screen shows, without zoom."""
        return self.lines if self.visible_lines is None else self.visible_lines

    @property
    def largest_word(self) -> int:
        """The largest word of a pixel: every plane is set."""
        return (1 << self.planes) - 1


GMR_9300: Final = Configuration(name="GMR_9300", elements=640, lines=480, planes=10, extended=False)
"""The display of the paper. It takes what a 9300 takes.

Hardware: GM, 640 x 480 words of ten bits, one parallel table of 1024 x 24 bits.
Assumed: the table takes the word pairs of the 9460, the same family and the same number of entries; no source
shows a 9300 with a 24-bit table. It has two cursors, as Princeton's.
"""

FAMILY: Final = Configuration(name="FAMILY", elements=640, lines=480, planes=10)
"""The display of the paper, with the second operand flag word and the instructions of the 9400 and 9460.

Departs: no display was built like FAMILY, which runs the programs of all displays with one size, ten planes
and a table of 24 bits.
"""

PRINCETON_9300: Final = Configuration(
    name="PRINCETON_9300",
    elements=640,
    lines=512,
    planes=10,
    entry_format=EntryFormat.WORD_12,
    extended=False,
)
"""The RM-9300 of Princeton University.

Hardware: LIN and PRG, 640 x 512 memory, 1024 entries of 12 bits, words of ten bits (cmap 3), cursors 0 and 1.
Its monitor was black and white (PRG introdoc); `princeton-9300-monochrome` is this display with such a one.
Assumed: all 640 elements are shown; the programs kept to 620, probably because the monitor cut the rest.
"""

JPL_9460: Final = Configuration(name="JPL_9460", elements=640, lines=480, planes=8)
"""The RM-9460 of the Jet Propulsion Laboratory, in its low resolution.

Hardware: JPL, 640 x 480, bytes for pixels, four sections of 256 entries of 24 bits, two cursors.
Assumed: eight planes, since its masks are FFh and its images bytes.
"""

NCAR_9460: Final = Configuration(name="NCAR_9460", elements=1280, lines=1024, planes=8, cursors=4)
"""The RM-9460 of the National Center for Atmospheric Research.

Hardware: NCAR and LONG, 1280 x 1024, bytes for pixels, 24-bit entries; LONG, cursors 0 to 3.
Assumed: eight planes, since its masks are FFh; four sections of 256 entries, as JPL's.
"""

CONFIGURATIONS: Final = {
    configuration.name: configuration
    for configuration in (GMR_9300, PRINCETON_9300, JPL_9460, NCAR_9460, FAMILY)
}
"""The displays above, by name."""


def checked_configuration(name: Configuration | str) -> Configuration:
    """One of the displays by its name, in upper or lower case; a configuration is returned as it is.

    A name with -monochrome after it is the display with a black-and-white monitor. ConfigurationError lists
    the names.

    >>> checked_configuration("princeton-9300-monochrome").monochrome
    True
    """
    if isinstance(name, Configuration):
        return name
    asked = str(name).upper().replace("-", "_")
    display = asked.removesuffix("_MONOCHROME")
    if display not in CONFIGURATIONS:
        names = ", ".join(sorted(CONFIGURATIONS))
        raise ConfigurationError(f"a configuration must be one of {names}, not {name!r}; choose one of them")
    configuration = CONFIGURATIONS[display]
    return configuration if display == asked else replace(configuration, monochrome=True)
