"""Insert boundary loops into a packing and cut the domain out (section 3, steps 2 to 5)."""

from dataclasses import dataclass

import numpy as np

from surfmesh.errors import MeshingError, SurfaceError
from surfmesh.geometry.surface import Surface
from surfmesh.kernels import insertion
from surfmesh.kernels.compaction import copy_inside, number_inside
from surfmesh.kernels.insertion import (
    FINISHED,
    INSIDE,
    clear_boundary,
    find_segments,
    grow_inside,
    insert_boundary,
    swap_bad,
)
from surfmesh.kernels.triangulation import Triangulation, empty_triangulation
from surfmesh.meshing.boundary_loops import BoundaryLoops
from surfmesh.sizing.size_field import SizeField

CROWDED = 0.6
"""Metric distance from the boundary below which an interior vertex is removed."""

BAD_SHAPE, SWEEPS = 0.7, 8
"""Triangles below this alpha, left by the packing or the boundary, are offered a swap."""

QUEUE = 1 << 16
"""Most edges that one segment may cut."""


@dataclass(frozen=True)
class DomainMesh:
    """A triangulated domain of the scaled plane, with room to optimise it in place."""

    t: Triangulation
    node: np.ndarray
    """(k,) int32: the vertex of each boundary node."""


def recovered(
    t: Triangulation, loops: BoundaryLoops, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the loops into the packing ``t`` (which is used up) and keep their inside.

    Raises ``SurfaceError`` when loops touch or cross, naming the place.
    """
    xy = field.scaling.to_plane(loops.uv)
    tensors = field.tensors(xy)
    t = _with_room(t, len(xy))
    first_node = int(t.count[0])
    vertex = np.full(len(xy), -1, np.int32)
    edge = np.full(len(loops.segments), -1, np.int32)
    queue = np.empty(QUEUE, np.int32)
    where = np.zeros(2, np.int64)
    status = insert_boundary(t, xy, tensors, loops.segments, vertex, edge, queue, where)
    if status != FINISHED:
        _refuse(status, int(where[0]), loops, surface)
    if find_segments(t, loops.segments, vertex, edge) != FINISHED:
        raise MeshingError(f"the boundary of {surface.name!r} was lost: please report this")
    if grow_inside(t, edge) != FINISHED:
        raise SurfaceError(f"the boundary loops of {surface.name!r} do not enclose a domain")
    clear_boundary(t, loops.segments, vertex, edge, first_node, CROWDED)
    swap_bad(t, np.empty(int(t.count[1])), BAD_SHAPE, SWEEPS)
    return _cut_out(t, vertex)


def _with_room(t: Triangulation, nodes: int) -> Triangulation:
    """The triangulation as one region, with room for more vertices and for fixed edges."""
    need = int(t.count[0]) + nodes + 8
    fresh = empty_triangulation(need)
    grown = [
        old if len(old) >= len(new) else np.concatenate([old, np.zeros_like(new[len(old) :])])
        for old, new in zip(t, fresh)
    ]
    t = Triangulation(*grown)
    t.region[: t.count[1]] = INSIDE
    return t._replace(fixed=np.zeros(len(t.tri), np.uint8))


def _cut_out(t: Triangulation, vertex: np.ndarray) -> DomainMesh:
    triangle_number = np.empty(t.count[1], np.int32)
    vertex_number = np.empty(t.count[0], np.int32)
    _, vertices = number_inside(t, INSIDE, triangle_number, vertex_number)
    room = vertices + vertices // 16 + 64
    out = empty_triangulation(room)
    out = out._replace(fixed=np.zeros(len(out.tri), np.uint8))
    copy_inside(t, triangle_number, vertex_number, out)
    return DomainMesh(out, vertex_number[vertex])


def _refuse(status: int, number: int, loops: BoundaryLoops, surface: Surface) -> None:
    if status == insertion.NODE_TAKEN:
        u, v = loops.uv[number]
        raise SurfaceError(
            f"the boundary of {surface.name!r} touches itself at (u, v) = ({u:.6g}, {v:.6g})"
        )
    a, b = loops.uv[loops.segments[number]]
    line = f"({a[0]:.6g}, {a[1]:.6g}) - ({b[0]:.6g}, {b[1]:.6g})"
    if status in (insertion.CROSSING, insertion.SEGMENT_ON_NODE):
        verb = "crosses itself" if status == insertion.CROSSING else "touches itself"
        raise SurfaceError(f"the boundary of {surface.name!r} {verb} on (u, v) {line}")
    raise MeshingError(f"the boundary segment {line} of {surface.name!r} could not be recovered")
