"""Saves at limits in this process; for ``saves_at_limits.py``, which says what is wanted."""

import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import child_process

LIMITS = 17  # file sizes that are tried, an output: from none to all but one byte
LATE = (3000, 700, 60, 1)  # of them: so many bytes too few, less than what is buffered
DISKS = 5  # sizes of a file system
PAGE = 4096  # bytes, the grain of its size
OLD = b"what was there before\n" * 100


class Output(NamedTuple):
    name: str
    suffix: str
    write: Callable  # (path)


def outputs() -> list[Output]:
    """The 13 formats, .stl as text, pictures, the page and the texts of the command line."""
    import surfmesh as sm
    from surfmesh.cli.outputs import written
    from surfmesh.io import FORMATS
    from surfmesh.view import html_report, plot

    mesh = sm.mesh(sm.load("torus"), sm.Sizing(chord=0.02))
    report = sm.check(mesh)
    packing = sm.pack(1.0, count=60)
    return [
        *(Output(suffix, suffix, mesh.save) for suffix in FORMATS),
        Output(".stl as text", ".stl", lambda path: mesh.save(path, ascii=True)),
        Output("picture .png", ".png", lambda path: plot(mesh, path, size=(320, 240))),
        Output("report .html", ".html", lambda path: html_report(mesh, path, report=report)),
        Output("report .json", ".json", lambda path: written(report.to_json(), path)),
        Output("packing .svg", ".svg", packing.plot),
        Output("packing .png", ".png", packing.plot),
    ]


def row_of(output: Output, folder: Path, limits: int = LIMITS, disks: int = DISKS) -> dict:
    """What became of all saves of one output into ``folder``, which holds nothing else."""
    path = folder / f"mesh{output.suffix}"
    output.write(path)  # what is imported or cached is so before there is a limit
    whole = path.read_bytes()
    row = {"bytes": len(whole), "tried": 0, "refused": 0, "saved": 0, "broken": 0, "how": []}
    early = limits - len(LATE)
    late = (len(whole) - size for size in LATE if size <= len(whole))
    for limit in (*(len(whole) * k // early for k in range(early)), *late):
        with _largest_file(limit):
            said = _attempt(output, path)
        _count(row, f"{limit} bytes a file", said, path, whole)
    for room in range(1, disks + 1):
        pages = -(-len(whole) * room // (disks * PAGE))  # the last: all, but for the old file
        with _disk(folder, PAGE * pages) as disk:
            if disk is not None:
                place = disk / path.name
                place.write_bytes(OLD)
                said = _attempt(output, place)
                _count(row, f"disk {room}/{disks}", said, place, whole)
    path.unlink()
    return row


def _attempt(output: Output, path: Path) -> str | None:
    """One line of a refusal, None for a save; whatever else is raised begins with its name."""
    from surfmesh.errors import FileFormatError

    if path.read_bytes() != OLD:
        with _largest_file(None):
            path.write_bytes(OLD)
    try:
        output.write(path)
    except FileFormatError as error:
        return str(error)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return None


def _count(row: dict, limit: str, said: str | None, path: Path, whole: bytes) -> None:
    """One more attempt, judged."""
    content, beside = path.read_bytes(), sorted(entry.name for entry in path.parent.iterdir())
    refused = said is not None and said.startswith(f"{path}: ") and "\n" not in said
    if beside != [path.name]:
        fault = f"left behind: {beside}"
    elif said is None:
        fault = "" if content == whole else "said to be saved, and is broken"
    elif not refused:
        fault = f"no refusal in one line that names the file: {said[:200]}"
    else:
        fault = "" if content == OLD else "refused, and the old file has changed"
    row["tried"] += 1
    row["broken" if fault else "saved" if said is None else "refused"] += 1
    if fault:
        row["how"].append(f"{limit}: {fault}")


@contextmanager
def _largest_file(size: int | None) -> Iterator[None]:
    """No file may grow beyond ``size`` bytes; None: as large as this process may ask for."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (hard if size is None else size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@contextmanager
def _disk(folder: Path, size: int) -> Iterator[Path | None]:
    """A file system in memory of ``size`` bytes, or None where none may be mounted."""
    mount, umount = shutil.which("mount"), shutil.which("umount")
    with tempfile.TemporaryDirectory(dir=folder.parent) as place:
        options = ["-t", "tmpfs", "-o", f"size={size}", "surfmesh", place]
        mounted = False
        if mount and umount:
            mounted = not subprocess.run([mount, *options], capture_output=True).returncode
        try:
            yield Path(place) if mounted else None
        finally:
            if mounted:
                subprocess.run([umount, place], check=True)


def _rows(request: dict) -> dict:
    """The other side: rows of the outputs from ``request["from"]`` on, said one by one."""
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder:
        for output in outputs()[request["from"] :]:
            child_process.say({"_at": output.name})
            place = Path(folder, "saves")
            place.mkdir(exist_ok=True)
            for left in place.iterdir():
                left.unlink()
            child_process.say({output.name: row_of(output, place)})
    return {"_at": None}


if __name__ == "__main__":
    child_process.answer(_rows)
