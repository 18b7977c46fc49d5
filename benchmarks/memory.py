"""How much memory this process holds at most.

Not `ru_maxrss` where it can be helped: on Linux that of a fresh process begins at the peak of the one that
started it, so that a small process started by a large one seems to need nothing.
"""

from __future__ import annotations

import resource
import sys
from pathlib import Path

STATUS = Path("/proc/self/status")
CLEAR = Path("/proc/self/clear_refs")
PEAK = "5"
"""What is written to `clear_refs` to bring the peak down to what is held (proc(5))."""


def peak() -> float:
    """The most memory that this process held at a time, in MiB."""
    if STATUS.exists():
        for line in STATUS.read_text(encoding="ascii", errors="replace").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


def forget_peak() -> None:
    """Count the peak anew from what is held now, where the system can do that."""
    if CLEAR.exists():
        CLEAR.write_text(PEAK, encoding="ascii")
