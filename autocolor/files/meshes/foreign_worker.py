"""The process in which a library reads a file.

It is started as `python -m autocolor.files.meshes.foreign_worker LIBRARY MODULE KIND MESH RESULT SIZE LIMIT`.
The module `foreign_MODULE` calls the library, SIZE is the number of bytes to read, and LIMIT a factor for the
budget. Once the library is loaded, the system limits time, memory and the size of the result. From then on
Python opens no file but in the folder of the mesh and of Python, writes none but in the folder of the result,
and has no network; native code of a library is not held to this. If the file cannot be read, the exit code is
FAILED and the result a sentence.
"""

from __future__ import annotations

import errno
import importlib
import math
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from autocolor.budget import allowing
from autocolor.errors import InputError
from autocolor.files.meshes.foreign import (
    FAILED,
    LONGEST_SENTENCE,
    foreign_mesh_bytes,
    largest_result,
    most_memory,
    most_seconds,
)
from autocolor.files.meshes.foreign_mesh import ForeignRefusal, unreadable

FORBIDDEN: Final = (
    "socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "pty.",
    "urllib.", "http.", "ftplib.", "smtplib.", "os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.link",
    "os.symlink", "os.truncate", "os.kill", "shutil.",
)  # fmt: skip
"""The beginnings of the names of audit events that no mesh reader needs."""

WRITING: Final = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


def main(arguments: list[str]) -> int:
    """Read a file and write its mesh, or the reason of a failure. Returns the exit code."""
    library, name, kind, mesh, result, size, factor = arguments
    warnings.simplefilter("ignore")
    sys.dont_write_bytecode = True
    tempfile.tempdir = os.path.dirname(result)
    try:
        module = importlib.import_module(f"autocolor.files.meshes.foreign_{name}")
        with allowing(float(factor)):
            limit(int(size))
            sys.addaudithook(guard(Path(mesh).parent, Path(result).parent))
            data = foreign_mesh_bytes(module.read(Path(mesh), kind))
        with open(result, "wb") as file:
            file.write(data)
        return 0
    except (Exception, SystemExit) as error:
        sentence = sentence_of(error, library, os.path.basename(mesh))
        with open(result, "wb") as file:
            file.write(sentence.encode("utf-8", "replace"))
        return FAILED


def sentence_of(error: BaseException, library: str, mesh: str) -> str:
    """The message of an exception without the name of the mesh file, in one line."""
    text = " ".join(str(error).split())
    if isinstance(error, (ForeignRefusal, InputError)):
        return text.removeprefix(f"{mesh}: ")[: 4 * LONGEST_SENTENCE]
    if isinstance(error, MemoryError):
        text = "it needs more memory than its size and --limit allow"
    elif isinstance(error, OSError) and error.errno == errno.EFBIG:
        text = "its mesh is larger than its size and --limit allow"
    else:
        text = f"{type(error).__name__}: {text}"[:LONGEST_SENTENCE]
    return str(unreadable(library, text))


def limit(size: int) -> None:
    """Limit the time, the memory and the result of this process for a file of `size` bytes."""
    if sys.platform == "win32":
        return
    import resource

    memory, largest = most_memory(size), largest_result(size)
    seconds = math.ceil(time.process_time() + most_seconds(size))
    for kind, soft, hard in (
        (resource.RLIMIT_AS, memory, memory),
        (resource.RLIMIT_FSIZE, largest, largest),
        (resource.RLIMIT_CORE, 0, 0),
        # At the hard limit a process is killed without a reason; a second before, SIGXCPU tells it.
        (resource.RLIMIT_CPU, seconds, seconds + 1),
    ):
        most = resource.getrlimit(kind)[1]
        if most != resource.RLIM_INFINITY:
            soft, hard = min(soft, most), min(hard, most)
        resource.setrlimit(kind, (soft, hard))


def guard(folder: Path, writable: Path) -> Callable[[str, tuple[Any, ...]], None]:
    """An audit hook that raises PermissionError for files elsewhere, the network and other programs."""
    written = os.path.realpath(writable)
    readable = [
        os.path.realpath(each)
        for each in {str(folder), written, sys.prefix, sys.base_prefix, *sys.path}
        if each
    ]

    def refuse(event: str, values: tuple[Any, ...]) -> None:
        if event == "open":
            path, _, flags = values
            if isinstance(path, int):
                return
            real = os.path.realpath(os.fsdecode(path))
            allowed = [written] if isinstance(flags, int) and flags & WRITING else readable
            if not any(os.path.commonpath([real, each]) == each for each in allowed):
                raise PermissionError(f"the file names {os.fsdecode(path)!r}, which is not in its folder")
        elif event.startswith(FORBIDDEN):
            raise PermissionError(f"{event} is not allowed")

    return refuse


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
