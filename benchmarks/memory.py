"""Peak memory of one mesh, in a process of its own, over what the interpreter itself takes.

The interpreter's own: resident memory after the imports and a tiny mesh of the same surface.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import resource
import sys
from pathlib import Path

import child_process

TINY = 0.01  # chord error of the tiny mesh, relative to the diagonal


def bytes_a_triangle(name: str, sizing: dict, diagonal: float, timeout: float = 600.0) -> dict:
    """{"bytes_a_triangle", "own_bytes", "peak_bytes"}, or {"error"}."""
    request = {"name": name, "sizing": sizing, "tiny": {"chord": TINY * diagonal}}
    return child_process.run("memory.py", request, timeout)


def _measure(request: dict) -> dict:
    import psutil

    import surfmesh as sm

    sm.check(sm.mesh(sm.load(request["name"]), sm.Sizing(**request["tiny"])))
    own = psutil.Process().memory_info().rss
    mesh = sm.mesh(sm.load(request["name"]), sm.Sizing(**request["sizing"]))
    report = sm.check(mesh)
    peak = _peak()
    return {
        "bytes_a_triangle": (peak - own) / report.triangles,
        "own_bytes": own,
        "peak_bytes": peak,
    }


def _peak() -> int:
    """Largest resident memory so far. On Linux that of this program alone: ``ru_maxrss`` may
    be inherited from the process that started it."""
    status = Path("/proc/self/status")
    if status.exists():
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024


if __name__ == "__main__":
    child_process.answer(_measure)
