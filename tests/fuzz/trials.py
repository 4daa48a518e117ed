"""Hostile input tried in a process of its own, and what is held against the result.

Wanted of everything that is read: a ``SurfmeshError`` in one line, or a result that holds
together; no other exception, no warning, nothing printed (by compiled libraries neither), a
bounded amount of memory and processor time, and a process that lives. The processes are forks,
so that libraries are loaded once; one tries many inputs and is replaced when an input ends it.
"""

import contextlib
import faulthandler
import json
import os
import resource
import select
import signal
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

from fuzz.command_lines import command_line
from fuzz.mutations import Mutant, mutant
from fuzz.oracles import LONGEST, TRIED, Partial, Wrong
from fuzz.seed_files import CAD, EXTENSION, MESHES, PIECES, TEXTS, originals

KINDS = (*MESHES, *PIECES, *CAD, *TEXTS, "command")
FAULTS = ("crashed", "hung", "traceback", "memory", "noise", "wrong", "partial")
PROCESSOR_SECONDS = 60  # far beyond what any takes: what uses more hangs
CAD_SECONDS = 4  # before a CAD file is left to the child of read_cad
WALL_SECONDS = 900  # for what waits instead of working
MEMORY = 1 << 30  # bytes over the interpreter's own
SECONDS = dict.fromkeys(CAD, CAD_SECONDS)


class Trial(NamedTuple):
    """One input and its end: "refused", "read", or one of ``FAULTS``."""

    kind: str
    name: str
    ended: str
    said: str
    seconds: float  # of processor time
    megabytes: float  # the most that was held, over what the process held before

    @property
    def is_fault(self) -> bool:
        return self.ended in FAULTS


class Task(NamedTuple):
    """What is tried: the input is made in the process that tries it."""

    kind: str
    name: str
    make: Callable[[], Mutant]


def mutants(kind: str, seed: int, numbers: Iterable[int]) -> list[Task]:
    """Tasks of damaged files, or of command lines, by their numbers."""
    if kind == "command":
        return [Task(kind, str(n), partial(_command, seed, n)) for n in numbers]
    return [Task(kind, str(n), partial(_mutant, kind, seed, n)) for n in numbers]


def _command(seed: int, number: int) -> Mutant:
    return Mutant(json.dumps(command_line(seed, number)).encode(), 0, ())


def _mutant(kind: str, seed: int, number: int) -> Mutant:
    return mutant(originals(kind), kind, seed, number)


def files(paths: Iterable[Path]) -> list[Task]:
    """Tasks of files as they are; a .toml is tried as a surface and as sizes."""
    of_extension = {**{EXTENSION[kind]: (kind,) for kind in (*MESHES, *CAD, "drawing")},
                    ".toml": ("surface", "sizes")}  # fmt: skip
    return [
        Task(kind, path.name, partial(_content, path))
        for path in paths
        for kind in of_extension.get(path.suffix.lower(), ())
    ]


def _content(path: Path) -> Mutant:
    return Mutant(path.read_bytes(), -1, ())


def tried(tasks: Sequence[Task], prepare: bool = True) -> Iterator[Trial]:
    """The end of each task, in their order. prepare: have all libraries loaded before.

    CAD files that end the process here are read again as users read them, by ``read_cad``: its
    own child is there to be ended.
    """
    if prepare:
        for kind in {task.kind for task in tasks}:
            _prepared(kind)
    position = 0
    with tempfile.TemporaryDirectory() as folder:
        while position < len(tasks):
            for trial in _in_one_process(tasks[position:], Path(folder)):
                position += 1
                if trial.kind in CAD and trial.ended in ("crashed", "hung", "memory"):
                    again = tasks[position - 1]._replace(kind=f"{trial.kind} in a child")
                    trial = next(_in_one_process([again], Path(folder)))._replace(kind=trial.kind)
                yield trial


@cache
def _prepared(kind: str) -> None:
    """Good files are read once, so that what is measured is the input and not the imports."""
    if kind == "command":
        from surfmesh.cli import commands  # noqa: F401

        return
    with tempfile.TemporaryDirectory() as folder:
        for number, data in enumerate(originals(kind)):
            place = Path(folder, f"good{number}{EXTENSION[kind]}")
            place.write_bytes(data)
            with contextlib.suppress(ValueError):  # triangles in strips are refused
                TRIED[kind](place, Mutant(data, number, ()))


