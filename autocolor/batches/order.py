"""The order in which variants are made: each costs only the edit from the variant before it.

Variants that see the same points are made one after the other, among them those with the same light, and so
on down to recolorings: a grid of views, lights and paints renders each view once and lights each view once
for all paints. The order is cut into runs, which different processes can make.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

from autocolor.batches.table import Variant
from autocolor.errors import UsageError
from autocolor.files.settings import field_of, place_of
from autocolor.scene.columns import Tier
from autocolor.scene.scene import Scene


def runs_of(scene: Scene, variants: Sequence[Variant], most: int) -> list[list[int]]:
    """The numbers of all variants, from 0, in runs of at most `most`, in the order to make them.

    Variants of one frame share as few runs as possible, and several small frames share a run.
    """
    columns = _columns(scene, variants)
    dear = [ranks for tier, ranks in columns if tier is not Tier.ENTRIES]
    frames = [ranks for tier, ranks in columns if tier is Tier.FRAME]
    # Sorting is stable: recolorings stay in the order of their table.
    numbers = sorted(range(len(variants)), key=lambda number: [ranks[number] for ranks in dear])
    runs: list[list[int]] = [[]]
    for _, members in groupby(numbers, key=lambda number: [ranks[number] for ranks in frames]):
        frame = list(members)
        if len(runs[-1]) + len(frame) > most and runs[-1]:
            runs.append([])
        pieces = cut(frame, most)
        runs[-1].extend(pieces[0])
        runs.extend(pieces[1:])
    return [run for run in runs if run]


def cut(numbers: Sequence[int], most: int) -> list[list[int]]:
    """Consecutive runs of at most `most` numbers, whose lengths differ by at most 1.

    >>> cut([0, 1, 2, 3, 4], 4)
    [[0, 1, 2], [3, 4]]
    """
    count = max(1, -(-len(numbers) // most))
    ends = [len(numbers) * place // count for place in range(count + 1)]
    # The longer runs are the first.
    ends = [len(numbers) - end for end in reversed(ends)]
    return [list(numbers[start:end]) for start, end in pairwise(ends)]


def _columns(scene: Scene, variants: Sequence[Variant]) -> list[tuple[Tier, list[int]]]:
    """For each key that variants set, from dear to cheap: its tier, and the rank of its value by variant.

    Values are ranked by their first occurrence; the rank of an absent value is 0.
    """
    columns = []
    for key in dict.fromkeys(key for variant in variants for key in variant.settings):
        values = [repr(each.settings[key]) if key in each.settings else "" for each in variants]
        ranks = {value: rank for rank, value in enumerate(dict.fromkeys(["", *values]))}
        columns.append((tier_of(scene, key), [ranks[value] for value in values]))
    return sorted(columns, key=lambda column: -column[0])


def tier_of(scene: Scene, key: str) -> Tier:
    """What an edit of a key's field costs at most; NOTHING for a key that no variant can set."""
    try:
        field = field_of(place_of(scene, key))
    except UsageError:
        return Tier.NOTHING
    return Tier.NOTHING if field is None else field.tier
