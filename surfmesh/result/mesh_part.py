"""Groups of arrays that say of themselves what their rows stand for and what numbers they hold.

    triangles: Int32Array = field(metadata=rows(np.int32, TRIANGLE, 3, holds=VERTEX))
    face_ids: Int32Array = field(metadata=rows(np.int32, TRIANGLE))

Checks of their shapes follow from that, and what becomes of them when things are left out,
repeated or numbered anew: a new array is declared, and nothing else has to know of it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
Int32Array = NDArray[np.int32]
BoolArray = NDArray[np.bool_]

VERTEX, TRIANGLE, CORNER, EDGE = "vertex", "triangle", "corner", "edge"
FACE, SEGMENT, CAD_VERTEX = "face", "segment", "CAD vertex"
ANY = "anything"  # rows that may be of any number
_KEY = "rows"


class Rows(NamedTuple):
    """What an array holds: ``columns`` numbers of ``dtype`` for each thing of a kind."""

    dtype: type
    of: str  # the kind of thing that a row belongs to
    columns: tuple[int, ...]  # shape of a row
    holds: str | None  # the kind of thing that its numbers are numbers of; -1: of none

    def fitted(self, name: str, value: ArrayLike, counts: Mapping[str, int]) -> NDArray[Any]:
        """``value`` as such an array, read-only. Raises ``ValueError`` when its shape is another.

        counts: how many things there are of each kind, as far as that is known.
        """
        if self.dtype is np.int32:
            value = _within_int32(name, value)
        array: NDArray[Any] = np.ascontiguousarray(value, self.dtype)
        shape = (counts.get(self.of, -1), *self.columns)
        fits = array.ndim == len(shape) and all(
            wanted in (-1, found) for wanted, found in zip(shape, array.shape)
        )
        if not fits:
            raise ValueError(f"{name} has shape {array.shape}, expected {shape} (-1: any)")
        array.setflags(write=False)
        return array


def rows(dtype: type, of: str, *columns: int, holds: str | None = None) -> dict[str, Rows]:
    """Metadata of a field that is an array, or None where it has that default."""
    return {_KEY: Rows(dtype, of, columns, holds)}


class Renumbering(NamedTuple):
    """What becomes of the things of one kind."""

    rows: NDArray[Any]  # (new count,) the old one that each comes from
    number: NDArray[Any] | None = None  # (old count,) its new number, -1: gone; None: the same

    @classmethod
    def keeping(cls, kept: NDArray[Any], count: int, becomes: NDArray[Any] | None = None) -> Self:
        """Those ``kept`` (k,) of ``count`` things, numbered in this order.

        becomes: (count,) the one that takes the place of each, by default itself.
        """
        number = np.full(count, -1)
        number[kept] = np.arange(len(kept))
        return cls(kept, number if becomes is None else number[becomes])


def array_fields(holder: Any) -> Iterator[tuple[str, Rows]]:
    """Names of the arrays of a dataclass, or of one of its kind, and what they hold."""
    return ((item.name, item.metadata[_KEY]) for item in fields(holder) if _KEY in item.metadata)


def fit(holder: Any, counts: Mapping[str, int]) -> dict[str, int]:
    """Check the shapes of the arrays of ``holder``; each is converted where it has to be, and made
    read-only. Of kinds not among ``counts`` the first array says how many there are.

    Returns all counts. Raises ``ValueError`` when shapes do not agree or an array is missing.
    """
    known = dict(counts)
    needed = {item.name for item in fields(holder) if item.default is MISSING}
    held = {name: getattr(holder, name) for name, _ in array_fields(holder)}
    for name, kind in array_fields(holder):
        if held[name] is not None:
            array = kind.fitted(name, held[name], known)
            object.__setattr__(holder, name, array)
            if kind.of != ANY:
                known.setdefault(kind.of, len(array))
        elif name in needed:
            given = next((other for other, value in held.items() if value is not None), "nothing")
            raise ValueError(f"{given} given without {name}")
    return known


def renumbered_arrays(holder: Any, kinds: Mapping[str, Renumbering]) -> dict[str, Any]:
    """By name the arrays of ``holder`` that change: their rows, or their numbers, are of
    ``kinds``."""
    changes: dict[str, Any] = {}
    for name, kind in array_fields(holder):
        value = getattr(holder, name)
        if value is None:
            continue
        if kind.of in kinds:
            changes[name] = value = value[kinds[kind.of].rows]
        number = kinds[kind.holds].number if kind.holds and kind.holds in kinds else None
        if number is not None:
            changes[name] = np.where(value >= 0, number[value], -1)
    return changes


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshPart:
    """A part of a mesh, which holds its own arrays to their shapes."""

    def __post_init__(self) -> None:
        fit(self, {})

    def renumbered(self, kinds: Mapping[str, Renumbering]) -> Self:
        """The part with every array that is of ``kinds``, or holds their numbers, changed so."""
        return replace(self, **renumbered_arrays(self, kinds))


def _within_int32(name: str, value: ArrayLike) -> NDArray[Any]:
    """As an array of numbers that 32 bits hold: a conversion would cut others in silence."""
    array = np.asarray(value)
    if array.size and array.dtype.kind in "iuf" and array.dtype != np.int32:
        low, high = array.min(), array.max()
        if not (-(2**31) <= low and high < 2**31):
            far = high if low >= -(2**31) else low
            raise ValueError(f"{name} holds {far}, which is no number of 32 bits")
    return array
