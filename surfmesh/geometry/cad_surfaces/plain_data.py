"""Frozen dataclasses of numbers and read-only arrays, which travel between processes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from surfmesh.errors import SurfaceError
from surfmesh.geometry.number_range import RANGE


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


def poles_of(what: str, values: Sequence | np.ndarray) -> np.ndarray:
    """Control points (..., d), read-only; what: whose they are. Raises SurfaceError for one that is
    not finite, or too far away to compute with."""
    poles = frozen_array(values)
    places = poles.reshape(-1, poles.shape[-1]) if poles.ndim else poles.reshape(1, 1)
    bad = np.flatnonzero(~(np.abs(places) <= RANGE.coordinate).all(axis=1))  # nan too
    if len(bad):
        place = places[bad[0]]
        reason = "too far away to compute with" if np.isfinite(place).all() else "not finite"
        shown = ", ".join(f"{x:g}" for x in place)
        raise SurfaceError(f"{what}: the pole ({shown}) is {reason}")
    return poles


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
