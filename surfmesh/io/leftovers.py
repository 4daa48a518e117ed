"""Temporary files while they are written, and what is left of them when their process is killed.

A temporary file is held by a lock of the operating system (flock), which ends with its process
however that ends. So a file of ours that can be locked is written by nobody any more.
"""

import hashlib
import os
import platform
import re
import secrets
import stat
import time
from contextlib import suppress
from functools import cache
from io import FileIO
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows has no such locks: there the age alone decides
    fcntl = None  # type: ignore[assignment]

AGE = 3600.0  # seconds without a change after which no lock has to speak for a file's end
_STEM, _SUFFIX = 20, 20  # characters of the target's name; all are below the 255 bytes of a name
_NAME = re.compile(r"\..{0,20}-([0-9a-f]{8})-[0-9a-f]{16}\.surfmesh-tmp(\..{0,19})?", re.DOTALL)
_FLAGS = getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_NOFOLLOW", 0)


def created(target: Path, suffix: str, mode: int) -> tuple[Path, FileIO]:
    """A new empty file beside ``target``, open, and locked until it is closed.

    suffix: that of its name, by which some writers know the format.

    mode: its permissions, less the umask. Raises ``OSError``.
    """
    while True:
        name = f".{target.stem[:_STEM]}-{_machine()}-{secrets.token_hex(8)}.surfmesh-tmp"
        temporary = target.with_name(name + suffix[:_SUFFIX])
        descriptor = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL | _FLAGS, mode)
        held = FileIO(descriptor, "r+")
        if _locked(descriptor) is not False and temporary.exists():
            return temporary, held
        held.close()  # swept up before it was locked


def sweep(folder: Path) -> list[Path]:
    """Remove temporary files of processes that ended without doing it; returns their paths.

    Removed is what has a name that only ``created`` gives, belongs to this user, and either was
    made on this machine since it was started and is locked by no process, or is locked by none
    that is known and was not changed for ``AGE``. Whatever cannot be looked at stays.
    """
    removed = []
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            name = _NAME.fullmatch(entry.name)
            if name:
                with suppress(OSError):
                    if _removed(entry.path, here=name[1] == _machine()):
                        removed.append(Path(entry.path))
    return removed


def held(mark: Path) -> FileIO:
    """A file that is there, open and locked until it is closed: its folder is in use.

    Raises ``OSError``.
    """
    file = FileIO(os.open(mark, os.O_RDWR | _FLAGS), "r+")
    _locked(file.fileno())
    file.write(_machine().encode())
    return file


def is_left(mark: Path) -> bool:
    """Did the process that ``held`` a file end without removing its folder? Judged as in ``sweep``,
    a change of the folder counts too. Not where it cannot be looked at."""
    with suppress(OSError), FileIO(os.open(mark, os.O_RDWR | _FLAGS), "r+") as file:
        here = file.read(8) == _machine().encode()
        return _is_left(file.fileno(), here, os.stat(mark.parent).st_mtime)
    return False


def _is_left(descriptor: int, here: bool, changed: float = 0.0) -> bool:
    """Does nobody write the open file any more? changed: when it was, at least."""
    found = os.fstat(descriptor)
    own = not hasattr(os, "geteuid") or found.st_uid == os.geteuid()
    old = time.time() - max(found.st_mtime, changed) > AGE
    free = _locked(descriptor)
    return own and free is not False and (old or (here and bool(free)))


def _removed(path: str, here: bool) -> bool:
    if not stat.S_ISREG(os.lstat(path).st_mode):
        return False
    descriptor = os.open(path, os.O_RDWR | _FLAGS)
    try:
        if not _is_left(descriptor, here):
            return False
        if fcntl is not None:
            os.unlink(path)  # while the lock is ours: nobody begins to write it
    finally:
        os.close(descriptor)
    if fcntl is None:  # an open file cannot be removed there
        os.unlink(path)
    return True


def _locked(descriptor: int) -> bool | None:
    """Lock a file: False when another process has it, None where there are no locks."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # some network drives
        return None
    return True


@cache
def _machine() -> str:
    """Eight hexadecimal digits that are the same where locks are seen by one another."""
    try:
        known = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii")
    except OSError:
        known = platform.node()
    return hashlib.sha256(known.encode()).hexdigest()[:8]
