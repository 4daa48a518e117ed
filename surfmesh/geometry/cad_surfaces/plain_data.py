"""Frozen dataclasses of numbers and read-only arrays, which travel between processes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class PlainData:
    """Copied and pickled by its fields; what is derived from them (init=False) is made anew."""

    def _set(self, **values: Any) -> None:
        """Fields and derived values, at construction only."""
        self.__dict__.update(values)

    def _given(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in dataclasses.fields(self) if f.init}

    def __reduce__(self) -> tuple:
        return _made, (type(self), self._given())

    def __repr__(self) -> str:
        shown = (f"{name}={_shown(value)}" for name, value in self._given().items())
        return f"{type(self).__name__}({', '.join(shown)})"


def frozen_array(values: Sequence | np.ndarray) -> np.ndarray:
    """A read-only view of a float array of its own."""
    view = np.array(values, dtype=float, order="C").view()
    view.setflags(write=False)
    return view


def _made(kind: type, fields: dict[str, Any]) -> PlainData:
    return kind(**fields)


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray):
        small = value.size <= 3
        return np.array2string(value, precision=6) if small else f"array{value.shape}"
    return repr(value)
