"""Measurements of this project and its peers; in one thread of numpy's products, as in the commands."""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
