"""The command line: ``surfmesh mesh``, ``check``, ``view``, ``explain``, ``estimate``, ``pack`` ...

Exit status 0: done and valid; 1: a mesh was made but its report is not clean; 2: bad input or
usage, told in one line on standard error; 3: an error in surfmesh itself, told in one line too.

option_groups: options that several commands have; those of ``Sizing`` and of ``load`` are named
    there alone.
arguments: what can be typed: the commands, each with its own options.
commands: what each command does.
inputs: the sizes asked for, and the surface or mesh that INPUT names.
outputs: the files beside the mesh.
scheduler: the machines that a Dask scheduler knows, as an executor.
progress, terminal: what is said while the user waits, and what reaches the terminal.
"""

import errno
import os
import sys
from collections.abc import Sequence
from contextlib import suppress

from surfmesh.cli.arguments import parse
from surfmesh.cli.terminal import complain, explain_defect, warnings_in_one_line
from surfmesh.errors import FormulaError, SurfmeshError

DONE, NOT_CLEAN, BAD_INPUT, DEFECT = 0, 1, 2, 3
_FULL = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)
INTERRUPTED, PIPE_CLOSED = 130, 141  # as shells say: 128 + the signal's number


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without ° is no reason to fail
    with warnings_in_one_line():
        return _status(sys.argv[1:] if argv is None else argv)


def _status(argv: Sequence[str]) -> int:
    try:
        options = parse(argv)
        from surfmesh.cli import commands

        clean = getattr(commands, options.command)(options)
        if sys.stdout is not None:  # closed by the caller
            sys.stdout.flush()
        return DONE if clean else NOT_CLEAN
    except FormulaError as error:
        shown = f" in '{error.text}'" if error.text and len(error.text) <= 60 else ""
        return _refuse(f"{error.reason} (column {error.column}){shown}")
    except BrokenPipeError:
        _hang_up()
        return PIPE_CLOSED
    except SurfmeshError as error:
        return _refuse(str(error))
    except OSError as error:
        if error.filename is None:  # of no file: standard output may be full
            with suppress(OSError):
                _hang_up()
            if error.errno in _FULL:
                return _refuse(f"standard output or a cache cannot be written: {error.strerror}")
        return _refuse(str(error))
    except MemoryError:
        return _refuse("not enough memory; ask for larger sizes")
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception as error:  # a defect: said so, and no traceback for who cannot mend it
        explain_defect(error)
        return DEFECT


def _refuse(reason: str) -> int:
    complain(reason)
    return BAD_INPUT


def _hang_up() -> None:
    """The reader of our output has gone: say nothing more, also not at exit."""
    if sys.stdout is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
