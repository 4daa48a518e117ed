"""The stages of meshing as the user sees them: seconds, and the share of the work done."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str, float], None]
"""Called with the name of the stage that starts and the share of the work done, 0 to 1."""

_STAGES = {"sizing": 0.0, "packing": 0.2, "boundary": 0.4, "optimisation": 0.5, "mapping": 0.9}


class Stopwatch:
    """Seconds per stage; tells the progress callback when a stage starts."""

    def __init__(self, progress: Progress | None) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        if self._progress is not None:
            self._progress(name, _STAGES[name])
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
