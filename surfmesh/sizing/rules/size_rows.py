"""One wish a row: what each of them asks for at a point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from surfmesh.sizing.options.defaults import DEFAULT_ANGLE
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.options.sources import checked_sizes
from surfmesh.sizing.rules.size_bounds import curvature_sizes, principal_sizes


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


def rows(
    key: str, sizing: Sizing, point: np.ndarray, k1: float | None, k2: float | None
) -> Iterator[SizeRow]:
    """What ``sizing`` asks for at point (3,) with principal curvatures k1, k2 (None: flat)."""
    if k1 is not None:
        a, b = np.array([k1]), np.array([k2])
        at = f"at curvatures {k1:.4g}, {k2:.4g}"
        if sizing.is_anisotropic:  # in the direction that bends more
            found = principal_sizes(sizing, a, b, sizing.anisotropy)
            yield from curvature_rows(key, sizing, at, {n: s.min() for n, s in found.items()})
        else:
            found = curvature_sizes(sizing, a, b)
            yield from curvature_rows(key, sizing, at, {n: s[0] for n, s in found.items()})
    if isinstance(sizing.size, float):
        yield SizeRow(key, f"size {sizing.size:g}", sizing.size)
    elif callable(sizing.size):
        size = float(checked_sizes(sizing.size, point[None], "size")[0])
        yield SizeRow(key, f"size law {_called(sizing.size)}", size)
    for source in sizing.sources:
        size = float(checked_sizes(source, point[None], "source")[0])
        if np.isfinite(size):
            yield SizeRow(key, f"source {_called(source)}", size)
    if sizing.max_size is not None:
        yield SizeRow(key, f"max_size {sizing.max_size:g}", sizing.max_size, "max")
    if sizing.min_size is not None:
        yield SizeRow(key, f"min_size {sizing.min_size:g}", sizing.min_size, "min")


def curvature_rows(
    key: str, sizing: Sizing, at: str, sizes: Mapping[str, float]
) -> Iterator[SizeRow]:
    """Rows of ``curvature_sizes`` at one point; at: the curvature in words."""
    said = {
        "chord": (key, f"chord {sizing.chord:g}" if sizing.chord else ""),
        "angle": (key, f"angle {sizing.angle:g} degrees" if sizing.angle else ""),
        "default": ("default", f"angle {DEFAULT_ANGLE:g} degrees"),
    }
    for name, size in sizes.items():
        if np.isfinite(size):
            who, rule = said[name]
            yield SizeRow(who, f"{rule} {at}", float(size))


def deciding(found: list[SizeRow]) -> SizeRow | None:
    """The row that wins: the smallest, unless the largest ``min`` is above it."""
    wishes = [row for row in found if row.bound != "min"]
    if not wishes:
        return None
    smallest = min(wishes, key=lambda row: row.size)
    floors = [row for row in found if row.bound == "min" and row.size > smallest.size]
    return max(floors, key=lambda row: row.size) if floors else smallest


def _called(law: object) -> str:
    name = getattr(law, "__qualname__", "") or repr(law)
    return name if len(name) <= 80 else name[:77] + "..."
