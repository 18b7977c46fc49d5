"""Shapes of our own that a bare mesh is judged by, each as a `Mesh`; no file is needed for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from autocolor import Mesh
from benchmarks.shapes import curved, flat


class Shape(NamedTuple):
    """A mesh; `is_curved` tells whether most of what is seen of it is curved."""

    mesh: Mesh
    is_curved: bool


FLAT: dict[str, Callable[[], Mesh]] = {
    "cube": lambda: flat.box("cube", 1, 1, 1),
    "plate": lambda: flat.box("plate", 1.6, 1.2, 0.05),
    "bar": lambda: flat.box("bar", 4, 0.2, 0.2),
    "frame": flat.frame,
    "bracket": flat.bracket,
    "open box": flat.open_box,
    "stairs": flat.stairs,
    "prism 8": lambda: flat.prism("prism 8", 8),
    "prism 12": lambda: flat.prism("prism 12", 12),
    "gear": flat.gear,
    "icosahedron": flat.icosahedron,
    "two scales": flat.two_scales,
}
CURVED: dict[str, Callable[[], Mesh]] = {
    "tube": curved.tube,
    "cylinder": curved.cylinder,
    "cone": curved.cone,
    "sphere": curved.sphere,
    "torus": curved.torus,
    "blob": curved.blob,
    "saddle": curved.saddle,
    "waves": curved.waves,
}


def shapes() -> dict[str, Shape]:
    """Every shape by its name."""
    return {name: Shape(make(), is_curved=name in CURVED) for name, make in (FLAT | CURVED).items()}
