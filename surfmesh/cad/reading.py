"""Reading a CAD file safely: in a child process, with a time limit.

OCP can crash or loop on a bad file. Then the child ends, and the caller gets a `CadError`.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from surfmesh.cad.assembly import checked_unit
from surfmesh.cad.joining import Joining
from surfmesh.cad.model import CadModel
from surfmesh.errors import CadError
from surfmesh.model_facts import file_sha256

SUFFIXES = (".step", ".stp", ".p21", ".iges", ".igs", ".brep", ".brp")
TIME_LIMIT = 120.0  # seconds
JOINING_TIME_LIMIT = 900.0  # the same where bodies are imprinted or faces sewn


def read_cad(
    path: str | Path,
    heal: bool = True,
    units: str | None = None,
    time_limit: float | None = TIME_LIMIT,
    *,
    imprint: bool | float = False,
    sew: float | None = None,
) -> CadModel:
    """The model in a STEP (.step, .stp, .p21), IGES (.iges, .igs) or BREP (.brep, .brp) file.

    heal: repair what is wrong, and list it in the model's ``healing``. units: "um", "mm",
    "cm", "m", "in" or "ft", what lengths are wanted in (None: mm). time_limit: seconds, or
    None. imprint, sew: as in ``from_cadquery``. Raises CadError in one line when there is no
    model to be had.
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
    with tempfile.TemporaryDirectory(prefix="surfmesh-") as folder:
        request, result = Path(folder, "request.json"), Path(folder, "result.pickle")
        wanted = {"path": str(place.resolve()), "heal": bool(heal), "units": units}
        wanted |= {"imprint": joining.imprint, "sew": joining.sew}
        request.write_text(json.dumps(wanted), encoding="utf-8")
        command = [sys.executable, "-P", "-m", "surfmesh.cad.child", str(request), str(result)]
        answer = answer_of(command, result, place.name, time_limit)
    if isinstance(answer, str):
        raise CadError(answer if place.name in answer else f"{place.name}: {answer}")
    return replace(answer, sha256=file_sha256(place))


def answer_of(command: list[str], result: Path, name: str, time_limit: float | None) -> Any:
    """Run a child that writes a pickle to ``result``, and load it; name: of the file it reads.

    Raises CadError when the child crashes, takes too long, or leaves no result.
    """
    try:
        done = subprocess.run(  # noqa: S603 a list of our own, no shell
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,  # OCP talks
            stderr=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": _import_path()},
            timeout=time_limit,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise CadError(
            f"{name} was not read within {time_limit:g} s; allow more with time_limit="
        ) from None
    except OSError as error:
        raise CadError(f"{name}: no process could be started to read it ({error})") from None
    if done.returncode < 0:
        raise CadError(
            f"{name} made the CAD reader crash ({_signal_name(-done.returncode)}); "
            "export it again, perhaps in another format"
        )
    if done.returncode or not result.exists():
        said = done.stderr.decode(errors="replace").strip().splitlines()
        reason = said[-1] if said else f"status {done.returncode}"
        raise CadError(f"{name} made the CAD reader fail: {reason}")
    with open(result, "rb") as file:
        return pickle.load(file)  # noqa: S301 our own child's, in a folder of our own


def _import_path() -> str:
    """Where this process finds its modules, so that the child finds the same."""
    own = str(Path(__file__).resolve().parents[2])
    return os.pathsep.join(dict.fromkeys([own, *(p for p in sys.path if os.path.isabs(p))]))


def _signal_name(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
    return f"{name}, perhaps for want of memory" if name == "SIGKILL" else name
