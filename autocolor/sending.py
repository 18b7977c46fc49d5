"""Sending: the instructions that show a display image, or its differences from the image before."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import printable, shown
from autocolor.errors import InputError, UsageError
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.legend import GROUND, INK, Legend, legend
from autocolor.mapping.ranges import WORDS
from ramtek_emu import GMR_9300, Configuration, EntryFormat, HostPort, Ramtek9300, instructions

EntryEncoder = Callable[[int, Bytes], Words]
"""Encodes the instruction that loads entries, (n, 3) uint8, from a first entry on."""


def configuration_of(display: HostPort) -> Configuration:
    """The configuration of a display; GMR_9300, the paper's display, for a host port without a configuration.

    Raises UsageError for a value that is no host port, and for a display with too few words or entries for
    the level ranges.
    """
    if isinstance(display, type) or not callable(getattr(display, "send", None)):
        raise UsageError(
            "a display must be a host port, such as Ramtek9300(), or TcpPort(address) for one elsewhere, not"
            f" {shown(display)}"
        )
    configuration: Configuration = getattr(display, "configuration", GMR_9300)
    if configuration.largest_word < WORDS - 1 or configuration.entries < WORDS:
        raise UsageError(
            f"a display for a studio must have {WORDS} words and entries, not"
            f" {configuration.largest_word + 1} and {configuration.entries} ({configuration.name}); choose"
            " another configuration"
        )
    return configuration


def encoder_of_entries(display: HostPort) -> EntryEncoder:
    """The function that encodes a load of entries, from a first entry on, in the display's format."""
    short = configuration_of(display).entry_format is EntryFormat.WORD_12
    return partial(instructions.load_entries, short=short)


def send_image(display: HostPort, image: DisplayImage, before: DisplayImage | None = None) -> None:
    """Send the entries and words that differ from `before`; without `before`, a reset and everything.

    The legend is drawn over the words. If the legend changes, the words are sent again, too.
    """
    encode = encoder_of_entries(display)
    if before is None:
        display.send(instructions.reset())
    for first, entries in [(0, image.entries)] if before is None else image.loads_after(before):
        display.send(encode(first, entries))
    key = legend(image)
    if before is None or before.words is not image.words or key != legend(before):
        display.send(instructions.write_image(image.words))
        if key is not None:
            display.send(drawn_legend(key))


def shown_words(image: DisplayImage) -> Words:
    """The words of an image with its legend, (lines, elements) uint16, as on a display of its size."""
    if legend(image) is None:
        return image.words
    lines, elements = image.words.shape
    display = Ramtek9300(dataclasses.replace(GMR_9300, lines=lines, elements=elements))
    send_image(display, image)
    return display.words


def shown_colors(image: DisplayImage) -> Bytes:
    """The colors of an image with its legend, (lines, elements, 3) uint8, as on a display of its size."""
    return image.entries.take(shown_words(image), axis=0)


def drawn_legend(key: Legend) -> Words:
    """The instructions that draw a legend."""
    areas = [instructions.erase(swatch[:4], swatch.word) for swatch in key.swatches]
    texts = [
        instructions.write_text(printable(each.text), each.left, each.top, INK, GROUND) for each in key.labels
    ]
    drawn: Words = np.concatenate([*areas, *texts])
    return drawn


def send_cycle(display: HostPort, images: Iterable[DisplayImage]) -> None:
    """Send a picture and then one load of the table for each image, the first included.

    After the k-th load the display shows the k-th image: color cycling, as programs of the time did it. A
    load has the entries from the first to the last that differ, and entry 0 if none differs, so that loads
    are in step with images. The words come before the first load, because a display that plays a recording
    waits before each load. Raises InputError if an image has other words than the first, or another legend.
    """
    encode = encoder_of_entries(display)
    first: DisplayImage | None = None
    shown_entries: Bytes | None = None
    for number, image in enumerate(images, 1):
        if first is None:
            first = image
            display.send(instructions.reset())
            display.send(instructions.write_image(image.words))
            if (key := legend(image)) is not None:
                display.send(drawn_legend(key))
        elif not (image.words is first.words or np.array_equal(image.words, first.words)):
            raise InputError(f"frame {number}: it must have the words of the first frame, not others")
        elif legend(image) != legend(first):
            raise InputError(f"frame {number}: it must have the legend of the first frame, not another")
        differing = np.arange(len(image.entries))
        if shown_entries is not None:
            differing = np.flatnonzero((shown_entries != image.entries).any(axis=1))
        start, end = (int(differing[0]), int(differing[-1])) if len(differing) else (0, 0)
        display.send(encode(start, image.entries[start : end + 1]))
        shown_entries = image.entries
