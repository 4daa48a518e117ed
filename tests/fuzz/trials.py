"""Hostile input tried in a process of its own, and what is held against the result.

Wanted of everything that is read: a ``SurfmeshError`` in one line, or a result that holds
together; no other exception, no warning, nothing printed (by compiled libraries neither), a
bounded amount of memory and processor time, and a process that lives. The processes are forks,
so that libraries are loaded once; one tries many inputs and is replaced when an input ends it.
"""

import contextlib
import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

from fuzz.command_lines import command_line
from fuzz.mutations import MARK, Mutant, mutant
from fuzz.seed_files import CAD, EXTENSION, MESHES, TEXTS, originals

KINDS = (*MESHES, *CAD, *TEXTS, "command")
FAULTS = ("crashed", "hung", "traceback", "memory", "noise", "wrong", "partial")
PROCESSOR_SECONDS = 10
CAD_SECONDS = 4  # before a CAD file is left to the child of read_cad
CHILD_SECONDS = 30  # for that child, which has limits of its own
WALL_SECONDS = 300  # for what waits instead of working
MEMORY = 1 << 30  # bytes over the interpreter's own
LONGEST = 1000  # characters of a message
OPEN_ENDED = (".obj", ".inp", ".off", ".ply")  # of other programs: their last number may be cut


class Wrong(Exception):
    """What was read does not hold together; the words say why."""


