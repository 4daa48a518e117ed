"""What an HDF5 file may announce, looked at before other libraries read it."""

from pathlib import Path
from typing import Any

from surfmesh.errors import FileFormatError
from surfmesh.io.expansion import Expansion

COUNTS = ("NBR", "NGA")  # attributes of MED: how many values there are, and points in a cell


def require_bounded(path: Path, file: Any) -> None:
    """Raise ``FileFormatError`` for arrays that unpack to far more than the file, for numbers of
    values beyond what its arrays hold, and for what stands in other files.

    file: an ``h5py.File``.
    """
    import h5py

    expansion = Expansion(path, path.stat().st_size)
    counts: list[tuple[str, str, Any]] = []
    held = 0

    def look(name: str, found: Any) -> None:
        nonlocal held
        counts.extend((name, key, found.attrs[key]) for key in COUNTS if key in found.attrs)
        if isinstance(found, h5py.Dataset):
            if found.external or found.is_virtual:
                raise FileFormatError(f"{path}: its array {name:.60} is in another file")
            expansion.take(int(found.size or 0) * found.dtype.itemsize)
            held += int(found.size or 0)
        else:
            for key in found:
                if isinstance(found.get(key, getlink=True), h5py.ExternalLink):
                    raise FileFormatError(f"{path}: {name:.60}/{key:.60} is in another file")

    look("", file)
    file.visititems(look)
    for name, key, value in counts:
        if not 0 <= int(value) <= held:
            raise FileFormatError(
                f"{path}: {name:.60} has {key} {str(value)[:40]}, and the file holds {held} "
                "numbers: it is damaged"
            )
