"""The place on a surface, or on the faces of a model, that is nearest to a point."""

from __future__ import annotations

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import boundary_polygons, inner_samples
from surfmesh.errors import SizingError
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.edges.edge_samples import EdgeSamples

GRID, PROJECTIONS = 33, 8
"""Points each way of the grid that a foot is looked for from, and steps to it."""

NEAR_FACES, COARSE_GRID = 6, 9
"""So many faces are looked at in detail, by points of such a grid on each."""


def nearest_on_model(
    model: CadModel, samples: EdgeSamples, point: np.ndarray
) -> tuple[int, np.ndarray, float, np.ndarray]:
    """face, uv (2,), distance, foot (3,): inside the loops of the face."""
    best: tuple[float, int, np.ndarray, np.ndarray] | None = None
    order = []
    for number, face in enumerate(model.faces):
        inner = inner_samples(face, COARSE_GRID)
        places = face.surface.evaluate(inner, 0)[0] if len(inner) else np.empty((0, 3))
        places = np.concatenate([places, samples.points[samples.along(number)]])
        nearest = np.linalg.norm(places - point, axis=1).min() if len(places) else np.inf
        order.append((float(nearest), number))
    for _, number in sorted(order)[:NEAR_FACES]:
        face = model.faces[number]
        rings = boundary_polygons(face)
        uv, away, foot = nearest_on_surface(
            face.surface, point, parameter_grid(face.surface.domain, GRID)
        )
        if not is_inside(rings, uv[None])[0]:
            uv, away, foot = _on_rings(face.surface, rings, point)
        if best is None or away < best[0]:
            best = (away, number, uv, foot)
    if best is None:
        raise SizingError(f"{model.name or model.source!r} has no face to explain sizes on")
    return best[1], best[2], best[0], best[3]


def _on_rings(
    surface: Surface, rings: list[np.ndarray], point: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray]:
    """uv (2,), distance, foot (3,): the nearest point of the boundary of a face."""
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    (a,), (b,) = surface.evaluate(start, 0), surface.evaluate(end, 0)
    step = b - a
    square = np.maximum(np.einsum("ij,ij->i", step, step), np.finfo(float).tiny)
    t = np.clip(np.einsum("ij,ij->i", point - a, step) / square, 0.0, 1.0)[:, None]
    uv = start + t * (end - start)
    (places,) = surface.evaluate(uv, 0)
    away = np.linalg.norm(places - point, axis=1)
    nearest = int(away.argmin())
    return uv[nearest], float(away[nearest]), places[nearest]


def nearest_on_surface(
    surface: Surface, point: np.ndarray, guesses: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray]:
    """uv (2,), distance, foot (3,), sought from the nearest of ``guesses`` (n, 2)."""
    (points,) = surface.evaluate(guesses, 0)
    guess = guesses[np.linalg.norm(points - point, axis=1).argmin()]
    uv, away, foot = closest_point(surface, point[None], guess[None], PROJECTIONS, 0.0)
    return uv[0], float(away[0]), foot[0]
