"""A CAD file read where it is asked for: a fault in OCP ends this process, and no limit holds.

The child that reads files safely does no other, and so does who trusts a file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.reading.ocp_import import import_ocp
from surfmesh.errors import CadError, SurfmeshError

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel


def model_of_file(
    path: Path, heal: bool, units: str | None, joining: Joining,
    load_ocp: Callable[[], None] = import_ocp, once_loaded: Callable[[], None] = lambda: None,
) -> CadModel:  # fmt: skip
    """The model in a file that exists. once_loaded: called when all that reads it is loaded.

    Raises CadError in words for whatever goes wrong in Python, but for MemoryError.
    """
    try:
        load_ocp()
        from surfmesh.cad.reading.readers import read_here
    except ImportError as error:
        raise CadError(f"CAD files need OCP ({error}): pip install 'surfmesh[cad]'") from None
    once_loaded()
    try:
        with _silent():
            return read_here(path, heal, units, joining)
    except (SurfmeshError, MemoryError):
        raise
    except Exception as error:  # OCP's own exceptions have no common parent in Python
        raise CadError(f"OCP gave up: {type(error).__name__} {error}".strip()) from error


@contextmanager
def _silent() -> Iterator[None]:
    """OCP's readers print what they find on standard output: not meanwhile, in any thread."""
    from OCP.Message import Message

    messenger = Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)
