"""The test pattern: a stream of instructions for a display of any configuration.

It shows color bars, ramps through gray, the hues, red, green and blue, sixteen steps of gray, a grid to check
the raster, circles to check the geometry, and the characters.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Colors, Words
from ramtek_emu.configuration import GMR_9300, Configuration, EntryFormat

BARS: Final = (
    (255, 255, 255), (255, 255, 0), (0, 255, 255), (0, 255, 0),
    (255, 0, 255), (255, 0, 0), (0, 0, 255), (0, 0, 0),
)  # fmt: skip
FIRST_BAR: Final = 1
"""The word of the first bar; the words of the other bars follow."""
GROUND: Final = 9
GRID: Final = 10
LABEL: Final = 11
"""The word of letters, circles and the border."""
SHADE: Final = 12
"""The word behind the letters."""
FIRST_RAMP: Final = 3
"""The eighth of the words that is the first ramp; the last four eighths are the other ramps."""


def pattern(configuration: Configuration = GMR_9300) -> Words:
    """The pattern as a stream of words for a host port."""
    short = configuration.entry_format is EntryFormat.WORD_12
    return instructions.concatenate(
        instructions.reset(),
        instructions.load_entries(0, colors(configuration), configuration.entries, short),
        instructions.park_table(),
        instructions.write_image(picture(configuration)),
        circle_outline(configuration),
        labels(configuration),
    )


def eighth(configuration: Configuration) -> int:
    """An eighth of the number of words that select different entries."""
    return min(configuration.entries, configuration.largest_word + 1) // 8


def colors(configuration: Configuration) -> Colors:
    """The entries of the pattern, (words in use, 3): the bars, and ramps of an eighth of the words each."""
    count = eighth(configuration)
    rising = np.linspace(0, 1, count)[:, np.newaxis]
    turn = np.arange(count)[:, np.newaxis] / count * 6
    hues = np.clip(np.abs(np.add(turn, (0, 4, 2)) % 6 - 3) - 1, 0, 1)
    ramps = rising * (1, 1, 1), hues, rising * (1, 0, 0), rising * (0, 1, 0), rising * (0, 0, 1)
    table = np.zeros((8 * count, 3), np.uint8)
    table[FIRST_RAMP * count :] = (np.concatenate(ramps) * 255).round()
    table[FIRST_BAR : FIRST_BAR + len(BARS)] = BARS
    table[[GROUND, GRID, LABEL, SHADE]] = (26, 30, 38), (66, 76, 92), (255, 255, 255), (12, 14, 18)
    return table


def disc(configuration: Configuration) -> tuple[int, int, int]:
    """The disc of bars and ramps: element and line of its center, and its radius."""
    width, height = configuration.shown_elements, configuration.shown_lines
    return width // 2, height // 2, min(width, height) * 5 // 12


def picture(configuration: Configuration) -> Words:
    """The words of background, grid and disc, (lines, elements)."""
    width, height = configuration.shown_elements, configuration.shown_lines
    center, middle, radius = disc(configuration)
    lines, elements = np.arange(height)[:, np.newaxis] - middle, np.arange(width) - center

    # Fill the disc with rows: bars, ramps, and steps of gray, which should be clearly distinct.
    count, across = eighth(configuration), np.clip(elements / (2 * radius) + 0.5, 0, 0.9999)
    ramps = [FIRST_RAMP * count + (number + across) * count for number in range(5)]
    steps = FIRST_RAMP * count + (across * 16).astype(int) * (count - 1) / 15 + 0.5
    rows = np.array([FIRST_BAR + across * len(BARS), *ramps, steps]).astype(np.uint16)
    ends = np.array([-4, -1, 2, 4, 6, 8]) * radius // 12
    filled = rows[np.searchsorted(ends, lines[:, 0], side="right")]

    step = max(2, min(width, height) // 12)
    is_grid = (lines % step == 0) | (elements % step == 0)
    is_inside = lines**2 + elements**2 < radius**2
    words = np.where(is_inside, filled, np.where(is_grid, GRID, GROUND)).astype(np.uint16)
    words[[0, -1]] = words[:, [0, -1]] = LABEL
    return words


def circle_outline(configuration: Configuration) -> Words:
    """The vectors of the outline of the disc, and of a small circle in each corner."""
    center, middle_line, radius = disc(configuration)
    width, height = configuration.shown_elements, configuration.shown_lines
    small = min(width, height) // 12
    around = np.linspace(0, 2 * np.pi, 181)
    unit = np.stack((np.cos(around), np.sin(around)), axis=1)
    circles = [(center, middle_line, radius), (center, middle_line, radius + 1)]
    circles += [
        (e, n, small) for e in (small + 8, width - small - 9) for n in (small + 8, height - small - 9)
    ]
    vertices = (np.floor(unit * size + (element, line) + 0.5) for element, line, size in circles)
    outlines = (instructions.write_vectors(each.astype(np.int64), LABEL) for each in vertices)
    return instructions.concatenate(*outlines)


def labels(configuration: Configuration) -> Words:
    """The instructions that write the name of the configuration, its sizes and the characters."""
    center, middle_line, radius = disc(configuration)
    width, height = configuration.shown_elements, configuration.shown_lines
    title = f" {configuration.name.replace('_', ' ')} "
    sizes = f" {width} x {height} x {configuration.planes}   {configuration.entries} ENTRIES "
    rows = [(title, middle_line - radius * 9 // 12, 2), (sizes, middle_line - radius * 9 // 12 + 22, 1)]
    characters = "".join(map(chr, range(32, 127)))
    rows += [(characters[:48], height - 27, 1), (characters[48:], height - 16, 1)]
    return instructions.concatenate(
        *(
            instructions.write_text(text, center - len(text) * 7 * size // 2, line, LABEL, SHADE, size)
            for text, line, size in rows
        )
    )
