"""One line of an explanation: a rule, whose it is, and the edge length that it asks for."""

from collections.abc import Iterable
from typing import NamedTuple

IN_JSON = {"target_size": "wish"}
"""Attributes that have another name there."""

EXACT = 1e-9
"""Relative: sizes that differ by less are one."""


class SizeRow(NamedTuple):
    """A rule and the edge length that it asks for, model units."""

    key: str
    """Of the selection; "*" for the whole model, "default" for what nobody asked for."""
    rule: str
    """Option and numbers, as "chord 0.01 at curvature 0.5"."""
    size: float
    bound: str = ""
    """"min" and "max" for the bounds of all others."""

    def __str__(self) -> str:
        sign = {"min": ">= ", "max": "<= "}.get(self.bound, "")
        return f"{sign}{self.size:.6g}  {self.key}: {self.rule}"


def deciding(rows: Iterable[SizeRow]) -> SizeRow | None:
    """The row that wins: the smallest, unless the largest ``min`` is above it."""
    rows = list(rows)
    asked = [row for row in rows if row.bound != "min"]
    if not asked:
        return None
    smallest = min(asked, key=lambda row: row.size)
    floors = [row for row in rows if row.bound == "min" and row.size > smallest.size]
    return max(floors, key=lambda row: row.size) if floors else smallest


def in_order(rows: Iterable[SizeRow]) -> tuple[SizeRow, ...]:
    """Each once, the smallest first, bounds last."""
    order = {"": 0, "max": 1, "min": 2}
    return tuple(sorted(dict.fromkeys(rows), key=lambda row: (order[row.bound], row.size)))
