"""The model that a program makes with CadQuery or build123d.

What it shows with ``show_object`` counts, else its variable ``result``, else the only object of
these libraries that it leaves behind. The program runs in this process with all its rights: it is
only called where the user has asked for that.
"""

import runpy
import sys
from pathlib import Path
from typing import Any

from surfmesh.cad.cadquery.from_cadquery import from_cadquery
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import CadError, shown

LIBRARIES = ("cadquery", "build123d", "OCP")


def model_of_script(path: Path, **options: Any) -> CadModel:
    """Run the program and convert what it made; options: as of ``from_cadquery``.

    Raises ``CadError`` with what went wrong in it, and where it leaves nothing, or several things.
    """
    objects: list[Any] = []

    def show_object(thing: Any, *_: Any, **__: Any) -> None:
        objects.append(thing)

    before = list(sys.path)
    sys.path.insert(0, str(path.resolve().parent))
    try:
        left = runpy.run_path(str(path), {"show_object": show_object}, "__cq_main__")
    except Exception as error:
        raise CadError(f"{path}: {type(error).__name__}: {shown(str(error))}") from error
    finally:
        sys.path[:] = before
    if not objects and left.get("result") is not None:
        objects = [left["result"]]
    if not objects:
        found = {id(thing): thing for name, thing in left.items() if _is_model(name, thing)}
        objects = list(found.values())
        if len(objects) != 1:
            raise CadError(
                f"{path}: leaves {len(objects)} objects of CadQuery; call the one to mesh `result`"
            )
    return from_cadquery(objects[0] if len(objects) == 1 else objects, **options)


def _is_model(name: str, thing: Any) -> bool:
    home = type(thing).__module__.split(".")[0]
    return not name.startswith("_") and home in LIBRARIES and not isinstance(thing, type)