class Partial(Exception):
    """A file that was cut was read as if it were whole."""


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
            os.dup2(os.open(folder / f"stream{stream}", os.O_RDWR | os.O_CREAT | os.O_TRUNC), stream)
        sys.stdout, sys.stderr = (open(n, "w", closefd=False, errors="replace") for n in (1, 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
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
    _limit(_SECONDS.get(task.kind, PROCESSOR_SECONDS))
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
        elif seconds > _SECONDS.get(task.kind, PROCESSOR_SECONDS):
            ended = "hung"
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


# ---- what is done with each kind of input, in words; the errors are those of surfmesh


def _mesh(path: Path, found: Mutant) -> str:
    """Read, report in full, and write in one of the formats."""
    from surfmesh.io import FORMATS, read
    from surfmesh.quality import check

    mesh = read(path)
    _held_together(mesh)
    report = check(mesh)
    broken = mesh.check()
    if broken and report.clean:
        raise Wrong(f"the report is clean, but {broken}")
    report.to_text()
    json.loads(report.to_json())
    if found.changes == ("truncated",):
        _as_whole(path, found, mesh)
    number = sum(found.data[-8:]) % len(FORMATS)
    return f"{mesh}; {broken or 'sound'}{_saved(mesh, path.with_name('again' + [*FORMATS][number]))}"


def _held_together(mesh: Any) -> None:
    """What mesh.check() takes for granted: arrays that belong to these points and triangles."""
    points, triangles = len(mesh.points), len(mesh.triangles)
    if not triangles:
        raise Wrong("there are no triangles")
    for name, limit in (("edge_segments", points), ("vertex_ids", points)):
        numbers = getattr(mesh, name)
        if numbers is not None and len(numbers) and numbers.max() >= limit:
            raise Wrong(f"{name} holds {numbers.max()}, the points are {limit}")
    if mesh.edge_ids is not None and mesh.edge_segments is not None:
        if len(mesh.edge_ids) != len(mesh.edge_segments):
            raise Wrong("edge_ids and edge_segments are of different lengths")
    for face in set(mesh.face_ids.tolist()):
        mesh.face_name(face)


def _saved(mesh: Any, path: Path) -> str:
    from surfmesh.errors import SurfmeshError
    from surfmesh.io import save

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of corners alone for order 2
        try:
            save(mesh, path)
        except SurfmeshError as error:
            return f"; not saved: {error}"
        finally:
            path.unlink(missing_ok=True)
    return ""


@cache
def _whole(kind: str, source: int) -> Any:
    from surfmesh.io import read

    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, f"whole{kind}")
        place.write_bytes(originals(kind)[source])
        return read(place)


def _as_whole(path: Path, found: Mutant, mesh: Any) -> None:
    """A file that was cut gives all of the mesh, or is refused."""
    kind, original = path.suffix, originals(path.suffix)[found.source]
    if kind in OPEN_ENDED and MARK not in original:
        return
    whole = _whole(kind, found.source)
    same = all(
        _same(getattr(mesh, name), getattr(whole, name))
        for name in ("points", "triangles", "face_ids", "solid_ids", "mid_points", "sizes")
    )
    if not same or mesh.groups != whole.groups:
        raise Partial(f"cut at {len(found.data)} of {len(original)} bytes, read as {mesh}")


def _same(a: Any, b: Any) -> bool:
    return (a is None) == (b is None) and (a is None or (a.shape == b.shape and bool((a == b).all())))


def _cad(path: Path, found: Mutant) -> str:
    """What the child of ``read_cad`` does; what OCP prints there goes nowhere."""
    from surfmesh.cad.readers import read_here
    from surfmesh.errors import CadError

    try:
        model = read_here(path, True, None)
    except Exception as error:  # as the child says it
        if type(error).__module__.startswith("OCP"):
            raise CadError(f"OCP gave up: {type(error).__name__}") from None
        raise
    return f"{len(model.faces)} faces"


def _cad_in_child(path: Path, found: Mutant) -> str:
    from surfmesh.cad.reading import read_cad

    return f"{len(read_cad(path).faces)} faces"


def _surface(path: Path, found: Mutant) -> str:
    """Load, and make a coarse mesh of few triangles."""
    import surfmesh as sm

    surface = sm.load(path)
    return f"{surface.name[:40]!r}: {sm.mesh(surface, sm.Sizing(angle=40, limit=3000))}"


def _drawing(path: Path, found: Mutant) -> str:
    import surfmesh as sm

    return f"{sm.mesh(sm.load(path), sm.Sizing(limit=3000))}"


def _sizes(path: Path, found: Mutant) -> str:
    """Read, and settle for a model whose faces have names."""
    import surfmesh as sm
    from surfmesh.sizing.sizes_file import read_sizes

    wishes = read_sizes(path)
    return f"{len(wishes)} selections, {sm.estimate(_box(), wishes).triangles} triangles"


@cache
def _box() -> Any:
    import cadquery as cq

    import surfmesh as sm

    parts = cq.Assembly(name="front").add(cq.Workplane().box(1, 1, 1), name="front box")
    return sm.from_cadquery(parts)


def _command_line(path: Path, found: Mutant) -> str:
    """Run in this process; the exit status and both streams are as the docs say."""
    import io

    from surfmesh.cli import main

    folder = path.parent / "commands"
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    words = [word.replace("FOLDER", str(folder)) for word in json.loads(found.data)]
    for name, data in _INPUTS.items():
        Path(folder, name).write_bytes(data)
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(words)
        except SystemExit as end:
            status = end.code
    said, complaints = out.getvalue(), err.getvalue()
    shown = f"{words}: {status} {complaints.strip()}"
    made = {entry.name for entry in folder.iterdir()} - set(_INPUTS)
    if status not in (0, 1, 2):
        raise Wrong(f"exit status {status!r} of {shown}")
    if status == 2:
        one_line = complaints.startswith("surfmesh: ") and complaints.count("\n") == 1
        if not one_line or said or not complaints.strip().isprintable():
            raise Wrong(f"not one line: {complaints!r}, {said[:80]!r} of {shown}")
        if made:
            raise Wrong(f"{made} left behind by {shown}")
    elif complaints:
        raise Wrong(f"status {status}, but it complains: {shown}")
    elif "--json" in words and status != 2 and "--help" not in words and said[:1] == "{":
        json.loads(said)
    return shown[:LONGEST]


_INPUTS = {
    "tetra.off": b"OFF\n4 4 0\n1 1 1\n1 -1 -1\n-1 1 -1\n-1 -1 1\n3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n",
    "bad.off": b"OFF\n4 4 0\n1 1 1\n",
    "surface.toml": b'name = "s"\nx = "u"\ny = "v"\nz = "u*v"\n[domain]\nu = [0, 1]\nv = [0, 1]\n',
    "bad.toml": b'name = "\x1b[2J"\nx = "u"\n',
    "sizes.toml": b'[sizes."*"]\nsize = 0.5\n',
    "domain.toml": b'name = "d"\nouter = [[0, 0], [1, 0], [1, 1], [0, 1]]\n[sizing]\nsize = 0.5\n',
    "bad.step": b"ISO-10303-21;\nHEADER;\n",
    "odd\n\x1b[31mname.off": b"OFF\n1 1 1\n",
}  # fmt: skip

_SECONDS = dict.fromkeys(CAD, CAD_SECONDS) | {f"{kind} in a child": CHILD_SECONDS for kind in CAD}
TRIED: dict[str, Callable[[Path, Mutant], str]] = {
    **dict.fromkeys(MESHES, _mesh),
    **dict.fromkeys(CAD, _cad),
    **{f"{kind} in a child": _cad_in_child for kind in CAD},
    "surface": _surface,
    "domain": _surface,
    "drawing": _drawing,
    "sizes": _sizes,
    "command": _command_line,
}
