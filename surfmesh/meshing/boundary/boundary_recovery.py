"""Insert boundary loops into a packing and cut the domain out (section 3, steps 2 to 5)."""

from dataclasses import dataclass

import numpy as np

from surfmesh._core import triangulation as core
from surfmesh.errors import DomainError, MeshingError, SurfaceError, SurfmeshError
from surfmesh.geometry.planar.segment_graph import inside_regions
from surfmesh.geometry.surface import Surface
from surfmesh.kernels import NIL
from surfmesh.kernels.insertion import insertion
from surfmesh.kernels.insertion.boundary_row import insert_row
from surfmesh.kernels.insertion.insertion import (
    FINISHED,
    INSIDE,
    OUTSIDE,
    clear_boundary,
    find_segments,
    grow_inside,
    insert_boundary,
    label_patches,
    swap_bad,
)
from surfmesh.kernels.triangulation.compaction import copy_inside, number_inside
from surfmesh.kernels.triangulation.triangulation import Triangulation, empty_triangulation
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.planar_segments import PlanarSegments
from surfmesh.sizing.field.size_field import SizeField

CROWDED = 0.5
"""Metric distance from the boundary below which an interior vertex is removed."""

APART, AROUND, LOWEST = 0.65, 0.6, 0.7
"""In metric lengths: how far apart the vertices of the row along the boundary are, how near to
them others are removed, and how low its triangles may be where segments are long."""

BAD_SHAPE, SWEEPS = 0.7, 8
"""Triangles below this alpha, left by the packing or the boundary, are offered a swap."""

ROOM, STRETCHED_ROOM = 1 / 16, 1 / 2
"""Room for more vertices, as a fraction of those there are, for the optimiser's splits."""

QUEUE = 1 << 16
"""Most edges that one segment may cut."""


@dataclass(frozen=True)
class DomainMesh:
    """A triangulated domain of the scaled plane, with room to optimise it in place."""

    t: Triangulation
    node: np.ndarray
    """(k,) int32: the vertex of each boundary node, NIL where no triangle inside uses it."""
    same: np.ndarray
    """(k,) int32: the vertex of the node that each coincides with in space, or its own."""
    on_kinks: np.ndarray
    """(j,) int32: vertices where the surface has two normals."""
    points: np.ndarray | None = None
    """(k, 3) where the nodes lie in space; None: on the surface."""

    @property
    def is_used(self) -> np.ndarray:
        """(k,) which boundary nodes have a vertex."""
        used: np.ndarray = self.node != NIL
        return used


