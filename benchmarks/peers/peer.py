"""What a peer is: another renderer that makes the same picture, as well as it can."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Protocol

from autocolor import Scene
from benchmarks.comparison import Field

THREADS = 2
"""How many threads a peer that renders with several may have."""


class AbsentError(Exception):
    """A peer that can't take part; the text says why, and what would help."""


class Peer(Protocol):
    """Another renderer with a scene in it.

    `description` says what it is and how it renders. `edits` has for each edit that is timed what shows the
    edited scene; it returns when the pixels are rendered, and may count on nothing else being changed. A peer
    that begins again for any edit has only the frame. One that `is_slow` has fewer rounds, after the others.
    """

    description: str
    edits: Mapping[str, Callable[[Scene], object]]
    is_slow: bool

    def field(self) -> Field:
        """The pixels that were rendered last, (lines, elements, 3) uint8, linear in intensity."""
        ...


def on_llvmpipe(renderer: str) -> str:
    """What OpenGL renders with, for a description; AbsentError where that is no processor."""
    if "llvmpipe" not in renderer:
        raise AbsentError(
            f"OpenGL must render with llvmpipe, not {renderer}; install Mesa's software renderer"
        )
    return f"{renderer}, {os.environ.get('LP_NUM_THREADS', 'all')} threads"
