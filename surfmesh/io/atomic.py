"""Write a file in full or not at all."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from surfmesh.errors import FileFormatError


def require_place(path: Path) -> None:
    """Raise ``FileFormatError`` when no file can be put at ``path``."""
    if path.is_dir():
        raise FileFormatError(f"{path}: is a folder, not a file")
    if not path.parent.is_dir():
        raise FileFormatError(f"{path}: the folder {path.parent} does not exist")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise FileFormatError(f"{path}: cannot be written: no permission for {path.parent}")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path`` that takes its place when the block ends well.

    When the block raises, the temporary file is removed and an old file at ``path`` stays as
    it was. Raises ``FileFormatError`` when the folder is missing or cannot be written.
    """
    require_place(path)
    temporary = path.parent / f".{path.stem[:50]}-{secrets.token_hex(4)}{path.suffix}"
    try:
        with open(temporary, "xb"):  # known to be writable before any work goes into it
            pass
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileFormatError(f"{path}: cannot be written: {reason}") from error
    finally:
        with suppress(OSError):
            temporary.unlink()
