"""Distance both ways between a mesh and a fine tessellation of what it stands for."""

import numpy as np
import pyvista
import trimesh

SAMPLES = 20_000


def farthest(start: trimesh.Trimesh, end: trimesh.Trimesh, samples: int = SAMPLES) -> float:
    """Largest distance from samples of one to the other: random places, centres, vertices."""
    scattered, _ = trimesh.sample.sample_surface(start, samples // 4, seed=1)
    kept = _spread(start.triangles_center, samples), _spread(start.vertices, samples)
    return farthest_point(np.concatenate([scattered, *kept]), end)


def farthest_point(places: np.ndarray, end: trimesh.Trimesh) -> float:
    """Largest distance of places (n, 3) to a mesh."""
    cloud = pyvista.PolyData(np.ascontiguousarray(places))
    away = cloud.compute_implicit_distance(pyvista.wrap(end))["implicit_distance"]
    return float(np.abs(away).max())


def _spread(places: np.ndarray, most: int) -> np.ndarray:
    return places[:: len(places) // most + 1]
