"""How many processors there are, and how many threads a call of the core may use."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from surfmesh._core import allow_threads


def processors() -> int:
    """How many this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # the system does not say
        return os.cpu_count() or 1


@contextmanager
def allowed_threads(count: int) -> Iterator[None]:
    """Calls of the core within may use so many threads; what they return does not depend on it."""
    before = allow_threads(count)
    try:
        yield
    finally:
        allow_threads(before)
