"""What is measured of a CAD mesh, whoever made it: each solid's closure, shape, volume, area."""

from time import perf_counter, process_time

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.quality.measures.shape import Shapes, enclosed_volume, shapes
from surfmesh.quality.measures.topology import topology
from surfmesh.result.surface_mesh import SurfaceMesh

POOR = 0.3  # alpha


def clocks() -> np.ndarray:
    """(2,) seconds: of the clock on the wall, and of the processor, which others cannot slow."""
    return np.array([perf_counter(), process_time()])


def spent(seconds: np.ndarray) -> dict:
    """Differences of ``clocks()`` while a mesh was made."""
    return {"seconds_mesh": float(seconds[0]), "cpu_mesh": float(seconds[1])}


def shape_figures(shape: Shapes) -> dict:
    """Sums rather than means, so that files can be taken together."""
    count = len(shape.alpha)
    return {
        "triangles": count,
        "alpha_mean": float(shape.alpha.mean()) if count else None,
        "alpha_min": float(shape.alpha.min()) if count else None,
        "poor": int(np.count_nonzero(shape.alpha < POOR)),
        "area": float(shape.area.sum()),
    }


def solid_figures(mesh: SurfaceMesh) -> dict:
    """Of the triangles around one solid, facing outwards.

    open: edges used an odd number of times; uneven: those that are not run along as often one
    way as the other; crowded: those of more than two triangles.
    """
    table, corners = mesh.connectivity, mesh.triangles
    starts, ends = corners.ravel(), corners[:, (1, 2, 0)].ravel()
    width = np.int64(len(mesh.points))
    key = np.minimum(starts, ends) * width + np.maximum(starts, ends)
    _, edge = np.unique(key, return_inverse=True)
    balance = np.bincount(edge, np.where(starts < ends, 1, -1))
    return {
        "triangles": len(corners),
        "euler": topology(mesh).euler,
        "open": int(np.count_nonzero(table.uses % 2)),
        "uneven": int(np.count_nonzero(balance)),
        "crowded": int(np.count_nonzero(table.uses > 2)),
        "volume": enclosed_volume(mesh) if len(corners) else 0.0,
        "area": float(shapes(mesh).area.sum()),
    }


def stray_edges(mesh: SurfaceMesh, model: CadModel, failed: set[int]) -> int:
    """Open edges of the mesh where the model has no free edge: holes and cracks, in sheets too.

    failed: faces that were named as not meshed; their edges are open for a reason.
    """
    free = [
        number for number in range(len(model.edges))
        if len(users := model.faces_of_edge(number)) == 1 or not failed.isdisjoint(users)
    ]  # fmt: skip
    width = np.int64(len(mesh.points))
    along = np.sort(mesh.edge_segments[np.isin(mesh.edge_ids, free)], axis=1)
    allowed = along @ np.array([width, 1])
    return int(np.count_nonzero(~np.isin(mesh.boundary_edges @ np.array([width, 1]), allowed)))


def without_collapsed(triangles: np.ndarray) -> np.ndarray:
    """Triangles with three distinct corners: others are made where a pole is one vertex."""
    a, b, c = triangles.T
    return triangles[(a != b) & (b != c) & (c != a)]


def own_vertices(points: np.ndarray, triangles: np.ndarray) -> SurfaceMesh:
    """A mesh of these triangles on the vertices that they use."""
    used, corners = np.unique(triangles, return_inverse=True)
    return SurfaceMesh(points=points[used], triangles=corners.reshape(-1, 3))
