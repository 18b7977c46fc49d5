"""The process in which a library reads a file.

It is started as `python -m autocolor.files.foreign.worker` with the words that `reader` gives: the library,
the module of this folder that calls it, the kind of file, the file, that of the result, the number of bytes
to read, a factor for the budget and the fields of the placement in JSON. Once the library is loaded, the
system limits memory. If the file cannot be read, the exit code is FAILED and the
result a sentence.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import tempfile
import warnings
from pathlib import Path

from autocolor.budget import allowing
from autocolor.errors import InputError
from autocolor.files.foreign.mesh import ForeignRefusal, report_of, save, unreadable
from autocolor.files.foreign.reader import FAILED, most_memory
from autocolor.files.meshes.repair import Placement


def main(arguments: list[str]) -> int:
    """Read a file and write its mesh, or the reason of a failure. Returns the exit code."""
    library, name, kind, mesh, result, size, factor, placement = arguments
    warnings.simplefilter("ignore")
    sys.dont_write_bytecode = True
    tempfile.tempdir = os.path.dirname(result)
    try:
        module = importlib.import_module(f"autocolor.files.foreign.{name}")
        with allowing(float(factor)):
            if sys.platform != "win32":
                import resource

                _, most = resource.getrlimit(resource.RLIMIT_AS)
                memory = min(most_memory(int(size)), most if most != resource.RLIM_INFINITY else 1 << 62)
                resource.setrlimit(resource.RLIMIT_AS, (memory, most))
            path, placed = Path(mesh), Placement(*json.loads(placement))
            save(report_of(module.read(path, kind), path.name, placed), Path(result))
        return 0
    except (InputError, ForeignRefusal) as error:
        reason = str(error)
    except MemoryError:
        reason = str(unreadable(library, "it needs more memory than its size and --limit allow"))
    except (Exception, SystemExit) as error:
        # Others, such as a KeyError, say nothing to a user.
        is_plain = isinstance(error, (OSError, ValueError)) or type(error).__module__ != "builtins"
        line = str(error)[:300] if is_plain else ""
        reason = str(
            unreadable(library, line or f"it is cut short or damaged, or has what {library} does not know")
        )
    Path(result).write_text(" ".join(reason.split()), "utf-8", "replace")
    return FAILED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
