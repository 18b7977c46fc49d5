"""How much hypothesis tries, which cases wait for a thorough run, and what all tests find around them.

`HYPOTHESIS_PROFILE=thorough python -m pytest -m "property or thorough or needs"` tries a hundred examples of
each property, and the cases that the usual run leaves out.
"""

from __future__ import annotations

import itertools
import os
import signal
import sys
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, settings

UNHURRIED = (HealthCheck.too_slow, HealthCheck.data_too_large)

settings.register_profile("desk", deadline=None, max_examples=10, suppress_health_check=UNHURRIED)
settings.register_profile(
    "ci", deadline=None, max_examples=10, derandomize=True, suppress_health_check=UNHURRIED
)
# A mutant is killed by any failing example; the smallest one is not looked for.
settings.register_profile(
    "mutants",
    deadline=None,
    max_examples=8,
    derandomize=True,
    phases=(Phase.explicit, Phase.generate),
    suppress_health_check=UNHURRIED,
)
settings.register_profile(
    "thorough",
    deadline=None,
    max_examples=100,
    derandomize=os.environ.get("CI") == "true",
    suppress_health_check=UNHURRIED,
)
settings.load_profile(
    os.environ.get("HYPOTHESIS_PROFILE", "ci" if os.environ.get("CI") == "true" else "desk")
)

# A shell that starts a command in the background has it ignore interrupts, and nohup has it ignore hang-ups.
# So do all processes that the command starts in turn, but tests send them these signals.
for number in (signal.SIGINT, getattr(signal, "SIGHUP", signal.SIGINT)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else lambda *_: None)

# If Python may not write compiled modules beside the sources, each of the hundreds of processes that tests
# start would compile all modules again. They share a folder of compiled modules instead.
if sys.dont_write_bytecode and sys.pycache_prefix is None:
    sys.dont_write_bytecode = False
    sys.pycache_prefix = str(Path(__file__).parents[1] / ".pytest_cache" / "compiled")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
    del os.environ["PYTHONDONTWRITEBYTECODE"]

# The address of a Unix socket has at most 107 bytes, and the name of a test's folder takes 80 of them.
if len(tempfile.gettempdir()) > 20 and os.access("/tmp", os.W_OK):
    os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", "/tmp")

# The width of help.
os.environ["COLUMNS"] = "80"


def pytest_configure(config: pytest.Config) -> None:
    # A random edit may change nothing.
    config.addinivalue_line("filterwarnings", "ignore::autocolor.EditWarning")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests of properties."""
    for item in items:
        if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
            item.add_marker("property")


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test that needs a package that is not installed, and name it."""
    missing = [name for mark in item.iter_markers("needs") for name in mark.args if find_spec(name) is None]
    if missing:
        pytest.skip(f"needs {' and '.join(missing)}: install autocolor[test-all]")


_NUMBERS = itertools.count()


@pytest.fixture(autouse=True)
def state(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The state folder of each test, its own; it is made when something is kept there."""
    home = tmp_path_factory.getbasetemp() / f"state-{next(_NUMBERS)}"
    monkeypatch.setenv("XDG_STATE_HOME", str(home))
    return home / "autocolor"


@pytest.fixture(autouse=True)
def signal_handlers() -> Iterator[None]:
    """Restore the handlers of signals: a command that runs in this process installs its own."""
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in numbers}
    hooks = sys.unraisablehook, sys.excepthook
    yield
    sys.unraisablehook, sys.excepthook = hooks
    for number, handler in before.items():
        signal.signal(number, handler)
