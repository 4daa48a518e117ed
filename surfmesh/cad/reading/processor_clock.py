"""The timer of processor time in the process that reads a CAD file."""

import signal

from numba.core import event

SHORTEST = 1e-3  # seconds; zero would stop the timer


def stop_while_compiling() -> None:
    """From now on ITIMER_PROF stands still while kernels are compiled."""
    event.register("numba:compile", _StoppedClock())


class _StoppedClock(event.Listener):
    """The timer stands still while a kernel, with what it calls, is compiled."""

    def __init__(self) -> None:
        self.depth, self.left = 0, 0.0

    def on_start(self, event: event.Event) -> None:
        if not self.depth:
            self.left, _ = signal.setitimer(signal.ITIMER_PROF, 0.0)
        self.depth += 1

    def on_end(self, event: event.Event) -> None:
        self.depth -= 1
        if not self.depth:
            signal.setitimer(signal.ITIMER_PROF, max(self.left, SHORTEST))
