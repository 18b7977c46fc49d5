"""Pictures out: fields as PNG files, written wholly or not at all. The only place that knows Pillow."""

import os
import tempfile
from contextlib import suppress
from io import BytesIO
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from .errors import OutputExistsError, WriteError


def png_bytes(field: NDArray[np.uint8]) -> bytes:
    """A (lines, elements, 3) uint8 field as the bytes of a PNG file."""
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(field)).save(buffer, "PNG")
    return buffer.getvalue()


def save_png(field: NDArray[np.uint8], path: str | PathLike[str], overwrite: bool = True) -> None:
    """Write a field to a PNG file: beside it first, then renamed, file and folder synced.

    OutputExistsError when the file is there and must not be overwritten; WriteError when it cannot be
    written. After either the old file is whole.
    """
    target = Path(path)
    data = png_bytes(field)
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(name, 0o666 & ~_umask())
            if overwrite:
                os.replace(name, target)
            else:
                os.link(name, target)
                os.unlink(name)
        except BaseException:
            with suppress(OSError):
                os.unlink(name)
            raise
        _sync_folder(target.parent)
    except FileExistsError as cause:
        raise OutputExistsError(
            f"the file must be a new one, not {target}, which exists; choose another name"
        ) from cause
    except OSError as cause:
        raise WriteError(
            f"the file must be writable, not {target} ({cause.strerror}); choose another place"
        ) from cause


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _sync_folder(folder: Path) -> None:
    # Not every system lets a folder be opened; the file itself is already on the disk.
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
