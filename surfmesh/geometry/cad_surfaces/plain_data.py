"""Frozen dataclasses of numbers and read-only arrays, which travel between processes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class PlainData:
    """Copied and pickled by its fields; what is derived from them (init=False) is made anew."""

    def _set(self, **values: Any) -> None:
        """Fields and derived values, at construction only."""
        self.__dict__.update(values)

    def _given(self) -> dict[str, Any]:
        kind: type = type(self)
        return {name: getattr(self, name) for name in _names_given(kind)}

    def __reduce__(self) -> tuple:
        return _made, (type(self), {name: _light(v) for name, v in self._given().items()})

    def __repr__(self) -> str:
        shown = (f"{name}={_shown(value)}" for name, value in self._given().items())
        return f"{type(self).__name__}({', '.join(shown)})"


def frozen_array(values: Sequence | np.ndarray) -> np.ndarray:
    """A read-only float array of its own."""
    array = np.array(values, dtype=float, order="C")
    array.setflags(write=False)
    return array


@cache
def _names_given(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind) if field.init)


def _light(value: Any) -> Any:
    """Points and directions as plain numbers, which travel faster; ``frozen_array`` takes them."""
    small = isinstance(value, np.ndarray) and value.ndim == 1 and value.size <= 3
    return tuple(value.tolist()) if small else value


def _made(kind: type, fields: dict[str, Any]) -> PlainData:
    return kind(**fields)


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray):
        small = value.size <= 3
        return np.array2string(value, precision=6) if small else f"array{value.shape}"
    return repr(value)
