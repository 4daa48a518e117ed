"""Reading a CAD file safely: in a child process with limits of processor time and memory.

OCP can crash, loop or grow on a bad file. Then the child ends, and the caller gets a `CadError`.
The child ends with the caller too, and there is no file that either could leave behind. Whoever
trusts a file may read it without a child, ``isolate=False``.

    begun_reading  --> child:  OCP ... file ... model --.
         |                                               |
         `-- the caller loads what it will need ------ model()

Nothing heavy is imported here, so that the child starts at once.
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
from typing import IO, TYPE_CHECKING, Any, Self

from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.reading.collector import paused
from surfmesh.cad.reading.limits import MORE_MEMORY, MORE_TIME, Limits, peak_megabytes
from surfmesh.cad.units import checked_unit
from surfmesh.errors import CadError
from surfmesh.result.model_facts import file_sha256
from surfmesh.truth_value import truth_value

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel

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
    isolate: bool = True,
) -> CadModel:
    """The model in a STEP (.step, .stp, .p21), IGES (.iges, .igs) or BREP (.brep, .brp) file.

    heal: repair what is wrong, and list it in the model's ``healing``. units: "um", "mm",
    "cm", "m", "in" or "ft", what lengths are wanted in (None: mm). imprint, sew: as in
    ``from_cadquery``.

    time_limit: seconds of processor time (on Windows of wall time); memory_limit: MB of memory
    that reading may take. None: what the environment variables SURFMESH_READ_SECONDS and
    SURFMESH_READ_MEMORY say, else by the size of the file, see ``cad.reading.limits``;
    inf: no limit.

    isolate=False reads a file that is trusted in this process: no child is started, OCP is
    imported here, no limit holds, and a fault in OCP ends this process.

    Raises CadError in one line when there is no model to be had.
    """
    with begun_reading(
        path, heal, units, time_limit, memory_limit, imprint=imprint, sew=sew, isolate=isolate
    ) as reading:
        return reading.model()


def begun_reading(
    path: str | Path,
    heal: bool = True,
    units: str | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    *,
    imprint: bool | float = False,
    sew: float | None = None,
    isolate: bool = True,
) -> Reading:
    """``read_cad`` begun: a child reads while the caller does something else.

    To be used in a ``with`` statement: a child whose model is not waited for is ended.
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
    heal, joining = truth_value("heal", heal, CadError), Joining.of(imprint, sew)
    if not truth_value("isolate", isolate, CadError):
        if time_limit is not None or memory_limit is not None:
            raise CadError("limits of time and memory hold in a child process alone: leave them "
                           "out, or the file is read with isolate=True")  # fmt: skip
        return _ReadingHere(place, heal, units, joining)
    limits = Limits.of(place, time_limit, memory_limit, bool(joining))
    wanted = {"path": str(place.resolve()), "heal": heal, "units": units}
    wanted |= {"imprint": joining.imprint, "sew": joining.sew}
    command = [sys.executable, "-P", "-m", "surfmesh.cad.reading.child"]
    return _ReadingByChild(place, Child(command, wanted, place.name, limits))


class Reading:
    """A file that is being read; the end of a ``with`` statement ends what has not ended."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None: ...

    def model(self) -> CadModel:
        """Wait for the model. Raises CadError in one line when there is none to be had."""
        raise NotImplementedError


class _ReadingByChild(Reading):
    def __init__(self, path: Path, child: Child) -> None:
        super().__init__(path)
        self._child = child

    def __exit__(self, *_: object) -> None:
        self._child.end()

    def model(self) -> CadModel:
        digest = file_sha256(self.path)
        answer = self._child.answer()
        if isinstance(answer, str):
            raise CadError(_with_name(answer, self.path))
        return replace(answer, sha256=digest)


class _ReadingHere(Reading):
    def __init__(self, path: Path, heal: bool, units: str | None, joining: Joining) -> None:
        super().__init__(path)
        self._how = heal, units, joining

    def model(self) -> CadModel:
        from surfmesh.cad.reading.in_this_process import model_of_file

        try:
            found = model_of_file(self.path, *self._how)
        except CadError as error:
            raise CadError(_with_name(str(error), self.path)) from error
        return replace(found, sha256=file_sha256(self.path))


def _with_name(said: str, path: Path) -> str:
    return said if path.name in said else f"{path.name}: {said}"


class Child:
    """A process that takes ``wanted`` as JSON and writes a pickle; it imposes limits on itself.

    name: of the file that it reads. Raises CadError when it cannot be started.
    """

    def __init__(
        self, command: list[str], wanted: Mapping[str, Any], name: str, limits: Limits
    ) -> None:
        self.name, self.limits = name, limits
        own = {"parent": os.getpid(), "seconds": limits.seconds, "megabytes": limits.megabytes}
        # files without a name: nothing is left behind when this process is killed
        self._result: IO[bytes] = tempfile.TemporaryFile()
        self._complaints: IO[bytes] = tempfile.TemporaryFile()
        try:
            with tempfile.TemporaryFile() as request:
                request.write(json.dumps({**wanted, **own}).encode())
                request.seek(0)
                self._process = subprocess.Popen(  # noqa: S603 a list of our own, no shell
                    command, stdin=request, stdout=self._result, stderr=self._complaints,
                    env={**os.environ, "PYTHONPATH": _import_path()},
                )  # fmt: skip
        except OSError as error:
            self._close()
            raise CadError(f"{name}: no process could be started to read it ({error})") from None

    def answer(self) -> Any:
        """Wait for the end, and load what it wrote.

        Raises CadError when it crashes, goes beyond the limits, or leaves no result.
        """
        code, peak = self._ended()
        for file in (self._result, self._complaints):
            file.seek(0)
        if code < 0:
            raise CadError(_death(self.name, -code, peak, self.limits))
        if code or not self._result.read(1):
            said = self._complaints.read().decode(errors="replace").strip().splitlines()
            reason = said[-1] if said else f"status {code}"
            reason += f"; {MORE_MEMORY}" if "memory" in reason.lower() else ""
            raise CadError(f"{self.name} made the CAD reader fail: {reason}")
        self._result.seek(0)
        with paused():
            return pickle.load(self._result)  # noqa: S301 our own child's, in a file without a name

    def _ended(self) -> tuple[int, float]:
        """How it ended, minus the number of the signal that ended it, and its peak in MB."""
        try:
            if sys.platform == "win32":  # which has no limits for a process: the wall's clock
                wall = self.limits.seconds if self.limits.seconds < WEEK else None
                return self._process.wait(wall), 0.0
            _, status, usage = os.wait4(self._process.pid, 0)
            self._process.returncode = os.waitstatus_to_exitcode(status)
            return self._process.returncode, peak_megabytes(usage)
        except subprocess.TimeoutExpired:
            return -TIME_SIGNAL, 0.0

    def end(self) -> None:
        """End it if it has not ended; what it wrote is gone."""
        if self._process.returncode is None:
            self._process.kill()
            self._process.wait()
        self._close()

    def _close(self) -> None:
        self._result.close()
        self._complaints.close()


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
