"""Slow, obvious twins of the display: one pixel, one word at a time."""

from __future__ import annotations

from ramtek_emu.instruction_set.table import FORMATS

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

Raster = list[list[int]]
Place = tuple[int, int]


def inside(place: Place, window: tuple[int, int, int, int]) -> bool:
    left, top, right, bottom = window
    return left <= place[0] <= right and top <= place[1] <= bottom


def corner(window: tuple[int, int, int, int], code: int) -> Place:
    left, top, right, bottom = window
    step, run = STEPS[code]
    return (right if -1 in (step[0], run[0]) else left, bottom if -1 in (step[1], run[1]) else top)


def walk(
    window: tuple[int, int, int, int], code: int, start: Place, count: int, pairs: bool = False
) -> list[Place]:
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


def rooms(window: tuple[int, int, int, int], code: int) -> tuple[int, int]:
    """The number of words in a run, and the number of runs."""
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    return (width, height) if STEPS[code][0][0] else (height, width)


def away(place: Place, window: tuple[int, int, int, int], code: int) -> tuple[int, int]:
    """Steps along and across from the first corner; negative before the corner."""
    first, (step, run) = corner(window, code), STEPS[code]
    across, down = place[0] - first[0], place[1] - first[1]
    return across * step[0] + down * step[1], across * run[0] + down * run[1]


def write_scan(
    raster: Raster,
    window: tuple[int, int, int, int],
    code: int,
    start: Place,
    words: list[int],
    mask: int,
    clip: tuple[int, int, int, int],
    pairs: bool = False,
) -> Place:
    places = walk(window, code, start, len(words), pairs)
    for (element, line), word in zip(places, words, strict=False):
        if 0 <= line < len(raster) and 0 <= element < len(raster[0]) and inside((element, line), clip):
            raster[line][element] = (raster[line][element] & ~mask) | (word & mask)
    return places[-1]


def read_scan(
    raster: Raster,
    window: tuple[int, int, int, int],
    code: int,
    start: Place,
    count: int,
    pairs: bool = False,
) -> tuple[list[int], Place]:
    places = walk(window, code, start, count, pairs)
    words = [
        raster[line][element] if 0 <= line < len(raster) and 0 <= element < len(raster[0]) else 0
        for element, line in places[:-1]
    ]
    return words, places[-1]


def field(words: Raster, entries: list[tuple[int, int, int]]) -> list[list[tuple[int, int, int]]]:
    return [[entries[word] for word in line] for line in words]


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


def conic_places(coefficients: tuple[int, ...], most: int, start: Place, stop: Place | None) -> list[Place]:
    """The pixels of a conic: the next pixel is the nearest to the curve of the three neighbors ahead."""
    a, b, c, d, e = coefficients
    target = (0, 0) if stop is None else (stop[0] - start[0], stop[1] - start[1])

    def value(place: Place) -> int:
        x, y = place
        return a * x * x + b * y * y + c * x * y + d * x + e * y

    def away(place: Place) -> int:
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
        if stop is not None and was_away and away(here) <= 2 and away(there) >= away(here):
            break
        was_away = was_away or away(here) > 8
        here = there
        if stop is None and here == (0, 0):
            break
        places.append(here)
        if here == target:
            break
    return [(start[0] + x, start[1] + y) for x, y in places]


def write_pixel(raster: Raster, place: Place, word: int, mask: int, clip: tuple[int, int, int, int]) -> None:
    element, line = place
    if 0 <= line < len(raster) and 0 <= element < len(raster[0]) and inside(place, clip):
        raster[line][element] = (raster[line][element] & ~mask) | (word & mask)


def write_text(
    raster: Raster,
    shapes: list[list[list[bool]]],
    codes: bytes,
    window: tuple[int, int, int, int],
    code: int,
    start: Place,
    style: tuple[tuple[int, int], tuple[int, int], tuple[int, int]],
    words: tuple[int, int | None],
    mask: int,
    clip: tuple[int, int, int, int],
) -> Place:
    """The place behind the last cell that was written."""
    (dots_along, dots_across), (space_along, space_across), (along, across) = style
    step, run = STEPS[code]
    first = corner(window, code)
    room_along, room_across = rooms(window, code)
    inner, outer = away(start, window, code)

    def place(i: int, j: int) -> Place:
        return (first[0] + i * step[0] + j * run[0], first[1] + i * step[1] + j * run[1])

    for character in codes:
        if inner > 0 and inner + dots_along * along > room_along:
            below = outer + (dots_across + space_across) * across
            if below > 0 and below + dots_across * across > room_across:
                break
            inner, outer = 0, below
        for j in range(dots_across * across):
            for i in range(dots_along * along):
                word = words[0] if shapes[character][j // across][i // along] else words[1]
                if word is not None:
                    write_pixel(raster, place(inner + i, outer + j), word, mask, clip)
        inner += (dots_along + space_along) * along
    return place(inner, outer)


OPERAND_WORDS = (
    (1, 1, 1, 2, 2, 2, 4, 1, 2, 2, 1, 1, 6, 1, 1, 2),
    (1, 4, 2, 2, 1, 1),
)


def split(stream: list[int]) -> list[list[int]]:
    """The words of the whole instructions of a stream, read word by word; illegal words are joined."""
    formats = {format.opcode: format for format in FORMATS}
    was_illegal = False
    parts: list[list[int]] = []
    words = iter(stream)
    while True:
        part: list[int] = []

        def take(count: int, part: list[int] = part) -> int:
            for _ in range(count):
                part.append(next(words))
            return part[-1] if part else 0

        try:
            first = take(1)
            format = formats.get(first >> 8)
            if format is not None and format.fixed is not None:
                for name in format.fixed:
                    value = take(1)
                    if name == "length" and not format.replies:
                        take((value + 1) // 2)
            elif format is not None:
                flag_words = [take(1) if first & flag else 0 for flag in (2, 4)]
                head = part.copy()
                following = sum(
                    count
                    for flag_word, counts in zip(flag_words, OPERAND_WORDS, strict=True)
                    for bit, count in enumerate(counts)
                    if flag_word & 1 << bit
                )
                if format.requests_operands:
                    following = 0
                elif format.name == "WC" and flag_words[0] & 1 << 12:
                    # Twelve coefficients, unless the word after six is 4 and would be an upper half.
                    before = sum(
                        count for bit, count in enumerate(OPERAND_WORDS[0][:13]) if flag_words[0] & 1 << bit
                    )
                    take(following)
                    following = 6
                    if first & 1 and len(part) - len(head) - before in (0, 2, 4):
                        if take(1) == 4:
                            take(2)
                            parts.append(part)
                            was_illegal = False
                            continue
                        following = 5
                take(following)
                if first & 1:
                    length = take(1)
                    if not format.replies:
                        take((length + 1) // 2)
        except StopIteration:
            return parts
        if format is None and was_illegal:
            parts[-1] += part
        else:
            parts.append(part)
        was_illegal = format is None
