"""The import of OCP, which takes longer than reading a small file, in less time.

    loader of the system  |== libraries mapped and linked ==|
    interpreter           |== numpy, surfmesh ==|           |== classes of OCP ==|

Most of the import is classes being made, a few tenths of it the system's loader, which does not
need the interpreter. Python's collector would walk through the new objects, all of which stay,
again and again: it waits until they are there.
"""

from __future__ import annotations

import ctypes
import importlib.util
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

from surfmesh.cad.reading.collector import paused


def begun() -> Callable[[], None]:
    """Let the system load OCP's libraries from now on; what is returned imports OCP.

    ImportError, when OCP is not there, is raised by the latter.
    """
    loader = threading.Thread(target=_load, daemon=True)
    if "OCP" not in sys.modules and sys.platform != "win32":  # which looks for them elsewhere
        with suppress(RuntimeError):  # no thread is to be had: the import itself does it all
            loader.start()

    def imported() -> None:
        if loader.ident is not None:
            loader.join()
        import_ocp()

    return imported


def import_ocp() -> None:
    """Import OCP. Raises ImportError when it is not there."""
    with paused():
        import OCP  # noqa: F401


def _load() -> None:
    """Whatever goes wrong here is said by the import itself."""
    with suppress(OSError, ImportError, ValueError):
        found = importlib.util.find_spec("OCP")
        for folder in (found and found.submodule_search_locations) or ():
            for suffix in EXTENSION_SUFFIXES:
                library = Path(folder) / f"OCP{suffix}"
                if library.is_file():
                    ctypes.CDLL(str(library))
                    return
