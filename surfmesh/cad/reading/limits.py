"""How much a CAD file may cost to read: processor time and memory of the child that reads it.

Wall time is no limit: on a busy machine a good file would be refused. The reader's start is not
counted, nor the memory that it takes before it opens the file.

Measured on the 48 files of the corpus, with all cores busy: a file of s MB takes 1 to 5 s and 6 s
for each MB, and 130 to 180 MB, its libraries among them, and 20 MB for each; both limits are four
times that for large files.
"""

from __future__ import annotations

import math
import os
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

from surfmesh.errors import CadError

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]  # a module elsewhere

SECONDS, SECONDS_A_MEGABYTE = 8.0, 25.0  # of processor time
MEGABYTES, MEGABYTES_A_MEGABYTE = 1000.0, 100.0  # of memory
OWN_MEGABYTES = 250.0  # of libraries that the reader loads while it reads
JOINING = 8.0  # times the seconds where bodies are imprinted or faces sewn
LONGEST = 1e8  # seconds that a timer of the system takes
MOST_MEGABYTES = 1e12  # that a limit of the system takes
SECONDS_NAME, MEGABYTES_NAME = "SURFMESH_READ_SECONDS", "SURFMESH_READ_MEMORY"
MORE_TIME = f"allow more with time_limit= (--time-limit, {SECONDS_NAME})"
MORE_MEMORY = f"allow more with memory_limit= (--memory-limit, {MEGABYTES_NAME})"


@dataclass(frozen=True)
class Limits:
    """Infinite where there is none."""

    seconds: float  # of processor time, from when the reader is loaded
    megabytes: float  # of memory beyond what the reader takes itself, ``OWN_MEGABYTES`` at most

    @classmethod
    def of(
        cls, path: Path, time_limit: float | None, memory_limit: float | None, joins: bool
    ) -> Limits:
        """What was asked for; None: what the environment says, else by the size of the file.

        Raises CadError for what is no positive number.
        """
        size = path.stat().st_size / 1e6
        seconds = (SECONDS + SECONDS_A_MEGABYTE * size) * (JOINING if joins else 1.0)
        return cls(
            _chosen("time_limit", time_limit, SECONDS_NAME, seconds),
            _chosen("memory_limit", memory_limit, MEGABYTES_NAME,
                    MEGABYTES + MEGABYTES_A_MEGABYTE * size),
        )  # fmt: skip

    def impose(self) -> None:
        """Let the system end this process beyond the limits; on Windows it has none of these."""
        if resource is None:
            return
        if math.isfinite(self.megabytes):
            _, most = resource.getrlimit(resource.RLIMIT_DATA)
            megabytes = min(OWN_MEGABYTES + self.megabytes, MOST_MEGABYTES)
            wanted = _data_bytes() + int(megabytes * 1e6)
            wanted = wanted if most == resource.RLIM_INFINITY else min(wanted, most)
            resource.setrlimit(resource.RLIMIT_DATA, (wanted, most))
        if math.isfinite(self.seconds):
            signal.setitimer(signal.ITIMER_PROF, min(self.seconds, LONGEST))


def _chosen(name: str, given: float | None, variable: str, default: float) -> float:
    found: float | str = default if given is None else given
    if given is None:
        name, found = variable, os.environ.get(variable, "").strip() or default
    try:
        value = float(found)
    except (TypeError, ValueError):
        value = math.nan
    if not value > 0.0:
        unit = "seconds" if "SECONDS" in variable else "MB"
        raise CadError(f"{name} is {str(found)[:40]!r}: a positive number of {unit} is wanted, or "
                       "inf for no limit")  # fmt: skip
    return value


def _data_bytes() -> int:
    """Private memory that this process has taken so far, where the system tells."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    except (OSError, UnicodeDecodeError):
        return 0
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith("VmData:")), 0)


def peak_megabytes(usage: resource.struct_rusage) -> float:
    """The largest memory of a child that has ended; 0 when that is not known.

    What this process had when it started the child counts as the child's.
    """
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    unit = 1e-6 if sys.platform == "darwin" else 1024e-6
    return unit * usage.ru_maxrss if usage.ru_maxrss > own else 0.0
