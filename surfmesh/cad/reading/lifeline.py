"""A child process that does not outlive its parent."""

import ctypes
import os
import signal
import sys
import threading
import time

DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG, see prctl(2)
INTERVAL = 1.0  # seconds between looks, where the system does not tell


def end_with(parent: int) -> None:
    """End this process as soon as the process ``parent``, which has started it, has ended.

    On Linux by the system, whatever this process is doing; elsewhere a thread looks.
    """
    if sys.platform == "win32":  # the interpreter of an environment is a grandchild there
        return
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(DEATH_SIGNAL, int(signal.SIGKILL), 0, 0, 0)
    if os.getppid() != parent:  # it had ended before
        os._exit(1)
    if sys.platform != "linux":
        threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(INTERVAL)
    os._exit(1)
