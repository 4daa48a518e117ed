"""The command line: ``surfmesh mesh``, ``check``, ``view``, ``explain``, ``estimate``, ``pack`` ...

Exit status 0: done and valid; 1: a mesh was made but its report is not clean; 2: bad input or
usage, told in one line on standard error.
"""

import errno
import os
import sys
from collections.abc import Sequence

from surfmesh.cli.arguments import parse
from surfmesh.errors import FormulaError, SurfmeshError

DONE, NOT_CLEAN, BAD_INPUT = 0, 1, 2
_FULL = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)
INTERRUPTED, PIPE_CLOSED = 130, 141  # as shells say: 128 + the signal's number


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without ° is no reason to fail
    try:
        options = parse(sys.argv[1:] if argv is None else argv)
        from surfmesh.cli import commands

        clean = getattr(commands, options.command)(options)
        sys.stdout.flush()
        return DONE if clean else NOT_CLEAN
    except FormulaError as error:
        shown = f" in '{error.text}'" if error.text and len(error.text) <= 60 else ""
        return _complain(f"{error.reason} (column {error.column}){shown}")
    except (SurfmeshError, OSError) as error:
        if isinstance(error, BrokenPipeError):
            return _hang_up()
        if isinstance(error, OSError) and error.errno in _FULL and error.filename is None:
            return _complain(f"standard output or a cache cannot be written: {error.strerror}")
        return _complain(str(error))
    except MemoryError:
        return _complain("not enough memory; ask for larger sizes")
    except KeyboardInterrupt:
        return INTERRUPTED


def _complain(message: str) -> int:
    print("surfmesh:", " ".join(message.split()), file=sys.stderr)
    return BAD_INPUT


def _hang_up() -> int:
    """The reader of our output has gone: say nothing more, also not at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return PIPE_CLOSED
