"""The process in which a library reads a file: the only module that imports trimesh and meshio.

It is started as `python -m autocolor.files.meshes.foreign.worker LIBRARY FORMAT MESH RESULT SECONDS MEMORY
BYTES`. The limits of time, of memory and of the result are set by the system, and none can be raised again.
Once the library is loaded, this process opens no file but in the folder of the mesh and of Python, writes
none but the result, and has no network. What the library prints goes nowhere. Failures are written as the
result, after FAILED.
"""

from __future__ import annotations

import math
import mimetypes
import os
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from autocolor.files.meshes.foreign.foreign_mesh import (
    FAILED,
    LONGEST_SENTENCE,
    ForeignMesh,
    foreign_mesh_bytes,
)
from autocolor.files.meshes.foreign.meshio_cells import polygons_of_meshio
from autocolor.files.meshes.foreign.trimesh_scene import polygons_of_trimesh

FORBIDDEN: Final = (
    "socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "pty.",
    "ctypes.dlopen", "urllib.", "http.", "ftplib.", "smtplib.", "os.remove", "os.rename", "os.rmdir",
    "os.mkdir", "os.link", "os.symlink", "os.truncate", "os.kill", "shutil.",
)  # fmt: skip
"""The beginnings of the names of audit events of what a reader has no need of."""

WRITING: Final = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


def main(arguments: list[str]) -> int:
    """Read a file and write its mesh, or why there is none. Returns the exit code."""
    library, kind, mesh, result, seconds, memory, largest = arguments
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nothing, number)
    limit_memory(int(memory), int(largest))
    warnings.simplefilter("ignore")
    try:
        read = LIBRARIES[library](kind)
        limit_time(float(seconds))
        sys.addaudithook(guard(Path(mesh).parent, Path(result)))
        data = foreign_mesh_bytes(read(mesh))
    except (Exception, SystemExit) as error:
        what = "it needs more memory than its size allows" if isinstance(error, MemoryError) else ""
        data = FAILED + (what or sentence_of(error)).encode("utf-8", "replace")
    with open(result, "wb") as file:
        file.write(data)
    return 0


def sentence_of(error: BaseException) -> str:
    """What an exception says, in one line of at most LONGEST_SENTENCE letters."""
    if isinstance(error, SystemExit):
        return "it gave up"
    text = " ".join(str(error).split())
    name = type(error).__name__
    return (f"{name}: {text}" if text else name)[:LONGEST_SENTENCE]


def limit_memory(memory: int, largest: int) -> None:
    """Limit the addresses of this process, and the size of files that it writes, in bytes."""
    try:
        import resource
    except ImportError:
        return
    for limit, value in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_FSIZE, largest),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(limit)[1]
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(limit, (value, value))


def limit_time(seconds: float) -> None:
    """End this process after so many seconds of computing from now on, or twice as many on the clock."""
    try:
        import resource
        import signal
    except ImportError:
        return
    used = math.ceil(time.process_time() + seconds)
    # At the hard limit a process is killed without a reason; a second before, SIGXCPU tells it.
    resource.setrlimit(resource.RLIMIT_CPU, (used, used + 1))
    signal.setitimer(signal.ITIMER_REAL, 2 * seconds)


def guard(folder: Path, result: Path) -> Callable[[str, tuple[Any, ...]], None]:
    """An audit hook that refuses what no reader of a mesh needs, with PermissionError."""
    readable = [
        os.path.realpath(each) for each in {str(folder), sys.prefix, sys.base_prefix, *sys.path} if each
    ]
    written = os.path.realpath(result)

    def refuse(event: str, values: tuple[Any, ...]) -> None:
        if event == "open":
            path, _, flags = values
            if isinstance(path, int):
                return
            real = os.path.realpath(os.fsdecode(path))
            if real == written:
                return
            writes = isinstance(flags, int) and flags & WRITING
            if writes or not any(os.path.commonpath([real, each]) == each for each in readable):
                raise PermissionError(f"the file names {os.fsdecode(path)!r}, which is not in its folder")
        elif event.startswith(FORBIDDEN):
            raise PermissionError(f"{event} is not allowed")

    return refuse


def meshio_reader(kind: str) -> Callable[[str], ForeignMesh]:
    """The function that reads a file of a format with meshio, which is loaded."""
    import meshio

    def read(path: str) -> ForeignMesh:
        return polygons_of_meshio(meshio.read(path, kind), Path(path).stem)

    return read


def trimesh_reader(kind: str) -> Callable[[str], ForeignMesh]:
    """The function that reads a file of a format with trimesh, which is loaded."""
    import trimesh

    # What would be loaded from outside of Python's folders later on.
    mimetypes.init()

    def read(path: str) -> ForeignMesh:
        scene = trimesh.load_scene(path, file_type=kind, process=False)
        return polygons_of_trimesh(scene, Path(path).stem)

    return read


LIBRARIES: Final[dict[str, Callable[[str], Callable[[str], ForeignMesh]]]] = {
    "meshio": meshio_reader,
    "trimesh": trimesh_reader,
}

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
