"""The test pattern: a stream of instructions for a display of any configuration.

It shows color bars, ramps through gray, red, green, blue and the hues, a grid to check the raster, circles to
check the geometry, and the characters.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Colors, Indices, Words
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


FULL: Final = {
    "gray": (1, 1, 1), "red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1), "hue": (0, 4, 2),
}  # fmt: skip
"""The components of the brightest color of a ramp; of the hues, where they begin, in sixths of the circle."""


def pattern(configuration: Configuration = GMR_9300) -> Words:
    """The pattern as a stream of words for a host port."""
    parts = [instructions.reset(), load(configuration), instructions.write_image(picture(configuration))]
    parts += [circle_outline(configuration), labels(configuration)]
    return instructions.concatenate(*parts)


def words_in_use(configuration: Configuration) -> int:
    """The number of words that select different entries."""
    return min(configuration.entries, configuration.largest_word + 1)


def ramp_words(configuration: Configuration) -> dict[str, Indices]:
    """The words of the ramps: a quarter of the table for gray, and an eighth each for the other colors."""
    total = words_in_use(configuration)
    starts = {"gray": 2, "red": 4, "green": 5, "blue": 6, "hue": 7}
    return {
        name: np.arange(start * total // 8, (start + (2 if name == "gray" else 1)) * total // 8)
        for name, start in starts.items()
    }


def colors(configuration: Configuration) -> Colors:
    """The entries of the pattern, (words in use, 3)."""
    table = np.zeros((words_in_use(configuration), 3), np.uint8)
    table[FIRST_BAR : FIRST_BAR + len(BARS)] = BARS
    table[[GROUND, GRID, LABEL, SHADE]] = (26, 30, 38), (66, 76, 92), (255, 255, 255), (12, 14, 18)
    for name, words in ramp_words(configuration).items():
        turn = np.arange(len(words)) / len(words) * 6
        height = np.linspace(0, 1, len(words))[:, np.newaxis] * FULL[name]
        if name == "hue":
            height = np.clip(np.abs((turn[:, np.newaxis] + FULL[name]) % 6 - 3) - 1, 0, 1)
        table[words] = (height * 255).round()
    return table


def load(configuration: Configuration) -> Words:
    """The instructions that load the entries, in the configuration's format."""
    short = configuration.entry_format is EntryFormat.WORD_12
    loaded = instructions.load_entries(0, colors(configuration), configuration.entries, short)
    return instructions.concatenate(loaded, instructions.park_table())


def disc(configuration: Configuration) -> tuple[int, int, int]:
    """The disc of bars and ramps: element and line of its center, and its radius."""
    width, height = configuration.shown_elements, configuration.shown_lines
    return width // 2, height // 2, min(width, height) * 5 // 12


def picture(configuration: Configuration) -> Words:
    """The words of background, grid and disc, (lines, elements)."""
    width, height = configuration.shown_elements, configuration.shown_lines
    center, middle_line, radius = disc(configuration)
    words = np.full((height, width), GROUND, np.uint16)
    step = max(2, min(width, height) // 12)
    words[middle_line % step :: step] = GRID
    words[:, center % step :: step] = GRID
    words[[0, -1]] = words[:, [0, -1]] = LABEL

    ramps = ramp_words(configuration)
    edges = [-12, -4, -1, 2, 4, 6, 8, 12]
    across = np.arange(width) - (center - radius)
    filled = np.zeros_like(words)
    bars = FIRST_BAR + np.clip(across * len(BARS) // (2 * radius), 0, len(BARS) - 1)
    rows: list[Indices] = [bars]
    for name in ("gray", "hue", "red", "green", "blue"):
        place = np.clip(across * len(ramps[name]) // (2 * radius), 0, len(ramps[name]) - 1)
        rows.append(ramps[name][place])
    # Show sixteen steps of gray at the bottom; they should be clearly distinct.
    rows.append(ramps["gray"][np.clip(across * 16 // (2 * radius), 0, 15) * (len(ramps["gray"]) - 1) // 15])
    for row, first, last in zip(rows, edges[:-1], edges[1:], strict=True):
        filled[middle_line + first * radius // 12 : middle_line + last * radius // 12] = row
    lines, elements = np.ogrid[:height, :width]
    inside = (lines - middle_line) ** 2 + (elements - center) ** 2 < radius * radius
    words[inside] = filled[inside]
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
