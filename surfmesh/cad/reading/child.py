"""``python -m surfmesh.cad.reading.child``: read one CAD file, hand the model back.

Standard input: JSON with path, heal, units, imprint, sew, parent, seconds, megabytes. Standard
output: a pickle of the model, or of the message of the error that was met.
"""

import json
import os
import pickle
import sys
from pathlib import Path
from typing import Any

from surfmesh.cad.reading.lifeline import end_with
from surfmesh.cad.reading.limits import MORE_MEMORY
from surfmesh.errors import SurfmeshError


def main() -> None:
    """Whatever happens in Python ends as a message; what happens in OCP may end the process."""
    wanted = json.load(sys.stdin)
    end_with(wanted["parent"])
    with os.fdopen(os.dup(1), "wb") as result:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)  # OCP talks
        answer = answer_to(wanted)
        pickle.dump(answer, result, protocol=pickle.HIGHEST_PROTOCOL)


def answer_to(wanted: dict[str, Any]) -> Any:
    """The model, or what was wrong in words."""
    try:
        from surfmesh.cad.healing.joining import Joining
        from surfmesh.cad.reading.limits import Limits
        from surfmesh.cad.reading.readers import read_here

        limits = Limits(wanted["seconds"], wanted["megabytes"])
        limits.impose()
        joining = Joining(wanted["imprint"], wanted["sew"])
        return read_here(Path(wanted["path"]), wanted["heal"], wanted["units"], joining)
    except SurfmeshError as error:
        return str(error)
    except MemoryError:
        return f"it takes more than {wanted['megabytes']:.4g} MB of memory to read; {MORE_MEMORY}"
    except ImportError as error:
        return f"OCP cannot be imported ({error}); pip install cadquery-ocp"
    except Exception as error:  # OCP's own exceptions have no common parent in Python
        return f"OCP gave up: {type(error).__name__} {error}".strip()


if __name__ == "__main__":
    main()
