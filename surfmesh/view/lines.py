"""Lines over the colours: edges of the model, circles of the packing, directions, bad triangles."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms
from surfmesh.quality.measures.shape import shapes
from surfmesh.result.facets import PARTS
from surfmesh.result.quadratic_triangles import edge_rows
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.metric_roots import unpacked
from surfmesh.view.vertex_parameters import vertex_parameters

ARC = 6  # pieces of a circle within one corner of a triangle
CROSSES = 1500  # about as many principal directions can be told apart in a picture
CROSS = 0.42  # half the length of a direction, in edges or in the distance of those drawn
FLAT = 1e-6  # |k1 - k2| below this fraction of |k1| + |k2| has no direction


class Lines(NamedTuple):
    """Straight pieces that are drawn alike."""

    name: str
    segments: NDArray[np.float64]  # (k, 2, 3) model units
    colour: str
    width: float  # pixels in a picture 1000 pixels high


def model_edges(mesh: SurfaceMesh) -> Lines:
    """The edges of the CAD model; without one, the boundary and where faces meet."""
    return Lines("model edges", pieces_of(mesh, model_edge_pairs(mesh)), "#101418", 3.0)


def sides(mesh: SurfaceMesh) -> Lines:
    """All sides of triangles."""
    return Lines("sides", pieces_of(mesh, mesh.edges), "#202428", 1.0)


def pieces_of(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> NDArray[np.float64]:
    """(k, 2, 3) straight pieces of the edges between vertices (p, 2): one of each, and where they
    are curved ``PARTS``."""
    ends = mesh.points[pairs]
    if mesh.mid_points is None or not len(pairs):
        return ends
    row = edge_rows(mesh.connectivity, pairs)
    middle = np.where((row >= 0)[:, None], mesh.mid_points[row], ends.mean(axis=1))
    s = np.linspace(0.0, 1.0, PARTS + 1)
    weights = np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], axis=1)
    nodes = np.stack([ends[:, 0], middle, ends[:, 1]], axis=1)
    points = np.einsum("sk,pkd->psd", weights, nodes)
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)


def model_edge_pairs(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(k, 2) the vertices that ``model_edges`` joins."""
    if mesh.edge_segments is not None and len(mesh.edge_segments):
        return mesh.edge_segments
    table = mesh.connectivity
    first, second = mesh.face_ids[table.half_edges // 3].T
    return table.edges[(table.uses != 2) | (first != second)]


def circles(mesh: SurfaceMesh) -> Lines:
    """The circle, or ellipse where sizes have a direction, of every vertex, on the triangles.

    Its diameter is the wanted size: touching circles are edges of the wanted length. In the
    corner of a triangle it is an arc in the triangle's plane; what would lie beyond the side
    opposite is left out, for there the triangle is shorter than it was meant to be.

    Raises ``ValueError`` when the mesh carries no sizes.
    """
    if mesh.sizes is None:
        raise ValueError("cannot draw circles: the mesh carries no wanted sizes")
    corners = mesh.points[mesh.triangles]
    t = np.linspace(0.0, 1.0, ARC + 1)[:, None, None]
    uv = mesh.parametrisation
    arcs = []
    for i in range(3):
        a, b, c = corners[:, i], corners[:, (i + 1) % 3], corners[:, (i + 2) % 3]
        along = (1.0 - t) * (b - a) + t * (c - a)
        if uv is None or uv.metric_root_3d is None:
            length = np.linalg.norm(along, axis=2) / mesh.sizes[mesh.triangles[:, i]]
        else:
            root = unpacked(uv.metric_root_3d[uv.uv_triangles[:, i]])  # (m, 3, 3)
            length = np.linalg.norm(np.einsum("mij,smj->smi", root, along), axis=2)
        # how far towards the opposite side the circle reaches: 1 is on it
        reach = 0.5 / np.where(length > 0, length, np.inf)
        ends = a + np.minimum(reach, 1.0)[:, :, None] * along
        inside = (reach[:-1] < 1.0) | (reach[1:] < 1.0)
        arcs.append(np.stack((ends[:-1], ends[1:]), axis=2)[inside])
    return Lines("circles of the packing", np.concatenate(arcs), "#b0500c", 2.0)


def principal_directions(mesh: SurfaceMesh) -> tuple[Lines, Lines]:
    """Directions of the larger and the smaller principal curvature at vertices well apart.

    k1 >= k2 with the sign of ``fundamental_forms``. Planes and umbilics have none. Raises
    ``ValueError`` when the mesh carries no surface.
    """
    place = vertex_parameters(mesh)
    if place is None:
        raise ValueError("cannot draw principal directions: the mesh carries no surface")
    chosen, apart = _well_apart(mesh.points, CROSSES)
    first, second = np.zeros((2, len(mesh.points), 3))
    bent = np.zeros(len(mesh.points), bool)
    for number, surface in enumerate(mesh.surfaces):
        mine = chosen[place.face[chosen] == number]
        if not len(mine):
            continue
        uv = place.uv[mine]
        _, r_u, r_v = surface.evaluate(uv, 1)[:3]
        found = curvatures(forms(surface, uv))
        spread = np.abs(found.k1) + np.abs(found.k2)
        bent[mine] = found.k1 - found.k2 > FLAT * spread
        for directions, d in ((first, found.d1), (second, found.d2)):
            along = d[:, :1] * r_u + d[:, 1:] * r_v
            length = np.linalg.norm(along, axis=1, keepdims=True)
            directions[mine] = along / np.where(length > 0, length, 1.0)
    chosen = chosen[bent[chosen]]
    sizes = np.sqrt(shapes(mesh).area.mean()) if mesh.sizes is None else mesh.sizes[chosen]
    half = CROSS * np.maximum(apart, sizes) * np.ones(len(chosen))

    def drawn(name: str, along: NDArray[np.float64], colour: str) -> Lines:
        pieces = _centred(mesh.points[chosen], half[:, None] * along[chosen])
        return Lines(name, pieces, colour, 3.2)

    return drawn("direction of k1", first, "#ff3030"), drawn("direction of k2", second, "#35b6ff")


def worst_triangles(mesh: SurfaceMesh, count: int) -> tuple[Lines, NDArray[np.int64]]:
    """The sides of the ``count`` triangles of smallest alpha, and their numbers, worst first."""
    alpha = shapes(mesh).alpha
    worst = np.argsort(alpha, kind="stable")[:count]
    around = mesh.triangles[worst][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return Lines("worst triangles", pieces_of(mesh, around), "#e01010", 4.0), worst


def _centred(middle: NDArray, half: NDArray) -> NDArray:
    return np.stack((middle - half, middle + half), axis=1)


def _well_apart(points: NDArray, count: int) -> tuple[NDArray[np.int64], float]:
    """About ``count`` of the points, one a cell of a grid, and the width of its cells."""
    low = points.min(axis=0)
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    chosen, width = np.arange(len(points)), 0.0
    divisions = 256.0
    while len(chosen) > count and divisions > 1.0:
        width = extent / divisions
        cells = np.floor((points - low) / width).astype(np.int64)
        keys = (cells[:, 0] * 1024 + cells[:, 1]) * 1024 + cells[:, 2]
        chosen = np.unique(keys, return_index=True)[1]
        divisions *= 0.85
    return np.sort(chosen), width
