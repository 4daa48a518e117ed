"""Seconds until the first mesh is there: kernels not yet compiled, compiled, import alone."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

IMPORTS = 5  # the fastest of


def start_up(name: str = "wavy") -> dict:
    """{"first_ever", "later", "import"} in seconds, each in fresh processes."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "SURFMESH_CACHE_DIR": str(Path(folder) / "kernels")}
        command = [sys.executable, "-m", "surfmesh", "mesh", name]
        command += ["-o", str(Path(folder) / "mesh.vtu")]
        first = _seconds(command, environment)
        later = min(_seconds(command, environment) for _ in range(3))
    bare = min(_seconds([sys.executable, "-c", "pass"]) for _ in range(IMPORTS))
    loaded = min(_seconds([sys.executable, "-c", "import surfmesh"]) for _ in range(IMPORTS))
    return {"surface": name, "first_ever": first, "later": later, "import": loaded - bare}


def _seconds(command: list[str], environment: dict | None = None) -> float:
    start = time.perf_counter()
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if done.returncode not in (0, 1):  # 1: a mesh was made, its report is not clean
        raise RuntimeError(f"{' '.join(command)} failed: {done.stderr.strip()[-300:]}")
    return seconds