def recovered(
    packing: core.Triangulation, loops: BoundaryLoops, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the loops into a copy of the packing and keep their inside.

    Raises ``SurfaceError`` when loops touch or cross, naming the place.
    """
    rim, inner = loops.segments, loops.inner
    segments = np.concatenate([rim, inner])
    row = np.concatenate([segments, inner[:, ::-1]])  # inner ones have the surface on both sides
    t, vertex, edge, first_node = _inserted(packing, loops.uv, segments, row, field, surface)
    back = t.adj[edge[len(rim) :]]
    edges = np.concatenate([edge, back])
    if grow_inside(t, edges) != FINISHED:
        error = SurfaceError(f"the boundary loops of {surface.name!r} do not enclose a domain")
        error.where = loops.uv
        raise error
    _clear(t, row, vertex, edges, first_node)
    t, node = _cut_out(t, vertex, STRETCHED_ROOM if field.is_anisotropic else ROOM)
    return DomainMesh(t, node, node[loops.identity], node[np.unique(inner)], loops.points)


def recovered_regions(
    packing: core.Triangulation, cut: PlanarSegments, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the segments of a planar domain into a copy of the packing and keep what is inside.

    Raises ``DomainError`` when nothing is inside.
    """
    row = np.concatenate([cut.pieces, cut.pieces[:, ::-1]])
    t, vertex, edge, first_node = _inserted(packing, cut.uv, cut.pieces, row, field, surface)
    label = np.empty(int(t.count[1]), np.int32)
    label_patches(t, label)
    ghost = int(np.flatnonzero(t.tri[: 3 * len(label)] < 0)[0])
    left, right = label[edge // 3], label[t.adj[edge] // 3]
    _, first = np.unique(cut.segment, return_index=True)
    inside = inside_regions(cut.graph, left[first], right[first], int(label[ghost // 3]))
    if not inside.any():
        raise DomainError(f"no part of {surface.name!r} is inside: the holes cover all of it")
    live = label != NIL
    t.region[: len(label)][live] = np.where(inside[label[live]], INSIDE, OUTSIDE)
    sides = [inside[left], inside[right]]
    both = np.concatenate([cut.pieces[sides[0]], cut.pieces[sides[1]][:, ::-1]])
    edges = np.concatenate([edge[sides[0]], t.adj[edge[sides[1]]]])
    _clear(t, both, vertex, edges, first_node)
    t, node = _cut_out(t, vertex)
    return DomainMesh(t, node, node, node[:0])


def _inserted(
    packing: core.Triangulation, uv: np.ndarray, segments: np.ndarray, with_row: np.ndarray,
    field: SizeField, surface: Surface,
) -> tuple[Triangulation, np.ndarray, np.ndarray, int]:  # fmt: skip
    """Steps 2 and 3: the triangulation with all segments, vertices of nodes, their half-edges.

    with_row: the segments, turned round too where the inside may be on both sides: a row of
    vertices is put to the left of each. The last result is the first vertex that is a node.
    """
    xy = field.chart.to_plane(uv)
    row = _apexes(xy, with_row, field)
    t = _with_room(packing, len(xy) + len(row))
    insert_row(t, row, field.tensors(row), APART, AROUND)
    first_node = int(t.count[0])
    vertex = np.full(len(xy), NIL, np.int32)
    edge = np.full(len(segments), NIL, np.int32)
    queue = np.empty(QUEUE, np.int32)
    where = np.zeros(2, np.int64)
    status = insert_boundary(t, xy, field.tensors(xy), segments, vertex, edge, queue, where)
    if status != FINISHED:
        _refuse(status, int(where[0]), uv, segments, surface)
    if find_segments(t, segments, vertex, edge) != FINISHED:
        raise MeshingError(f"the boundary of {surface.name!r} was lost: please report this")
    return t, vertex, edge, first_node


def _apexes(xy: np.ndarray, segments: np.ndarray, field: SizeField) -> np.ndarray:
    """Apexes (s, 2) of isosceles triangles with unit legs on the left of segments (s, 2)."""
    start, end = xy[segments[:, 0]], xy[segments[:, 1]]
    middle = 0.5 * (start + end)
    h11, h12, h22 = field.tensors(middle).T
    dx, dy = (end - start).T
    determinant = h11 * h22 - h12 * h12
    u, v = (h22 * dx - h12 * dy) / determinant, (h11 * dy - h12 * dx) / determinant
    length2 = u * u + v * v
    with np.errstate(divide="ignore", invalid="ignore"):
        height = np.sqrt(np.maximum(1.0 - 0.25 * length2, LOWEST**2) / length2)
    across = np.stack([h12 * u - h11 * v, h22 * u - h12 * v], axis=1)  # H (-v, u)
    with np.errstate(invalid="ignore"):
        apexes = middle + height[:, None] * across
    return apexes[np.isfinite(apexes).all(axis=1)]  # two nodes at one place have none


def _clear(
    t: Triangulation, segments: np.ndarray, vertex: np.ndarray, edge: np.ndarray, first_node: int
) -> None:
    """Step 4: what crowds the boundary is removed, bad triangles are offered a swap."""
    clear_boundary(t, segments, vertex, edge, first_node, CROWDED)
    swap_bad(t, np.empty(int(t.count[1])), BAD_SHAPE, SWEEPS)


def _with_room(packing: core.Triangulation, nodes: int) -> Triangulation:
    """A copy as one region, with room for more vertices and for fixed edges."""
    t = empty_triangulation(packing.vertices + nodes + 8)
    t = t._replace(fixed=np.zeros(len(t.tri), np.uint8))
    for name in ("xy", "size", "tri", "adj"):
        given = getattr(packing, name)
        getattr(t, name)[: len(given)] = given
    t.count[:] = packing.vertices, packing.triangles
    t.region[: packing.triangles] = INSIDE
    return t


def _cut_out(
    t: Triangulation, vertex: np.ndarray, spare: float = ROOM
) -> tuple[Triangulation, np.ndarray]:
    """The triangles inside, with ``spare`` of their number for more, and the vertices of nodes."""
    triangle_number = np.empty(t.count[1], np.int32)
    vertex_number = np.empty(t.count[0], np.int32)
    _, vertices = number_inside(t, INSIDE, triangle_number, vertex_number)
    room = vertices + int(spare * vertices) + 64
    out = empty_triangulation(room)
    out = out._replace(fixed=np.zeros(len(out.tri), np.uint8))
    copy_inside(t, triangle_number, vertex_number, out)
    return out, vertex_number[vertex]


def _refuse(
    status: int, number: int, uv: np.ndarray, segments: np.ndarray, surface: Surface
) -> None:
    """Raise what the status means; ``where`` of the error is the place in (u, v)."""
    if status == insertion.NODE_TAKEN:
        u, v = uv[number]
        error: SurfmeshError = SurfaceError(
            f"the boundary of {surface.name!r} touches itself at (u, v) = ({u:.6g}, {v:.6g})"
        )
        error.where = uv[number]
        raise error
    a, b = uv[segments[number]]
    line = f"({a[0]:.6g}, {a[1]:.6g}) - ({b[0]:.6g}, {b[1]:.6g})"
    if status in (insertion.CROSSING, insertion.SEGMENT_ON_NODE):
        verb = "crosses itself" if status == insertion.CROSSING else "touches itself"
        error = SurfaceError(f"the boundary of {surface.name!r} {verb} on (u, v) {line}")
    else:
        error = MeshingError(
            f"the boundary segment {line} of {surface.name!r} could not be recovered"
        )
    error.where = np.stack([a, b])
    raise error
