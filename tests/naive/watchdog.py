"""Run what might never end in a child process, with a limit of time."""

import os
import signal
import time
import traceback
from collections.abc import Callable


def within(seconds: float, function: Callable[[], str | None]) -> str | None:
    """What ``function`` returns: None, or what is broken in words; also when it takes too long.

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
        end = time.monotonic() + seconds
        while os.waitpid(child, os.WNOHANG) == (0, 0):
            if time.monotonic() > end:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                return f"not finished after {seconds:g} s"
            time.sleep(0.002)
        return os.read(reading, 4000).decode() or None
    finally:
        os.close(reading)
