"""What reaches the terminal: no control characters, and one line for whatever is wrong."""

import json
import os
import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from surfmesh.errors import UNSAFE, printable

LONGEST, TAIL = 1000, 200
"""Characters of a line on standard error, and of its end where the middle is left out."""


def say(text: object) -> None:
    """Print on standard output, line by line."""
    print("\n".join(map(printable, str(text).split("\n"))))


def say_json(value: dict[str, Any]) -> None:
    """The real text; what ``printable`` changes is written by the escapes of JSON."""
    told = sys.stdout.encoding or "utf-8"
    text = json.dumps(
        value, indent=2, allow_nan=False, ensure_ascii=not told.lower().startswith("utf")
    )
    # layout is the only place where a line ends: within strings JSON has escaped it already
    print("\n".join(UNSAFE.sub(_json_escape, line) for line in text.split("\n")))


def _json_escape(found: Any) -> str:
    units = found[0].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[k : k + 4]}" for k in range(0, len(units), 4))


def complain(message: str) -> None:
    """One line on standard error."""
    line = printable(message.strip())
    if len(line) > LONGEST:
        line = f"{line[: LONGEST - TAIL]} ... {line[-TAIL:]}"
    _aside(f"surfmesh: {line}")


def explain_defect(error: Exception) -> None:
    """One line on what should not have happened; with SURFMESH_DEBUG where it did."""
    if os.environ.get("SURFMESH_DEBUG"):
        traceback.print_exc()
    said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    complain(f"internal error: {said}; please report it (SURFMESH_DEBUG=1 shows where)")


@contextmanager
def warnings_in_one_line() -> Iterator[None]:
    """What libraries warn of becomes a note on one line, without the lines of their source."""
    with warnings.catch_warnings():
        warnings.showwarning = _note
        yield


def _note(
    message: Warning | str, category: type[Warning], filename: str, lineno: int,
    file: TextIO | None = None, line: str | None = None,
) -> None:  # fmt: skip
    kind = "" if issubclass(category, UserWarning) else f"{category.__name__}: "
    complain(f"note: {kind}{message}")


def _aside(line: str) -> None:
    if sys.stderr is not None:  # closed by the caller
        print(line, file=sys.stderr, flush=True)
