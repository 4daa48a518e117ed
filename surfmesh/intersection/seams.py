"""Where closed surfaces of formulas have their seams: out of the way of the others.

A seam is an edge that meshes must follow. Where another surface runs into it at a small angle, as a
wing's root along the seam of a fuselage, triangles between both are slivers. A surface that is
periodic may be cut open anywhere else: its domain is moved by a part of the period to where the
seam is clear of all other surfaces. Seams that cross others wherever they are stay, and those that
lie on another all along.

    u0      u1                     u0 + s     u1 + s
    +-------+                      +----------+
    |       |     the same as      |          |     r(u + period, v) = r(u, v)
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.small_matrices import product
from surfmesh.geometry.surface import Domain, Surface

PLACES = 16
"""Parts of the period at which a seam is tried."""

ALONG, GRID, LEAST_GRID = 65, 33, 3
"""Samples of a seam; of another surface each way, fewer of each face of a model, at least."""

SAME = 1e-9
"""Of the largest: derivatives that differ by less a period apart are the same."""


def with_clear_seams(things: Sequence[Any]) -> list[Any]:
    """The same surfaces and models; seams of periodic formulas are moved where others meet them."""
    found = list(things)
    samples = [_samples(thing) for thing in things]
    for k, thing in enumerate(things):
        if isinstance(thing, ParametricSurface) and not len(thing.loops):
            others = [other for j, other in enumerate(samples) if j != k and len(other[0])]
            found[k] = _moved(thing, others)
    return found


Samples = tuple[np.ndarray, float]
"""Points (n, 3) of a surface or model, and how far apart they are at most."""


def _samples(thing: Any) -> Samples:
    surfaces = [face.surface for face in thing.faces] if isinstance(thing, CadModel) else [thing]
    points, apart = [np.empty((0, 3))], 0.0
    grid = max(LEAST_GRID, int(GRID / max(len(surfaces), 1) ** 0.5))
    for surface in surfaces:
        if not isinstance(surface, Surface):
            continue  # refused later
        own = surface.evaluate(parameter_grid(surface.domain, grid), 0)[0].reshape(grid, grid, 3)
        steps = np.diff(own, axis=0), np.diff(own, axis=1)
        apart = max(apart, *(float(np.linalg.norm(step, axis=-1).max()) for step in steps))
        points.append(own.reshape(-1, 3))
    return np.concatenate(points), apart


def _moved(surface: ParametricSurface, others: Sequence[Samples]) -> ParametricSurface:
    sides = find_sides(surface)
    for axis in (0, 1):
        first = (3, 0)[axis]  # the side where the variable is lowest
        joins = sides.partner[first] == (first + 2) % 4 and not sides.reversed[first]
        if not joins or not _is_periodic(surface, axis):
            continue
        near = [_distances(surface, axis, k / PLACES, others) for k in range(PLACES)]
        if any(own.max() <= 1.0 for own in near[0]):
            continue  # the seam is the curve itself
        room = np.array([min((own.min() for own in each), default=np.inf) for each in near])
        best = int(np.argmax(room))
        if room[0] < 1.0 <= room[best]:
            surface = surface.with_domain(_shifted(surface.domain, axis, best / PLACES))
    return surface


def _is_periodic(surface: Surface, axis: int) -> bool:
    """Do r and its derivatives go on beyond the domain as they began?"""
    (u0, u1), (v0, v1) = surface.domain
    line = (np.arange(GRID) + 0.37) / GRID
    uv = np.stack(np.meshgrid(u0 + line * (u1 - u0), v0 + line * (v1 - v0)), axis=-1).reshape(-1, 2)
    period = np.zeros(2)
    period[axis] = (u1 - u0, v1 - v0)[axis]
    here, there = surface.evaluate(uv, 2), surface.evaluate(uv + period, 2)
    return all(
        bool((np.abs(a - b) <= SAME * np.abs(a).max()).all()) for a, b in zip(here, there)
    )  # fmt: skip


def _distances(
    surface: Surface, axis: int, part: float, others: Sequence[Samples]
) -> list[np.ndarray]:  # fmt: skip
    """For each of the others, how far points of a seam are from its samples, in parts of the
    distances between these."""
    (low, high), along = surface.domain[axis], surface.domain[1 - axis]
    uv = np.empty((ALONG, 2))
    uv[:, axis], uv[:, 1 - axis] = low + part * (high - low), np.linspace(*along, ALONG)
    seam = surface.evaluate(uv, 0)[0]
    found = []
    for points, apart in others:
        middle = points.mean(axis=0)
        p, q = seam - middle, points - middle
        square = (p**2).sum(axis=1)[:, None] + (q**2).sum(axis=1) - product(2.0 * p, q.T)
        found.append(np.sqrt(np.maximum(square.min(axis=1), 0.0)) / max(apart, 1e-300))
    return found


def _shifted(domain: Domain, axis: int, part: float) -> Domain:
    u, v = domain
    low, high = domain[axis]
    moved = low + part * (high - low), high + part * (high - low)
    return (moved, v) if axis == 0 else (u, moved)
