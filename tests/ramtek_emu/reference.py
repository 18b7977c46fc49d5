"""A slow, obvious twin of the display, from docs/RAMTEK.md: one pixel, one word at a time.

It knows all instructions that draw, write or reply, but no time, no field and no status register.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ramtek_emu import Configuration
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import OPERANDS
from ramtek_emu.memory.character_rom import characters

# Scan code -> step to the next word, step to the next run: (element, line) each.
STEPS = {
    0: ((1, 0), (0, 1)),
    1: ((-1, 0), (0, 1)),
    2: ((1, 0), (0, -1)),
    3: ((-1, 0), (0, -1)),
    4: ((0, 1), (1, 0)),
    5: ((0, -1), (1, 0)),
    6: ((0, 1), (-1, 0)),
    7: ((0, -1), (-1, 0)),
}
Place = tuple[int, int]


def signed(word: int) -> int:
    word &= 0xFFFF
    return word - 0x10000 if word & 0x8000 else word


def inside(place: Place, window: Sequence[int]) -> bool:
    left, top, right, bottom = window
    return left <= place[0] <= right and top <= place[1] <= bottom


def corner(window: Sequence[int], code: int) -> Place:
    left, top, right, bottom = window
    step, run = STEPS[code]
    return (right if -1 in (step[0], run[0]) else left, bottom if -1 in (step[1], run[1]) else top)


def rooms(window: Sequence[int], code: int) -> tuple[int, int]:
    """The number of words in a run, and the number of runs."""
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    return (width, height) if STEPS[code][0][0] else (height, width)


def away(place: Place, window: Sequence[int], code: int) -> tuple[int, int]:
    """Steps along and across from the first corner; negative before the corner."""
    first, (step, run) = corner(window, code), STEPS[code]
    across, down = place[0] - first[0], place[1] - first[1]
    return across * step[0] + down * step[1], across * run[0] + down * run[1]


def walk(window: Sequence[int], code: int, start: Place, count: int, pairs: bool = False) -> list[Place]:
    """The places of `count` words, or pixels in pairs, from `start` on, and the place after the last."""
    step, run = STEPS[code]
    first = corner(window, code)
    room_along, room_across = rooms(window, code)
    inner, outer = away(start, window, code)
    places = []
    for number in range(count + 1):
        # Counters compare with the far edges only, after whole pairs.
        if inner >= room_along and not (pairs and number % 2):
            inner, outer = 0, outer + 1
        if outer >= room_across:
            outer = 0
        places.append(
            (first[0] + inner * step[0] + outer * run[0], first[1] + inner * step[1] + outer * run[1])
        )
        inner += 1
    return places if count else [start]


def line_places(start: Place, end: Place) -> list[Place]:
    """The pixels of a line: at each step along the longer side, the nearest; ties go away from the start."""
    elements, lines = end[0] - start[0], end[1] - start[1]
    length = max(abs(elements), abs(lines))
    places = [start]
    for number in range(1, length + 1):
        offsets = []
        for delta in (elements, lines):
            whole, rest = divmod(abs(delta) * number, length)
            size = whole + (1 if 2 * rest >= length else 0)
            offsets.append(size if delta >= 0 else -size)
        places.append((start[0] + offsets[0], start[1] + offsets[1]))
    return places


def circle_places(radius: int) -> set[Place]:
    """The pixels nearest to a circle around 0, 0: by columns where it is flat, by rows where it is steep."""
    places = set()
    for across in range(-radius, radius + 1):
        down = math.floor(math.sqrt(radius * radius - across * across) + 0.5)
        if abs(across) <= down:
            places |= {(across, down), (across, -down), (down, across), (-down, across)}
    return places


def conic_places(coefficients: tuple[int, ...], most: int, start: Place, stop: Place | None) -> list[Place]:
    """The pixels of a conic: the next pixel is the nearest to the curve of the three neighbors ahead."""
    a, b, c, d, e = coefficients
    target = (0, 0) if stop is None else (stop[0] - start[0], stop[1] - start[1])

    def value(place: Place) -> int:
        x, y = place
        return a * x * x + b * y * y + c * x * y + d * x + e * y

    def apart(place: Place) -> int:
        return (place[0] - target[0]) ** 2 + (place[1] - target[1]) ** 2

    here = (0, 0)
    places = [here]
    was_away = False
    while len(places) < most:
        across, down = -(2 * b * here[1] + c * here[0] + e), 2 * a * here[0] + c * here[1] + d
        if (across, down) == (0, 0):
            break
        steep = abs(down) > abs(across)
        ahead = 1 if (down if steep else across) > 0 else -1
        aside = 1 if (across if steep else down) > 0 else -1
        neighbors = [
            (here[0] + shift, here[1] + ahead) if steep else (here[0] + ahead, here[1] + shift)
            for shift in (0, aside, -aside)
        ]
        there = min(neighbors, key=lambda place: abs(value(place)))
        if stop is not None and was_away and apart(here) <= 2 and apart(there) >= apart(here):
            break
        was_away = was_away or apart(here) > 8
        here = there
        if stop is None and here == (0, 0):
            break
        places.append(here)
        if here == target:
            break
    return [(start[0] + x, start[1] + y) for x, y in places]


class Twin:
    """A display that draws, writes and reads images; its words and replies are lists of numbers."""

    def __init__(self, configuration: Configuration) -> None:
        self.every_plane = configuration.largest_word
        self.size = configuration.elements, configuration.lines
        self.words = [[0] * self.size[0] for _ in range(self.size[1])]
        self.shapes = characters().tolist()
        self.replies: list[int] = []
        self.low = 0
        self.whole = (0, 0, self.size[0] - 1, self.size[1] - 1)
        self.p: dict[str, tuple[int, ...]] = {name: (0,) * row.words for name, row in OPERANDS.items()}
        self.p |= {"mask": (0xFFFF,), "read_mask": (0xFFFF,), "texture": (0xFFFF, 0), "dimensions": (7, 9)}
        self.p |= {"window": self.whole, "write_window": self.whole, "foreground": (self.every_plane,)}

    def send(self, instruction: Instruction) -> None:
        """Execute an instruction that draws or reads; SET and others only set their operands."""
        self.low, self.length = instruction.low_byte, instruction.length or 0
        self.data = instruction.data.tolist()
        self.take(dict(instruction.operands))
        getattr(self, instruction.format.name.lower(), list)()

    def take(self, operands: dict[str, tuple[int, ...]]) -> None:
        """Set operands. Windows and start points count from the base before the instruction."""
        base = self.base()
        for name, words in operands.items():
            if name in ("index_1", "index_2", "write_window", "conic"):
                self.p[name] = tuple(map(signed, words))
            elif name not in ("window", "start"):
                self.p[name] = words
        if "window" in operands:
            self.p["window"] = tuple(signed(word + base[n % 2]) for n, word in enumerate(operands["window"]))
            self.p["start"] = corner(self.p["window"], self.code)
        if "start" in operands:
            element, line = operands["start"]
            self.start = (base[0] + element, base[1] + line)

    @property
    def start(self) -> Place:
        element, line = self.p["start"]
        return signed(element), signed(line)

    @start.setter
    def start(self, place: Place) -> None:
        self.p["start"] = signed(place[0]), signed(place[1])

    @property
    def code(self) -> int:
        return self.p["scan_order"][0] & 7

    @property
    def colors(self) -> tuple[int, int]:
        pair = self.p["foreground"][0], self.p["background"][0]
        return (pair[1], pair[0]) if self.low & 0x10 else pair

    @property
    def window(self) -> tuple[int, ...] | None:
        left, top, right, bottom = self.p["window"]
        return None if right < left or bottom < top else self.p["window"]

    def base(self) -> Place:
        name = ("", "index_1", "index_2", "start")[self.low >> 6]
        element, line = self.p[name] if name else (0, 0)
        return element, line

    def placed(self, count: int = 2) -> list[tuple[int, ...]]:
        """The data as rows of numbers; the first two of each are a point in absolute coordinates."""
        whole = self.length // (2 * count) * count
        numbers, rows = [signed(word) for word in self.data[:whole]], []
        base = self.base()
        for first in range(0, whole, count):
            row = numbers[first : first + count]
            for point in range(0, count - 1, 2):
                row[point : point + 2] = signed(base[0] + row[point]), signed(base[1] + row[point + 1])
                base = (row[point], row[point + 1]) if self.low >> 6 == 3 else base
            rows.append(tuple(row))
        return rows

    def bytes(self) -> list[int]:
        order = "little" if self.low & 8 else "big"
        return [byte for word in self.data for byte in word.to_bytes(2, order)][: self.length]

    def get(self, place: Place) -> int:
        element, line = place
        return self.words[line][element] if inside(place, self.whole) else 0

    def put(self, place: Place, word: int | None) -> None:
        if word is not None and inside(place, self.whole) and inside(place, self.p["write_window"]):
            mask = self.p["mask"][0] & self.every_plane
            self.words[place[1]][place[0]] = self.get(place) & ~mask | word & mask

    def ers(self) -> None:
        for line in range(self.size[1]):
            for element in range(self.size[0]):
                if inside((element, line), self.p["window"]):
                    self.put((element, line), self.colors[1])

    def bers(self) -> None:
        before, self.p = self.p, self.p | {"window": self.whole, "write_window": self.whole}
        self.ers()
        self.p = before

    def scan(self, count: int, pairs: bool = False) -> list[Place]:
        """The places of so many words of the window; the operating point moves behind the last."""
        if self.window is None:
            return []
        *places, self.start = walk(self.window, self.code, self.start, count, pairs)
        return places

    def wi(self) -> None:
        pairs = bool(self.p["image_mode"][0] & 1)
        words = self.bytes() if pairs else self.data[: self.length // 2]
        for place, word in zip(self.scan(len(words), pairs), words, strict=False):
            self.put(place, word)

    def ri(self) -> None:
        pairs = bool(self.p["image_mode"][0] & 1)
        count = self.length if pairs else self.length // 2
        places = self.scan(count, pairs)
        words = [self.get(place) & self.p["read_mask"][0] for place in places] or [0] * count
        if pairs:
            row = [*words, 0][: count + count % 2]
            low, high = (0, 1) if self.low & 8 else (1, 0)
            words = [row[n + low] & 0xFF | (row[n + high] & 0xFF) << 8 for n in range(0, len(row), 2)]
        self.replies += words

    def wr(self) -> None:
        bits = [byte >> bit & 1 for byte in self.bytes() for bit in range(7, -1, -1)]
        for place, bit in zip(self.scan(len(bits)), bits, strict=False):
            self.dot(place, bool(bit))

    def dot(self, place: Place, is_one: bool) -> None:
        foreground, background = self.colors
        self.put(place, foreground if is_one else None if self.low & 0x20 else background)

    def line(self, start: Place, end: Place, before: int = 0) -> None:
        pattern, repeat = self.p["texture"]
        for number, place in enumerate(line_places(start, end)):
            bit = 15 - (before + number) // ((repeat & 15) + 1) % 16
            self.dot(place, bool(pattern >> bit & 1))

    def wvl(self) -> None:
        before = 0
        for element, line in self.placed():
            here, end = self.start, (element, line)
            self.line(here, end, before)
            before += max(abs(end[0] - here[0]), abs(end[1] - here[1]))
            self.start = end

    def wvu(self) -> None:
        for row in self.placed(4):
            self.line((row[0], row[1]), (row[2], row[3]))
            self.start = (row[2], row[3])

    def wpt(self) -> None:
        for element, line in self.placed():
            self.put((element, line), self.colors[0])
            self.start = (element, line)

    def wrp(self) -> None:
        for element, line, word in self.placed(3):
            self.put((element, line), word & 0xFFFF)
            self.start = (element, line)

    def circ(self) -> None:
        for element, line, radius in self.placed(3):
            self.start = (element, line)
            # Larger circles that begin near the memory have no pixel in it.
            for across, down in circle_places(radius & 0xFFFF) if radius & 0xFFFF < 1000 else ():
                self.put((element + across, line + down), self.colors[0])

    def wc(self) -> None:
        stop = next(((row[0], row[1]) for row in self.placed()), None)
        most = self.p["conic"][5]
        most = most if 0 < most < 1 << 14 else 1 << 14
        for element, line in conic_places(self.p["conic"][:5], most, self.start, stop):
            if (element, line) != (signed(element), signed(line)):
                break
            self.put((element, line), self.colors[0])
            self.start = (element, line)

    def wpb(self) -> None:
        step, axis = STEPS[self.code][0], int(self.code < 4)
        zero, jump = signed(self.p["base_line"][0]), signed(self.p["spacing"][0])
        for word in self.data[: self.length // 2]:
            value = signed(word)
            for number in range(max(1, self.p["dimensions"][0])):
                place = [self.start[0] + number * step[0], self.start[1] + number * step[1]]
                for place[axis] in range(max(min(zero, value), 0), min(max(zero, value), 99) + 1):
                    self.put((place[0], place[1]), self.colors[0])
            along = self.start[0] + jump * step[0], self.start[1] + jump * step[1]
            self.start = (along[0], value) if axis else (value, along[1])

    def fill(self) -> None:
        mask, foreground = self.p["read_mask"][0], self.colors[0]
        first, seed = self.start, self.get(self.start) & mask
        replaces = self.length >= 2 and self.data[0] != 0

        def is_open(place: Place) -> bool:
            word, until = self.get(place) & mask, foreground & self.every_plane & mask
            fits = word == seed if replaces else word != until
            return fits and inside(place, self.whole) and inside(place, self.p["write_window"])

        waiting = [first] if is_open(first) else []
        reached = set(waiting)
        while waiting:
            element, line = waiting.pop()
            for place in ((element + 1, line), (element - 1, line), (element, line + 1), (element, line - 1)):
                if place not in reached and is_open(place):
                    reached.add(place)
                    waiting.append(place)
        for place in reached:
            self.put(place, foreground)

    def copy(self) -> None:
        self.start = next(((row[0], row[1]) for row in self.placed()), self.start)
        first = corner(self.p["window"], self.code)
        across, down = self.start[0] - first[0], self.start[1] - first[1]
        copied = [
            ((element + across, line + down), self.words[line][element] & self.p["read_mask"][0])
            for line in range(self.size[1])
            for element in range(self.size[0])
            if inside((element, line), self.p["window"])
        ]
        for place, word in copied:
            self.put(place, word)

    def wt(self) -> None:
        dots_along, dots_across = (max(1, min(dots, 16)) for dots in self.p["dimensions"])
        scale = self.p["scale"][0]
        along, across = 1 + (scale & 15), 1 + (scale >> 8 & 15)
        step, run = STEPS[self.code]
        window: Sequence[int] | None = self.window
        if window is None:
            # Without a window there are no edges.
            element, line = self.start
            window = (element - 0xFFFF, line - 0xFFFF, element + 0xFFFF, line + 0xFFFF)
        first = corner(window, self.code)
        room_along, room_across = rooms(window, self.code)
        inner, outer = away(self.start, window, self.code)
        for code in self.bytes():
            if inner > 0 and inner + dots_along * along > room_along:
                below = outer + (dots_across + self.p["spacing"][1]) * across
                if below > 0 and below + dots_across * across > room_across:
                    break
                inner, outer = 0, below
            for j in range(dots_across * across):
                for i in range(dots_along * along):
                    row = self.shapes[code][j // across] if j // across < len(self.shapes[code]) else ()
                    a, b = inner + i, outer + j
                    place = first[0] + a * step[0] + b * run[0], first[1] + a * step[1] + b * run[1]
                    self.dot(place, i // along < len(row) and bool(row[i // along]))
            inner += (dots_along + self.p["spacing"][0]) * along
        self.start = first[0] + inner * step[0] + outer * run[0], first[1] + inner * step[1] + outer * run[1]
