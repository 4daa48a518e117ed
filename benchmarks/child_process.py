"""Work that needs a process of its own: memory to be measured, meshers that may crash or hang.

A script that is run so reads one JSON object from its standard input and prints one as the last
line of its standard output.
"""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path


def run(script: str, request: dict, timeout: float) -> dict:
    """What ``script`` (a file of this folder) answers, or {"error": the reason}."""
    command = [sys.executable, str(Path(__file__).with_name(script))]
    try:
        done = subprocess.run(
            command, input=json.dumps(request), capture_output=True, text=True, timeout=timeout
        )
    except subprocess.TimeoutExpired:
        return {"error": f"not done within {timeout:.0f} s"}
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        return {"error": said[-1][:200]}
    return json.loads(done.stdout.strip().splitlines()[-1])


def answer(work: Callable[[dict], dict]) -> None:
    """The other side: do ``work`` on what was asked for, print what comes out."""
    print(json.dumps(work(json.loads(sys.stdin.read()))))
