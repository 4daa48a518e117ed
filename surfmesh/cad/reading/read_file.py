"""Reading a CAD file safely: in a child process with limits of processor time and memory.

OCP can crash, loop or grow on a bad file. Then the child ends, and the caller gets a `CadError`.
The child ends with the caller too, and there is no file that either could leave behind.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.reading.limits import MORE_MEMORY, MORE_TIME, Limits, peak_megabytes
from surfmesh.cad.units import checked_unit
from surfmesh.errors import CadError
from surfmesh.result.model_facts import file_sha256

SUFFIXES = (".step", ".stp", ".p21", ".iges", ".igs", ".brep", ".brp")
WEEK = 604800.0  # seconds; longer is no limit
TIME_SIGNAL = 27  # SIGPROF, of the timer that ``Limits.impose`` sets
MEMORY_SIGNALS = ("SIGABRT", "SIGKILL")  # of an allocation that nobody caught; of the system


def read_cad(
    path: str | Path,
    heal: bool = True,
    units: str | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    *,
    imprint: bool | float = False,
    sew: float | None = None,
) -> CadModel:
    """The model in a STEP (.step, .stp, .p21), IGES (.iges, .igs) or BREP (.brep, .brp) file.

    heal: repair what is wrong, and list it in the model's ``healing``. units: "um", "mm",
    "cm", "m", "in" or "ft", what lengths are wanted in (None: mm). imprint, sew: as in
    ``from_cadquery``.

    time_limit: seconds of processor time (on Windows of wall time); memory_limit: MB of memory
    that reading may take. None: what the environment variables SURFMESH_READ_SECONDS and
    SURFMESH_READ_MEMORY say, else by the size of the file, see ``cad.reading.limits``;
    inf: no limit.

    Raises CadError in one line when there is no model to be had.
    """
    place = Path(path)
    if place.suffix.lower() not in SUFFIXES:
        raise CadError(f"{place.name} is not known as a CAD file: use {', '.join(SUFFIXES)}")
    if not place.exists():
        raise CadError(f"there is no file {str(place)!r}")
    if not place.is_file():
        raise CadError(f"{place.name} is not a file")
    if place.stat().st_size == 0:
        raise CadError(f"{place.name} is empty")
    checked_unit(units)
    joining = Joining.of(imprint, sew)
    limits = Limits.of(place, time_limit, memory_limit, bool(joining))
    wanted = {"path": str(place.resolve()), "heal": bool(heal), "units": units}
    wanted |= {"imprint": joining.imprint, "sew": joining.sew}
    command = [sys.executable, "-P", "-m", "surfmesh.cad.reading.child"]
    answer = answer_of(command, wanted, place.name, limits)
    if isinstance(answer, str):
        raise CadError(answer if place.name in answer else f"{place.name}: {answer}")
    return replace(answer, sha256=file_sha256(place))


def answer_of(command: list[str], wanted: Mapping[str, Any], name: str, limits: Limits) -> Any:
    """Run a child that takes ``wanted`` as JSON and writes a pickle, and load it.

    name: of the file that it reads. Raises CadError when the child crashes, goes beyond the
    limits, which it imposes on itself, or leaves no result.
    """
    own = {"parent": os.getpid(), "seconds": limits.seconds, "megabytes": limits.megabytes}
    # files without a name: nothing is left behind when this process is killed
    with (
        tempfile.TemporaryFile() as request,
        tempfile.TemporaryFile() as result,
        tempfile.TemporaryFile() as complaints,
    ):
        request.write(json.dumps({**wanted, **own}).encode())
        request.seek(0)
        try:
            code, peak = _ended(command, (request, result, complaints), limits)
        except OSError as error:
            raise CadError(f"{name}: no process could be started to read it ({error})") from None
        for file in (result, complaints):
            file.seek(0)
        if code < 0:
            raise CadError(_death(name, -code, peak, limits))
        if code or not result.read(1):
            said = complaints.read().decode(errors="replace").strip().splitlines()
            reason = said[-1] if said else f"status {code}"
            reason += f"; {MORE_MEMORY}" if "memory" in reason.lower() else ""
            raise CadError(f"{name} made the CAD reader fail: {reason}")
        result.seek(0)
        return pickle.load(result)  # noqa: S301 our own child's, in a file without a name


def _ended(
    command: list[str], files: tuple[IO[bytes], IO[bytes], IO[bytes]], limits: Limits
) -> tuple[int, float]:
    """How the child ended, minus the number of the signal that ended it, and its peak in MB."""
    where = {**os.environ, "PYTHONPATH": _import_path()}
    child = subprocess.Popen(  # noqa: S603 a list of our own, no shell
        command, stdin=files[0], stdout=files[1], stderr=files[2], env=where
    )
    try:
        if sys.platform == "win32":  # which has no limits for a process: those of the wall's clock
            wall = limits.seconds if limits.seconds < WEEK else None
            return child.wait(wall), 0.0
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        return child.returncode, peak_megabytes(usage)
    except subprocess.TimeoutExpired:
        return -TIME_SIGNAL, 0.0
    finally:
        if child.returncode is None:
            child.kill()
            child.wait()


def _death(name: str, number: int, peak: float, limits: Limits) -> str:
    """What to say of a child that was ended by a signal; peak: its memory in MB."""
    if number == TIME_SIGNAL:
        took = f" (and {peak:.0f} MB)" if peak else ""
        within = f"{limits.seconds:.3g} s of processor time{took}"
        return f"{name} was not read within {within}; {MORE_TIME}"
    try:
        signal_name = signal.Signals(number).name
    except ValueError:
        signal_name = f"signal {number}"
    if signal_name in MEMORY_SIGNALS or peak > 0.5 * limits.megabytes:
        signal_name += f", perhaps for want of memory: {MORE_MEMORY}"
    return (
        f"{name} made the CAD reader crash ({signal_name}); "
        "export it again, perhaps in another format"
    )


def _import_path() -> str:
    """Where this process finds its modules, so that the child finds the same."""
    own = str(Path(__file__).resolve().parents[3])
    return os.pathsep.join(dict.fromkeys([own, *(p for p in sys.path if os.path.isabs(p))]))
