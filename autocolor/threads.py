"""Objects that one thread uses at a time, and that say so to a second thread."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from threading import RLock
from types import FunctionType
from typing import Any, TypeVar

from autocolor.errors import UsageError

Method = TypeVar("Method", bound=Callable[..., Any])
SomeClass = TypeVar("SomeClass", bound=type)


def alone(method: Method) -> Method:
    """The method, which raises UsageError while another thread is in such a method of the same object.

    A method may call others, also through a callback.
    """

    @wraps(method)
    def guarded(self: Any, *positional: Any, **keywords: Any) -> Any:
        lock = vars(self).setdefault("_lock", RLock())
        if not lock.acquire(blocking=False):
            thing = type(self).__name__.lower()
            raise UsageError(
                f"a {thing} must be used by one thread at a time, not by two at once; make a"
                f" {type(self).__name__} for each thread, or wait until the other thread is ready"
            )
        try:
            return method(self, *positional, **keywords)
        finally:
            lock.release()

    return guarded  # type: ignore[return-value]


def for_one_thread(cls: SomeClass) -> SomeClass:
    """The class, with each of its public methods `alone`."""
    for name, method in list(vars(cls).items()):
        if isinstance(method, FunctionType) and not name.startswith("_"):
            setattr(cls, name, alone(method))
    return cls
