"""Run what might never end in a child process: a test that hangs would hold up all others."""

import os
import signal
import time
import traceback
from collections.abc import Callable

HANGS = 900.0  # seconds: far beyond what anything here takes on the slowest and busiest machine


def watched(function: Callable[[], str | None]) -> str | None:
    """What ``function`` returns: None, or what is broken in words; also when it never ends.

    The child is a fork, so compiled kernels need not be loaded again. Without fork (Windows)
    the function runs here and nobody watches.
    """
    if not hasattr(os, "fork"):
        return function()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            said = function() or ""
        except BaseException:
            said = traceback.format_exc()
        os.write(writing, said.encode()[-4000:])
        os._exit(0)
    os.close(writing)
    try:
        end = time.monotonic() + HANGS
        while os.waitpid(child, os.WNOHANG) == (0, 0):
            if time.monotonic() > end:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                return "never ends"
            time.sleep(0.002)
        return os.read(reading, 4000).decode() or None
    finally:
        os.close(reading)
