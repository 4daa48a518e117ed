"""The one decorator that compiles every kernel.

``@kernel`` is ``numba.njit`` with five additions:

- its cache lies in a folder whose name carries a digest of *all* kernel sources, because
  numba's own cache looks only at the file of the outermost function and would run stale
  code after an edit of a callee;
- its files carry a checksum of what they hold and of what it is for: a damaged one is made anew,
  where numba would raise or run it. A folder that others may write to is not used, as what lies
  in it is run. Where nothing can be kept, kernels are compiled in memory;
- divisions follow numpy (no exception is raised inside a kernel; guard each division);
- array arguments are not reference-counted (``_nrt``): a kernel owns no memory, and counting
  a dozen arrays at every call costs five times what the kernel does;
- other threads run meanwhile (``nogil``): faces are meshed side by side;

``compiled_before`` tells whether the cache is filled, so that the user can be told what the
first wait is for.
"""

import hashlib
import os
import pickle
import stat
import sys
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile, _CacheLocator

_FOLDER = Path(__file__).parent
_SOURCES = sorted(_FOLDER.rglob("*.py"))


def _digest() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for path in _SOURCES:
        name = path.relative_to(_FOLDER).as_posix()
        digest.update(name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """Where compiled kernels are kept: $SURFMESH_CACHE_DIR, or the user's cache folder.

    Raises ``RuntimeError`` when the user has no home.
    """
    chosen = os.environ.get("SURFMESH_CACHE_DIR")
    if chosen:
        return Path(chosen) / f"kernels-{_DIGEST}"
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "surfmesh" / f"kernels-{_DIGEST}"


_DIGEST = _digest()


def keeps_kernels() -> bool:
    """Whether there is a folder to keep them in."""
    return isinstance(_folder_or_reason(), Path)


def compiled_before() -> bool:
    """Whether kernels of these sources have been compiled on this machine."""
    folder = _folder_or_reason()
    return isinstance(folder, Path) and any(folder.glob("*.nbi"))


def _folder_or_reason() -> Path | str:
    """The folder, or why there is none."""
    try:
        folder = cache_folder()
    except RuntimeError as error:
        return f"compiled kernels cannot be kept: {error}"
    reason = _unusable(folder)
    return folder if reason is None else f"compiled kernels cannot be kept in {folder}: {reason}"


@cache
def _unusable(folder: Path) -> str | None:
    """Why a folder, made where it is missing, is not one that this user alone can write to."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        state = folder.lstat()
    except (OSError, ValueError) as error:
        return getattr(error, "strerror", None) or str(error)
    if not stat.S_ISDIR(state.st_mode):
        return "it is no folder"
    if not hasattr(os, "getuid"):
        return None
    if state.st_uid != os.getuid():
        return "it belongs to another user"
    others = state.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return "others may write to it (chmod 700 mends that)" if others else None


_said: set[str] = set()


def _say_once(kind: str, text: str) -> None:
    if kind not in _said:
        _said.add(kind)
        warnings.warn(text, stacklevel=3)


def _say_not_kept(reason: str) -> None:
    _say_once(
        "not kept",
        f"{reason}; they are compiled in every process, which takes about half a minute. "
        "SURFMESH_CACHE_DIR names another folder",
    )


class _Damaged(Exception):
    """A file whose checksum does not fit."""


class _CheckedFiles(IndexDataCacheFile):
    """The index and the data of one kernel, each file after the checksum of it and its purpose.

    The purpose of data is the key in the index: two processes may write to one name at once.
    """

    def load(self, key: Any) -> Any:
        name = self._load_index().get(key)
        if name is None:
            return None
        path = Path(self._data_path(name))
        # the index may know what a killed process has not written
        return pickle.loads(_read(path, repr(key))) if path.exists() else None  # noqa: S301 own

    def save(self, key: Any, data: Any) -> None:
        try:
            known = self._load_index()
        except (_Damaged, OSError):
            known = {}
        numbers = range(1, len(known) + 2)
        free = next(n for k in numbers if (n := self._data_name(k)) not in known.values())
        name = known.setdefault(key, free)
        self._write(self._data_path(name), repr(key), data)
        self._write(self._index_path, self._source_stamp, known)

    def _load_index(self) -> dict[Any, str]:
        path = Path(self._index_path)
        return pickle.loads(_read(path, self._source_stamp)) if path.exists() else {}  # noqa: S301

    def _write(self, path: str, purpose: str, content: Any) -> None:
        data = self._dump(content)
        with self._open_for_write(path) as file:
            file.write(_checksum(purpose, data) + data)


def _read(path: Path, purpose: str) -> bytes:
    content = path.read_bytes()
    checksum, data = content[:_CHECKSUM], content[_CHECKSUM:]
    if checksum != _checksum(purpose, data):
        raise _Damaged(path.name)
    return data


def _checksum(purpose: str, data: bytes) -> bytes:
    return hashlib.sha256(purpose.encode() + b"\0" + data).digest()


_CHECKSUM = len(_checksum("", b""))


class _DigestLocator(_CacheLocator):
    def __init__(self, py_func: Callable, py_file: str) -> None:
        self._line = py_func.__code__.co_firstlineno
        folder = _folder_or_reason()
        self._path = str(folder) if isinstance(folder, Path) else os.devnull

    def get_cache_path(self) -> str:
        return self._path

    def ensure_cache_path(self) -> None:
        """It was made when it was looked at."""

    def get_source_stamp(self) -> str:
        return _DIGEST

    def get_disambiguator(self) -> str:
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> "_DigestLocator":
        return cls(py_func, py_file)


class _KernelCacheImpl(FunctionCache._impl_class):
    _locator_classes: ClassVar = [_DigestLocator]


class _KernelCache(FunctionCache):
    """Compiles where it cannot read, says so once where it cannot write."""

    _impl_class = _KernelCacheImpl

    def __init__(self, py_func: Callable) -> None:
        super().__init__(py_func)
        self._cache_file = _CheckedFiles(self._cache_path, self._impl.filename_base, _DIGEST)
        found = _folder_or_reason()
        self._reason = found if isinstance(found, str) else None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        if self._reason is not None:
            _say_not_kept(self._reason)
            return None
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # whatever a file that is no kernel's brings about
            kind = "damaged" if isinstance(error, _Damaged) else f"not readable ({error})"
            _say_once(
                "damaged", f"compiled kernels in {self._cache_path} are {kind}; they are made anew"
            )
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        if self._reason is not None:
            return
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _say_not_kept(
                f"compiled kernels cannot be kept in {self._cache_path}: {error.strerror or error}"
            )


def kernel(function: Callable) -> Callable:
    """Compile ``function`` in nopython mode, cached on disk; see the module's docstring."""
    return _compiled(function)


def inlined_kernel(function: Callable) -> Callable:
    """A kernel whose machine code is put in the place of every call.

    A call copies all array descriptors of a state tuple, a kilobyte for a whole packing: what
    runs several times a circle, from few places, is worth it.
    """
    # a bounds check that is inlined so fails without cause (numba 0.68)
    return _compiled(function, forceinline=not numba.config.BOUNDSCHECK)


def _compiled(function: Callable, **more: bool) -> Callable:
    options = {"error_model": "numpy", "_nrt": False, "nogil": True, **more}
    dispatcher = numba.njit(**options)(function)
    if hasattr(dispatcher, "_cache"):  # a plain function under NUMBA_DISABLE_JIT
        dispatcher._cache = _KernelCache(function)
    return dispatcher
