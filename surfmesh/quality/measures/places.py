"""Points as the report has them, and in words."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float, float]


def as_point(values: NDArray[Any]) -> Point:
    """Three coordinates, as plain numbers."""
    x, y, z = values.tolist()
    return float(x), float(y), float(z)


def middles(corners: NDArray[Any]) -> NDArray[Any]:
    """(k, 3) means of corners (k, j, 3); of one thing (3,) of (j, 3). ``mean`` takes longer."""
    return np.add.reduce(corners, axis=-2) / corners.shape[-2]


def as_uv(values: NDArray[Any]) -> tuple[float, float]:
    """Two parameters, as plain numbers."""
    u, v = values.tolist()
    return float(u), float(v)


def place_in_words(point: Iterable[float] | None, digits: int = 5) -> str:
    """ "(1, 2.5, 0)"; nothing where there is no place."""
    if point is None:
        return ""
    return "(" + ", ".join(f"{float(value):.{digits}g}" for value in point) + ")"


def count_in_words(number: int, one: str, many: str | None = None) -> str:
    """ "1 edge", "2,000 edges" """
    return f"{number:,} {one if number == 1 else many or one + 's'}"


def face_in_words(face: int, name: str) -> str:
    """ "face 3 (lid)" """
    plain = f"face {face}"
    return plain if name in ("", plain) else f"{plain} ({name})"


def more_in_words(found: Sequence[object], words: str) -> str:
    """``words`` about how many there are besides the first; nothing where there is no other."""
    return words.format(len(found) - 1) if len(found) > 1 else ""
