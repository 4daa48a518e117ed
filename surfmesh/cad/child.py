"""``python -m surfmesh.cad.child REQUEST RESULT``: read one CAD file, hand it back pickled.

REQUEST: a JSON file with path, heal, units, imprint, sew. RESULT: a pickle of the model, or of
the message of the error that was met.
"""

import json
import pickle
import sys
from pathlib import Path

from surfmesh.errors import SurfmeshError


def main(request: str, result: str) -> None:
    """Whatever happens in Python ends as a message; what happens in OCP may end the process."""
    wanted = json.loads(Path(request).read_text(encoding="utf-8"))
    try:
        from surfmesh.cad.joining import Joining
        from surfmesh.cad.readers import read_here

        joining = Joining(wanted["imprint"], wanted["sew"])
        answer = read_here(Path(wanted["path"]), wanted["heal"], wanted["units"], joining)
    except SurfmeshError as error:
        answer = str(error)
    except MemoryError:
        answer = "it needs more memory than there is"
    except ImportError as error:
        answer = f"OCP cannot be imported ({error}); pip install cadquery-ocp"
    except Exception as error:  # OCP's own exceptions have no common parent in Python
        answer = f"OCP gave up: {type(error).__name__} {error}".strip()
    with open(result, "wb") as file:
        pickle.dump(answer, file, protocol=pickle.HIGHEST_PROTOCOL)


if __name__ == "__main__":
    main(*sys.argv[1:])
