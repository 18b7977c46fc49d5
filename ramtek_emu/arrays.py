"""The array types of this package, each with one meaning; every other module imports them from here."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

Words = NDArray[np.uint16]
"""16-bit words: a stream, or a picture as (lines, elements)."""
Dots = NDArray[np.bool_]
"""Truth values: of the pixels of a raster, of the dots of a character or a cursor, of the rows of a table."""
Numbers = NDArray[np.int64]
"""Signed numbers: coordinates and distances."""
Indices = NDArray[np.intp]
"""Indices into another array."""
WholeNumbers = NDArray[np.integer]
"""Whole numbers whose range has not been checked yet."""
Colors = NDArray[np.uint8]
"""The colors of entries or pixels: red, green and blue along the last axis, 0 to 255."""
PackedColors = NDArray[np.uint32]
"""The colors of entries or pixels as numbers 0x00RRGGBB."""
Bytes = NDArray[np.uint8]
"""Bytes of memory."""
Raster = NDArray[Scalar]
"""An array indexed by [line, element]; `Raster[np.uint16]` is a raster of words."""
AnyArray = NDArray[Any]
"""An array of any kind."""
