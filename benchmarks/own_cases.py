"""The cases on this renderer and its display: the edits of the comparison, and what else targets name."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count, cycle

import numpy as np

import autocolor
from autocolor import Scene
from benchmarks.cases import Case
from benchmarks.comparison import ELEMENTS, LINES
from benchmarks.points import ALL_LIGHTS, FRAME, ONE_LIGHT, RECOLOR, STEP, Session
from ramtek_emu import Ramtek9300, instructions

COPY, SCAN_OUT = "copy of one field", "scan-out"
FIRST_RECOLOR = "first recolor after other words"
ENTRIES, STREAM = "entries of a surface, sent", "words of a picture, sent"
IMAGE, SMOOTH_IMAGE = "from rendering to an image", "from rendering to a smooth image"
INTENSITY, EXPONENT, MAPPING = "a light's intensity", "a surface's exponent", "mapping curve"


def own_cases(scene: Scene) -> Iterator[Case]:
    """The cases on a scene.

    Those of edits end with the words in the frame buffer, and those of a frame, of all lights and of a
    recoloring with the field that is scanned out after it.
    """
    session = Session(scene, LINES)
    copy = np.zeros((LINES, ELEMENTS), np.uint32)
    lamp, steps = scene.lights[0].name, count(1 + STEP, STEP)
    exponents = cycle([scene.surfaces[0].reflectance.exponent + 1, scene.surfaces[0].reflectance.exponent])
    # Curves are changed in a studio of their own: no other case is to pay for a curve, for no peer has any.
    mapped, curves = autocolor.Studio(scene, Ramtek9300()), cycle(["gamma", "linear"])
    levels = session.studio.level_ranges[scene.surfaces[0].name]
    body = slice(levels.first, levels.first + levels.levels)

    def entries() -> None:
        session.display.send(instructions.load_entries(body.start, session.studio.entries[body]))

    def words() -> None:
        session.display.send(instructions.write_image(session.studio.words))

    def scan_out() -> None:
        session.display.scan_out.scan_out_into(session.field)

    def first() -> None:
        words()
        session.scan_out()

    def frame() -> None:
        session.frame()
        session.scan_out()

    def all_lights() -> None:
        session.all_lights()
        session.scan_out()

    yield Case(COPY, lambda: np.copyto(copy, session.field))
    # What a scan-out owes to words that were written before it is not its own.
    yield Case(SCAN_OUT, scan_out, session.scan_out)
    # The whole table is made only when somebody asks for it.
    yield Case(ENTRIES, entries, lambda: session.studio.entries)
    yield Case(STREAM, words)
    # As while a color is dragged: only the first recoloring after other words looks for the surface's lines.
    yield Case(FIRST_RECOLOR, session.recolor, first)
    yield Case(RECOLOR, session.recolor, session.recolor)
    yield Case(MAPPING, lambda: mapped.edit(scene.replace(mapping=next(curves))))
    yield Case(
        INTENSITY, lambda: session.studio.light(lamp, intensity=next(steps) * scene.lights[0].intensity)
    )
    yield Case(EXPONENT, lambda: session.studio.surface(scene.surfaces[0].name, exponent=next(exponents)))
    yield Case(ONE_LIGHT, session.one_light)
    yield Case(ALL_LIGHTS, all_lights)
    yield Case(FRAME, frame)
    yield Case(IMAGE, lambda: autocolor.image(scene, smooth=1))
    yield Case(SMOOTH_IMAGE, lambda: autocolor.image(scene))
