"""Insert boundary loops into a packing and cut the domain out (section 3, steps 2 to 5).

All steps run in the core; what its status says about a boundary is put into words here.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh._core import NIL
from surfmesh._core import insertion as core
from surfmesh._core import triangulation as core_triangulation
from surfmesh._core.insertion import BoundaryOutcome, Recovery
from surfmesh.errors import DomainError, MeshingError, SurfaceError, SurfmeshError
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.planar_segments import PlanarSegments
from surfmesh.sizing.field.size_field import SizeField


@dataclass(frozen=True)
class DomainMesh:
    """A triangulated domain of the scaled plane, which is optimised in place."""

    t: core_triangulation.Triangulation
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
    t: core_triangulation.Triangulation, loops: BoundaryLoops, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the loops into the packing ``t`` (which is used up) and keep their inside.

    Raises ``SurfaceError`` when loops touch or cross, naming the place.
    """
    nodes = field.chart.to_plane(loops.uv)
    found = core.recover(
        t, field.background,
        nodes, loops.segments, loops.inner, loops.identity, loops.points,
    )  # fmt: skip
    if found.outcome.status != Recovery.FINISHED:
        _refuse(found.outcome, loops.uv, np.concatenate([loops.segments, loops.inner]), surface)
    domain = found.domain
    return DomainMesh(domain.t, domain.node, domain.same, domain.on_kinks, loops.points)


def recovered_regions(
    t: core_triangulation.Triangulation, cut: PlanarSegments, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the segments of a planar domain into the packing ``t`` and keep what is inside.

    Raises ``DomainError`` when nothing is inside. ``t`` is used up.
    """
    nodes = field.chart.to_plane(cut.uv)
    found = core.recover_regions(
        t, field.background,
        nodes, cut.pieces, cut.segment, cut.graph.loop_segments, cut.graph.loop_is_hole,
    )  # fmt: skip
    if found.outcome.status != Recovery.FINISHED:
        _refuse(found.outcome, cut.uv, cut.pieces, surface)
    domain = found.domain
    return DomainMesh(domain.t, domain.node, domain.same, domain.on_kinks)


def _refuse(
    outcome: BoundaryOutcome, uv: np.ndarray, segments: np.ndarray, surface: Surface
) -> None:
    """Raise what the status means; ``where`` of the error is the place in (u, v)."""
    status, number = outcome.status, outcome.number
    error: SurfmeshError
    if status == Recovery.NODE_TAKEN:
        u, v = uv[number]
        error = SurfaceError(
            f"the boundary of {surface.name!r} touches itself at (u, v) = ({u:.6g}, {v:.6g})"
        )
        error.where = uv[number]
    elif status == Recovery.LEAK:
        error = SurfaceError(f"the boundary loops of {surface.name!r} do not enclose a domain")
        error.where = uv
    elif status == Recovery.LOST:
        error = MeshingError(f"the boundary of {surface.name!r} was lost: please report this")
    elif status == Recovery.DIFFERENT_LOOPS:
        error = DomainError(f"region {number} lies in different loops by different ways")
    elif status == Recovery.UNREACHABLE_REGION:
        error = DomainError(f"region {number} cannot be reached from the infinite one")
    elif status == Recovery.NOTHING_INSIDE:
        error = DomainError(f"no part of {surface.name!r} is inside: the holes cover all of it")
    else:
        error = _segment_error(status, uv[segments[number]], surface)
    raise error


def _segment_error(status: Recovery, ends: np.ndarray, surface: Surface) -> SurfmeshError:
    """Of the segment with these ends (2, 2) in (u, v)."""
    a, b = ends
    line = f"({a[0]:.6g}, {a[1]:.6g}) - ({b[0]:.6g}, {b[1]:.6g})"
    error: SurfmeshError
    if status in (Recovery.CROSSING, Recovery.SEGMENT_ON_NODE):
        verb = "crosses itself" if status == Recovery.CROSSING else "touches itself"
        error = SurfaceError(f"the boundary of {surface.name!r} {verb} on (u, v) {line}")
    else:
        error = MeshingError(
            f"the boundary segment {line} of {surface.name!r} could not be recovered"
        )
    error.where = ends
    return error
