"""The one decorator that compiles every kernel.

``@kernel`` is ``numba.njit`` with four additions:

- its cache lies in a folder whose name carries a digest of *all* kernel sources, because
  numba's own cache looks only at the file of the outermost function and would run stale
  code after an edit of a callee;
- divisions follow numpy (no exception is raised inside a kernel; guard each division);
- array arguments are not reference-counted (``_nrt``): a kernel owns no memory, and counting
  a dozen arrays at every call costs five times what the kernel does;
- other threads run meanwhile (``nogil``): faces are meshed side by side;

``compiled_before`` tells whether the cache is filled, so that the user can be told what the
first wait is for.
"""

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

import numba
from numba.core.caching import FunctionCache, _CacheLocator

_SOURCES = sorted(Path(__file__).parent.glob("*.py"))


def _digest() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for path in _SOURCES:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """Where compiled kernels are kept: $SURFMESH_CACHE_DIR, or the user's cache folder."""
    chosen = os.environ.get("SURFMESH_CACHE_DIR")
    if chosen:
        return Path(chosen) / f"kernels-{_DIGEST}"
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "surfmesh" / f"kernels-{_DIGEST}"


_DIGEST = _digest()


class _DigestLocator(_CacheLocator):
    def __init__(self, py_func: Callable, py_file: str) -> None:
        self._line = py_func.__code__.co_firstlineno
        self._path = str(cache_folder())

    def get_cache_path(self) -> str:
        return self._path

    def get_source_stamp(self) -> str:
        return _DIGEST

    def get_disambiguator(self) -> str:
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> "_DigestLocator | None":
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()
        except OSError:
            return None
        return locator


class _KernelCacheImpl(FunctionCache._impl_class):
    _locator_classes: ClassVar = [_DigestLocator, *FunctionCache._impl_class._locator_classes]


class _KernelCache(FunctionCache):
    _impl_class = _KernelCacheImpl


def compiled_before() -> bool:
    """Whether kernels of these sources have been compiled on this machine."""
    return any(cache_folder().glob("*.nbi"))


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
