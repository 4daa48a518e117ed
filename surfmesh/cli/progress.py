"""What is said while the user waits, on standard error."""

import sys
from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

PATIENCE = 1.0  # seconds before a bar appears


class ProgressBar:
    """A callback ``progress(stage, fraction)`` that shows a bar once it takes long.

    Silent when standard error is not a terminal. fraction: 0 to 1 of the whole.
    """

    _bar: "Progress | None" = None
    _start = 0.0

    def __enter__(self) -> "ProgressBar":
        self._start = perf_counter()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def __call__(self, stage: str, fraction: float) -> None:
        if self._bar is None:
            if perf_counter() - self._start < PATIENCE or not sys.stderr.isatty():
                return
            self._bar = self._begun()
        self._bar.update(self._bar.task_ids[0], description=stage, completed=fraction)

    def up_to(self, last: float) -> Callable[[str, float], None]:
        """The callback of the first part of the work, which ends at this fraction of the whole."""
        return lambda stage, fraction: self(stage, last * fraction)

    @staticmethod
    def _begun() -> "Progress":
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        bar = Progress(
            TextColumn("{task.description:<12}"),
            BarColumn(),
            TimeElapsedColumn(),
            console=Console(stderr=True),
            transient=True,
        )
        bar.add_task("", total=1.0)
        bar.start()
        return bar
