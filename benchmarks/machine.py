"""What machine the numbers are from: they are worth nothing without it."""

from __future__ import annotations

import os
import platform
from importlib import metadata
from pathlib import Path

import numpy as np

CPU_INFORMATION = Path("/proc/cpuinfo")
PACKAGES = ("vtk", "moderngl", "matplotlib", "trimesh", "meshio")


def machine() -> dict[str, str | int]:
    """The processor, its cores and the versions of what is measured, as plain values."""
    found: dict[str, str | int] = {
        "processor": processor(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        "system": platform.platform(terse=True),
        "Python": platform.python_version(),
        "numpy": np.__version__,
    }
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found


def processor() -> str:
    """The name of the processor, as its maker or else the system gives it."""
    if CPU_INFORMATION.exists():
        for line in CPU_INFORMATION.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def heading() -> str:
    """The machine in one line."""
    found = machine()
    first = [str(found.pop("processor")), f"{found.pop('cores')} cores", str(found.pop("system"))]
    return ", ".join(first + [f"{name} {value}" for name, value in found.items()])
