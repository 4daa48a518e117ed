"""Numbers as text in columns of limited width, and back."""

from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

LINES = 50_000  # formatted together


def shortest(values: Iterable[float], width: int) -> list[str]:
    """Each number in at most ``width`` characters, 17 digits or as many as fit; width >= 12."""
    found = []
    for value in values:
        text = repr(value)
        if len(text) > width:
            spare = len(text.partition("e")[2])  # '-05'
            digits = width - 4 - spare if spare else 0
            text = f"{value:.{digits}e}" if spare else f"{value:.{width}f}"[:width]
            if len(text) > width:
                text = f"{value:.{width - 9}e}"
        found.append(text)
    return found


def numbers(lines: Sequence[str], columns: int, kind: type = float) -> NDArray:
    """(len(lines), columns) from lines with commas; ValueError when one has other columns."""
    words = [word.strip() for line in lines for word in line.rstrip().rstrip(",").split(",")]
    if len(words) != columns * len(lines):
        raise ValueError(f"rows of {columns} numbers are expected")
    return np.array(words, kind).reshape(-1, columns)


class Text(Protocol):
    """What takes text, a file or not."""

    def write(self, text: str, /) -> object: ...


def write_rows(file: Text, row: str, values: NDArray) -> None:
    """Each row of ``values`` in the format ``row``, which ends its line."""
    for start in range(0, len(values), LINES):
        block = values[start : start + LINES]
        file.write((row * len(block)) % tuple(block.ravel().tolist()))
