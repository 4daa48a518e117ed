"""Work that needs a process of its own: memory to be measured, meshers that may crash or hang.

A script that is run so reads one JSON object from its standard input and prints one, on a line of
its own, on its standard output. It may print others before: what is known should it end early.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path


def run(script: str, request: dict, timeout: float) -> dict:
    """What ``script`` (a file of this folder) answers.

    When it fails: what it has said before, with "error": the reason, and "ended": "hang",
    "crash" (by a signal) or "failure". Processes that it started end with it.
    """
    command = [sys.executable, str(Path(__file__).parent / script)]
    child = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, errors="replace", start_new_session=True,
    )  # fmt: skip
    try:
        out, err = child.communicate(json.dumps(request), timeout)
    except BaseException as error:
        _end(child)
        out, _ = child.communicate()
        if not isinstance(error, subprocess.TimeoutExpired):
            raise
        return {**_said(out), "error": f"not done within {timeout:.0f} s", "ended": "hang"}
    if child.returncode < 0:
        name = signal.Signals(-child.returncode).name
        return {**_said(out), "error": f"crashed ({name})", "ended": "crash"}
    if child.returncode:
        said = err.strip().splitlines() or [f"exit status {child.returncode}"]
        return {**_said(out), "error": said[-1][:200], "ended": "failure"}
    return _said(out) or {"error": "no answer", "ended": "failure"}


def _end(child: subprocess.Popen) -> None:
    """The child and whatever it started: they are a process group of their own."""
    if hasattr(os, "killpg"):
        os.killpg(child.pid, signal.SIGKILL)
    else:
        child.kill()


def _said(out: str) -> dict:
    """All lines that are JSON objects as one, the later ones count; libraries talk in between."""
    known = {}
    for line in out.splitlines():
        if line.startswith("{"):
            try:
                known.update(json.loads(line))
            except json.JSONDecodeError:
                continue
    return known


def say(what: dict) -> None:
    """From the other side: what is known so far."""
    print("\n" + json.dumps(what), flush=True)


def answer(work: Callable[[dict], dict]) -> None:
    """The other side: do ``work`` on what was asked for, print what comes out."""
    say(work(json.loads(sys.stdin.read())))


def answer_by(work: dict[str, Callable[[dict], dict]]) -> None:
    """The other side, for meshers by name: what one finds, or why it will not.

    A refusal is to be told from a crash, which leaves no answer.
    """

    def of_one(request: dict) -> dict:
        try:
            return work[request["mesher"]](request)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}".strip().splitlines()[0]
            return {"error": reason[:300], "ended": "refusal"}

    answer(of_one)
