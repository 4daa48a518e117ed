"""Write a file in full or not at all."""

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from surfmesh.errors import FileFormatError
from surfmesh.io.leftovers import created, sweep

_NO_FLUSH = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)  # file systems that cannot do it


def require_place(path: Path) -> Path:
    """The file that writing to ``path`` makes: the end of a link, or ``path`` itself.

    Raises ``FileFormatError`` when no file can be put there: a folder, a device or a pipe, a
    folder that is missing or cannot be written, a file that is read-only, a name that is too
    long.
    """
    try:
        target = Path(os.path.realpath(path)) if path.is_symlink() else path
        old = _status(path)
    except (OSError, ValueError) as error:  # ValueError: a NUL in it
        raise _refusal(path, error) from error
    if target.is_dir():
        raise FileFormatError(f"{path}: is a folder, not a file")
    if old is not None and not stat.S_ISREG(old.st_mode):
        raise FileFormatError(f"{path}: is a device or a pipe; only a file can be written")
    if not target.parent.is_dir():
        raise FileFormatError(f"{path}: the folder {target.parent} does not exist")
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise FileFormatError(f"{path}: cannot be written: no permission for {target.parent}")
    if old is not None and not os.access(target, os.W_OK):
        raise FileFormatError(f"{path}: cannot be written: the file is read-only")
    return target


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path`` that takes its place when the block ends well.

    It is flushed to the disk before. When the block raises, or the disk is full, the temporary
    file is removed and an old file at ``path`` stays as it was; what an old file permits, and
    whose it is, goes on to the new one. A link is followed: the file at its end is replaced. What
    killed processes left in the folder is swept up (see ``leftovers``).

    Raises ``FileFormatError`` for a place that cannot be written, as ``require_place`` does, and
    for every ``OSError``, which must thus be all that goes wrong when the block writes.
    """
    target = require_place(path)
    sweep(target.parent)  # first: it makes room
    try:
        old = _status(target)
        mode = 0o666 if old is None else stat.S_IMODE(old.st_mode) & 0o777 | 0o600
        temporary, held = created(target, path.suffix, mode)  # before any work goes into it
        try:
            yield temporary
            _permit_as(old, held.fileno())
            _flush(held.fileno())
            if os.name == "nt":  # an open file cannot be moved there
                held.close()
            os.replace(temporary, target)  # elsewhere under its lock: nobody sweeps it up
        finally:
            with suppress(OSError):
                temporary.unlink()
            held.close()
    except OSError as error:
        raise _refusal(path, error) from error


def _refusal(path: Path, error: OSError | ValueError) -> FileFormatError:
    reason = getattr(error, "strerror", None) or str(error)
    return FileFormatError(f"{path}: cannot be written: {reason}")


def _status(path: Path) -> os.stat_result | None:
    """Of the file at ``path``, at the end of links; None when there is none."""
    try:
        return os.stat(path)
    except (FileNotFoundError, NotADirectoryError):
        return None


def _permit_as(old: os.stat_result | None, descriptor: int) -> None:
    """Owner, group and permissions as ``old`` has them, as far as this user may give them."""
    if old is None or not hasattr(os, "fchown"):
        return
    new = os.fstat(descriptor)
    if (new.st_uid, new.st_gid) != (old.st_uid, old.st_gid):
        with suppress(OSError):
            os.fchown(descriptor, -1, old.st_gid)
        with suppress(OSError):
            os.fchown(descriptor, old.st_uid, -1)
    with suppress(OSError):
        os.fchmod(descriptor, stat.S_IMODE(old.st_mode) & 0o777)


def _flush(descriptor: int) -> None:
    """Until it is on the disk; a full disk may be known only then."""
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _NO_FLUSH:
            raise
