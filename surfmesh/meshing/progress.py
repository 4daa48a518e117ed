"""The stages of meshing as the user sees them: seconds, how much of the work is done, a way out."""

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import numpy as np

from surfmesh.errors import Cancelled

Progress = Callable[[str, float], object]
"""Called with the name of the stage and the fraction of the work done, 0 to 1, never falling.

Called when a stage starts, before each pass of the optimiser, when faces of a CAD model are done
and, with 1, when all is, in the thread that meshes. Returning False (not None) stops the work with
``Cancelled``; what it raises comes through.
"""

_STAGES = {
    "sizing": (0.0, 0.2), "packing": (0.2, 0.4), "boundary": (0.4, 0.5), "optimisation": (0.5, 0.9),
    "faces": (0.2, 0.9),  # of a CAD model: each of them is packed, bounded and optimised
    "mapping": (0.9, 1.0),
}  # fmt: skip
"""Fractions of the work that are done when a stage begins, and when it ends."""

_NEARER = 0.1  # fraction of the rest of a stage that a pulse advances

logger = logging.getLogger(__name__)


class WorkBudget:
    """A progress callback that stops the work when so many units of it are done.

    A unit is a triangle that is made, or a cell of a size field: no clock is looked at, so that
    the work ends at the same place on every machine.
    """

    def __init__(self, units: int) -> None:
        self.left = units

    def __call__(self, stage: str, done: float) -> bool:
        return self.left >= 0


class OneProgress:
    """A progress callback for a mesh that is made several times: what it was told never falls."""

    def __init__(self, progress: Progress) -> None:
        self._progress, self._done = progress, 0.0

    def __call__(self, stage: str, done: float) -> object:
        self._done = max(self._done, done)
        return self._progress(stage, self._done)


def tell(progress: Progress | None, stage: str, done: float) -> None:
    """Say where the work is. Raises ``Cancelled`` when it is to stop."""
    if progress is None:
        return
    answer = progress(stage, done)
    if isinstance(answer, (bool, np.bool_)) and not answer:
        raise Cancelled(
            f"stopped in the stage {stage!r}, as the progress callback asked; nothing was written"
        )


def tell_end(progress: Progress | None) -> None:
    """Say that all is done; the mesh may have been made several times."""
    tell(progress, "mapping", _STAGES["mapping"][1])


class Stopwatch:
    """Seconds per stage; tells the progress callback and the log where the work is."""

    def __init__(self, progress: Progress | None) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress
        self._name, self._done = "sizing", 0.0

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what is done within, under ``name``; raises ``Cancelled`` before it starts."""
        self._name = name
        self._tell(_STAGES[name][0])
        start = time.perf_counter()
        try:
            yield
        finally:
            took = time.perf_counter() - start
            self.seconds[name] = self.seconds.get(name, 0.0) + took
        logger.info("%s: %.3f s", name, took)

    @contextmanager
    def stages(self) -> Iterator[Callable[[str], None]]:
        """Gives a function that ends one stage and begins the one of its argument."""
        with ExitStack() as current:

            def begin(name: str) -> None:
                current.close()
                current.enter_context(self.stage(name))

            yield begin

    def pulse(self, within: float | None = None) -> None:
        """Say that the stage goes on; raises ``Cancelled`` when that is not wanted.

        within: fraction of the way to its end, 0 to 1; None: a little nearer to it.
        """
        if self._progress is None:
            return
        first, last = _STAGES[self._name]
        if within is None:
            self._tell(self._done + _NEARER * max(0.0, last - self._done))
        else:
            self._tell(first + within * (last - first))

    @property
    def counts_work(self) -> bool:
        """Is there a ``WorkBudget``?"""
        return isinstance(self._progress, WorkBudget)

    def spend(self, units: int) -> None:
        """Take work that was done from a ``WorkBudget``, if there is one."""
        if isinstance(self._progress, WorkBudget):
            self._progress.left -= units

    def _tell(self, done: float) -> None:
        self._done = max(self._done, done)  # another round does not take back what was said
        tell(self._progress, self._name, self._done)
