"""What `make mesh` takes in a fresh copy of the sources with an empty environment, part by part."""

import os
import shutil
import subprocess
import time
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
LEFT_OUT = shutil.ignore_patterns(".venv*", ".git", "build", "dist", "__pycache__", "_core*.so")


def install(folder: Path, timeout: float) -> dict[str, float]:
    """Seconds on the wall of the build, of the rest of the installation and of the mesh.

    The compiler starts from nothing; packages may lie in the installer's own cache. Raises
    ``RuntimeError`` with what was said where a command fails.
    """
    copy = folder / "copy"
    shutil.copytree(HERE, copy, ignore=LEFT_OUT)
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    installed = _seconds(["make", "venv"], copy, environment, timeout)
    built = max(_ends(log) for log in copy.glob("build/editable-*/.ninja_log"))
    meshed = _seconds(["make", "mesh"], copy, environment, timeout)
    return {"build": built, "install": installed - built, "mesh": meshed}


def _seconds(command: list[str], folder: Path, environment: dict, timeout: float) -> float:
    began = time.perf_counter()
    done = subprocess.run(
        command, cwd=folder, env=environment, timeout=timeout, capture_output=True, text=True
    )
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()[-300:]}")
    return time.perf_counter() - began


def _ends(log: Path) -> float:
    """Seconds from the first command of a build to its last, by ninja's record."""
    lines = (line.split("\t") for line in log.read_text().splitlines() if line[0] != "#")
    return max(int(line[1]) for line in lines) / 1e3
