"""What a surface over a rectangle is refused for, however its points are made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from surfmesh.errors import SurfaceError, shown
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.surface import Domain, Surface

NO_AREA = 1e-11  # sine of the angle between r_u and r_v: r_u x r_v is round-off below it
SAMPLES = 48  # cells each way on which a surface is tried; the points sit on their corners


def loops_of(loops: Any) -> tuple[np.ndarray, ...]:
    """Trimming loops, read-only; SurfaceError for what is none."""
    try:
        several = list(loops)
    except TypeError:
        raise SurfaceError(f"loops are lists of (u, v) points, not {shown(loops)}") from None
    return tuple(loop_of(number, loop) for number, loop in enumerate(several))


def table_of(what: str, given: Any) -> dict[str, Any]:
    """A mapping as a dict of its own, None as an empty one; SurfaceError for what is none."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise SurfaceError(f"{what} is a mapping from names to values, not {shown(given)}")
    return dict(given)


def loop_of(number: int, points: Any) -> np.ndarray:
    """A trimming loop (k, 2), read-only; SurfaceError when it is not one."""
    try:
        if np.iscomplexobj(points):
            raise TypeError
        loop = np.array(points, dtype=float)
    except (TypeError, ValueError, OverflowError):
        loop = np.empty(0)
    if loop.ndim != 2 or loop.shape[1] != 2 or len(loop) < 3 or not np.isfinite(loop).all():
        raise SurfaceError(f"loop {number} is not a list of three or more finite (u, v) points")
    loop.setflags(write=False)
    return loop


def sample_grid(domain: Domain, cells: int = SAMPLES) -> np.ndarray:
    """Corners of cells x cells cells that cover the domain: (cells + 1, cells + 1, 2)."""
    lines = [np.linspace(first, last, cells + 1) for first, last in domain]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)


def refuse_extremes(r: np.ndarray, domain: Domain) -> None:
    """Raise SurfaceError for points (n, 3) of a domain, when products of lengths, or of
    derivatives, are no longer doubles."""
    far = np.abs(r).max()
    if far > RANGE.coordinate:
        raise SurfaceError(
            f"the surface has a coordinate of {far:g}, too far away to compute with; scale it"
        )
    extent = float(np.ptp(r, axis=0).max())
    if extent == 0.0:
        return  # no area, said elsewhere
    if extent < RANGE.extent:
        raise SurfaceError(
            f"the surface is only {extent:g} wide, too small to compute with; scale it"
        )
    for variable, (first, last) in zip("uv", domain):
        wide = last - first
        speed = extent / wide
        if not 1.0 / RANGE.speed < speed < RANGE.speed or not (
            1.0 / RANGE.bend < speed / wide < RANGE.bend
        ):
            raise SurfaceError(
                f"the domain of {variable} is {wide:g} wide where the surface is {extent:g}: its "
                f"derivatives are no numbers to compute with; scale {variable}"
            )


def refuse_no_area(surface: Surface) -> None:
    """Raise SurfaceError for a surface that is a point or a curve."""
    points = sample_grid(surface.domain).reshape(-1, 2)
    r, r_u, r_v = surface.evaluate(points, 1)
    if not np.ptp(r, axis=0).any():
        raise SurfaceError("the surface is a single point: none of x, y, z changes with u or v")
    # in parts of the domain, so that u and v may have different units
    (u0, u1), (v0, v1) = surface.domain
    r_u, r_v = r_u * (u1 - u0), r_v * (v1 - v0)
    scale = max(np.abs(r_u).max(), np.abs(r_v).max(), np.finfo(float).tiny)
    r_u, r_v = r_u / scale, r_v / scale  # squares neither overflow nor vanish
    cross = np.linalg.norm(np.cross(r_u, r_v), axis=1)
    lengths = np.linalg.norm(r_u, axis=1) * np.linalg.norm(r_v, axis=1)
    if not (cross > NO_AREA * lengths).any():
        raise SurfaceError(
            "the surface has no area: x, y, z trace a curve; they must change with u and with v"
        )
