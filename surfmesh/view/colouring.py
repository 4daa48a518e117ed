"""What a mesh can be coloured by: the values, their name with unit, map and limits."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.fundamental_forms import curvatures, forms
from surfmesh.quality.deviation import deviation
from surfmesh.quality.shape import shapes
from surfmesh.surface_mesh import SurfaceMesh

ROBUST = 0.995  # share of the values within the limits where a few would swallow the scale

WIDE = 20.0  # ratio of the limits above which the scale is logarithmic
DECADES = 1e3  # no scale spans more


@dataclass(frozen=True)
class Colouring:
    """Values to show; one a vertex or one a triangle."""

    values: NDArray
    title: str  # of the colour bar, with unit
    colours: str  # name of a matplotlib colour map
    limits: tuple[float, float]
    per_vertex: bool = False
    logarithmic: bool = False


def colouring(mesh: SurfaceMesh, by: str) -> Colouring:
    """Values of ``mesh`` by name: alpha, size, deviation, face or curvature.

    Raises ``ValueError`` for another name, or when the mesh does not carry what it takes.
    """
    if by not in _COLOURINGS:
        raise ValueError(f"cannot colour by {by!r}; known are {', '.join(_COLOURINGS)}")
    return _COLOURINGS[by](mesh)


def _by_alpha(mesh: SurfaceMesh) -> Colouring:
    values = shapes(mesh).alpha
    worst = min(0.8, np.floor(10 * float(values.min(initial=1.0))) / 10)
    return Colouring(values, "shape alpha (1 = equilateral)", "viridis", (worst, 1.0))


def _by_size(mesh: SurfaceMesh) -> Colouring:
    if mesh.sizes is None:
        raise ValueError("cannot colour by 'size': the mesh carries no wanted sizes")
    return _positive(mesh.sizes, "wanted edge length (model units)", "viridis")


def _by_deviation(mesh: SurfaceMesh) -> Colouring:
    found = deviation(mesh, shapes(mesh).area)
    if found is None:
        raise ValueError("cannot colour by 'deviation': the mesh carries no surface")
    limits = (0.0, max(found.largest, np.finfo(float).tiny))
    return Colouring(found.by_triangle, "distance from the surface (model units)", "magma", limits)


def _by_face(mesh: SurfaceMesh) -> Colouring:
    last = int(mesh.face_ids.max(initial=0))
    return Colouring(mesh.face_ids, "face", "tab20", (-0.5, max(last, 19) + 0.5))


def _by_curvature(mesh: SurfaceMesh) -> Colouring:
    if not mesh.surfaces or mesh.uv_points is None:
        raise ValueError("cannot colour by 'curvature': the mesh carries no surface")
    corner = np.zeros(len(mesh.points), np.int64)  # any corner of each vertex
    corner[mesh.triangles.reshape(-1)] = np.arange(mesh.triangles.size)
    uv = mesh.uv_points[mesh.uv_triangles.reshape(-1)[corner]]
    face = mesh.face_ids[corner // 3]
    values = np.zeros(len(mesh.points))
    for number, surface in enumerate(mesh.surfaces):
        mine = face == number
        found = curvatures(forms(surface, uv[mine]))
        values[mine] = np.maximum(np.abs(found.k1), np.abs(found.k2))
    return _positive(values, "largest principal curvature (1 / model unit)", "viridis")


def _positive(values: NDArray, title: str, colours: str) -> Colouring:
    """Values a vertex, none negative; on a logarithmic scale when they span decades."""
    low, high = (float(value) for value in np.quantile(values, (1 - ROBUST, ROBUST)))
    logarithmic = high > WIDE * low and high > 0
    if logarithmic:
        low = max(low, high / DECADES)
        values = np.maximum(values, low)
    elif not high > low * (1 + 1e-6):
        low, high = 0.99 * low, 1.01 * high or 1.0
    return Colouring(values, title, colours, (low, high), True, logarithmic)


_COLOURINGS = {
    "alpha": _by_alpha,
    "size": _by_size,
    "deviation": _by_deviation,
    "face": _by_face,
    "curvature": _by_curvature,
}
