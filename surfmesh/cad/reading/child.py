"""``python -m surfmesh.cad.reading.child``: read one CAD file, hand the model back.

Standard input: JSON with path, heal, units, imprint, sew, parent, seconds, megabytes. Standard
output: a pickle of the model, or of the message of the error that was met.
"""

import gc
import json
import os
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from surfmesh.cad.reading import ocp_import
from surfmesh.cad.reading.collector import paused
from surfmesh.cad.reading.lifeline import end_with
from surfmesh.cad.reading.limits import MORE_MEMORY

SELDOM = 100_000
"""New objects after which Python's collector looks for garbage."""


def main() -> None:
    """Whatever happens in Python ends as a message; what happens in OCP may end the process.

    Nothing is tidied up at the end: taking OCP's classes apart takes as long as making them.
    """
    wanted = json.load(sys.stdin)
    end_with(wanted["parent"])
    load_ocp = ocp_import.begun()
    with os.fdopen(os.dup(1), "wb") as result:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)  # OCP talks
        answer = answer_to(wanted, load_ocp)
        with paused():
            pickle.dump(answer, result, protocol=pickle.HIGHEST_PROTOCOL)
    sys.stderr.flush()
    os._exit(0)


def answer_to(wanted: dict[str, Any], load_ocp: Callable[[], None]) -> Any:
    """The model, or what was wrong in words. load_ocp: imports OCP."""
    # what needs no OCP, while the system loads that
    import surfmesh.cad.model.singular_cuts
    import surfmesh.cad.model.tolerances  # noqa: F401
    from surfmesh.cad.healing.joining import Joining
    from surfmesh.cad.reading.in_this_process import model_of_file
    from surfmesh.cad.reading.limits import Limits
    from surfmesh.errors import SurfmeshError

    def impose_limits() -> None:
        gc.freeze()  # what has been loaded stays, and need not be looked through
        gc.set_threshold(SELDOM)  # a model's objects stay, too
        Limits(wanted["seconds"], wanted["megabytes"]).impose()

    try:
        return model_of_file(
            Path(wanted["path"]), wanted["heal"], wanted["units"],
            Joining(wanted["imprint"], wanted["sew"]), load_ocp, impose_limits,
        )  # fmt: skip
    except SurfmeshError as error:
        return str(error)
    except MemoryError:
        return f"it takes more than {wanted['megabytes']:.4g} MB of memory to read; {MORE_MEMORY}"


if __name__ == "__main__":
    main()