def _in_one_process(tasks: Sequence[Task], folder: Path) -> Iterator[Trial]:
    """Trials of the first tasks, up to all of them, until one ends the process."""
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside threads
        child = os.fork()
    if child == 0:
        os.close(reading)
        _work(tasks, folder, writing)
    os.close(writing)
    done, ended = 0, "crashed"
    with open(reading, "rb", buffering=0) as pipe:
        rest = b""
        while True:
            ready, _, _ = select.select([pipe], [], [], WALL_SECONDS)
            if not ready:
                os.kill(child, signal.SIGKILL)
                ended = "hung"
                break
            block = pipe.read(65536)
            if not block:
                break
            *lines, rest = (rest + block).split(b"\n")
            for line in lines:
                yield Trial(*json.loads(line))
                done += 1
    _, status = os.waitpid(child, 0)
    if done < len(tasks):
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if number == signal.SIGXCPU:
            ended = "hung"
        said = signal.Signals(number).name if number else f"status {status}"
        limit = float(PROCESSOR_SECONDS) if ended == "hung" else 0.0
        yield Trial(tasks[done].kind, tasks[done].name, ended, said, limit, 0.0)


def _work(tasks: Sequence[Task], folder: Path, writing: int) -> None:
    """The child: never returns."""
    status = 1
    try:
        for stream in (1, 2):
            os.dup2(
                os.open(folder / f"stream{stream}", os.O_RDWR | os.O_CREAT | os.O_TRUNC), stream
            )
        sys.stdout, sys.stderr = (open(n, "w", closefd=False, errors="replace") for n in (1, 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        faulthandler.disable()  # the tests' own would tell of each crash
        for task in tasks:
            trial = _one(task, folder)
            os.write(writing, json.dumps(trial).encode() + b"\n")
        status = 0
    except BaseException:
        with open(folder / "broken", "w") as file:
            traceback.print_exc(file=file)
    finally:
        os._exit(status)


def _one(task: Task, folder: Path) -> Trial:
    """Try one input under the limits."""
    found = task.make()
    kind = task.kind.removesuffix(" in a child")
    place = folder / f"tried{EXTENSION.get(kind, '.json')}"
    place.write_bytes(found.data)
    name = " ".join((task.name, *found.changes))
    _limit(SECONDS.get(task.kind, PROCESSOR_SECONDS))
    before, start = _held(reset=True), _processor_seconds()
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        ended, said = _end_of(TRIED[task.kind], place, found)
    seconds, peak = _processor_seconds() - start, _held() - before
    printed = _printed(folder)
    if ended in ("refused", "read"):
        if "\n" in said or len(said) > LONGEST:
            ended, said = "wrong", f"a message of several lines or {len(said)} characters: {said}"
        elif (printed and kind not in CAD) or warned:
            noise = printed or f"{warned[0].category.__name__}: {warned[0].message}"
            ended, said = "noise", f"{noise} | {ended}: {said}"
        elif peak > MEMORY:
            ended = "memory"
    return Trial(kind, name, ended, said[:2000], seconds, peak / 2**20)


def _end_of(work: Callable[[Path, Mutant], str], place: Path, found: Mutant) -> tuple[str, str]:
    from surfmesh.errors import FormulaError, SurfmeshError

    try:
        return "read", work(place, found)
    except FormulaError as error:  # shows the formula on lines of its own
        return "refused", " ".join(str(error).split())
    except SurfmeshError as error:
        return "refused", str(error)
    except MemoryError:
        return "memory", "MemoryError"
    except Wrong as error:
        return "wrong", str(error)
    except Partial as error:
        return "partial", str(error)
    except (Exception, RecursionError):
        return "traceback", traceback.format_exc(limit=-4)


def _limit(allowed: int) -> None:
    """Limits from here on: memory over what is held, seconds over what is used."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    seconds = int(used.ru_utime + used.ru_stime) + allowed + 1
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))
    size = _status("VmSize:")
    if size:
        resource.setrlimit(resource.RLIMIT_AS, (size + 2 * MEMORY, resource.RLIM_INFINITY))


def _processor_seconds() -> float:
    return sum(os.times()[:4])


def _held(reset: bool = False) -> int:
    """Bytes: the most that was resident since the last reset, which asks for what is now."""
    with contextlib.suppress(OSError):
        if reset:
            Path("/proc/self/clear_refs").write_text("5")
    return _status("VmHWM:")


def _status(key: str) -> int:
    """Bytes by the name of an entry of Linux's status; 0 elsewhere."""
    try:
        with open("/proc/self/status") as file:
            return next((1024 * int(line.split()[1]) for line in file if line.startswith(key)), 0)
    except OSError:
        return 0


def _printed(folder: Path) -> str:
    """What came out on either stream, which is emptied."""
    found = ""
    for number, stream in ((1, sys.stdout), (2, sys.stderr)):
        stream.flush()
        path = folder / f"stream{number}"
        if path.stat().st_size:
            found += path.read_text(errors="replace")
            os.ftruncate(number, 0)
            os.lseek(number, 0, os.SEEK_SET)
    return found
