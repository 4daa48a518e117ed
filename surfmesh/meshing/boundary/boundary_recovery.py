"""Insert boundary loops into a packing and cut the domain out (section 3, steps 2 to 5).

All steps run in the core; what its status says about a boundary is put into words here.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh._core import NIL
from surfmesh._core import fields as core_fields
from surfmesh._core import insertion as core
from surfmesh._core import triangulation as core_triangulation
from surfmesh._core.insertion import BoundaryOutcome, Recovery
from surfmesh.errors import DomainError, MeshingError, SurfaceError, SurfmeshError
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.fields.background import Background
from surfmesh.kernels.triangulation.triangulation import Triangulation, empty_triangulation
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.planar_segments import PlanarSegments
from surfmesh.sizing.field.size_field import SizeField

ROOM, STRETCHED_ROOM = 1 / 16, 1 / 2
"""Room for more vertices, as a fraction of those there are, for the optimiser's splits."""


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
    t: Triangulation, loops: BoundaryLoops, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the loops into the packing ``t`` (which is used up) and keep their inside.

    Raises ``SurfaceError`` when loops touch or cross, naming the place.
    """
    nodes = field.chart.to_plane(loops.uv)
    found = core.recover(
        triangulation_in_core(t), background_in_core(field.background),
        nodes, loops.segments, loops.inner, loops.identity, loops.points,
    )  # fmt: skip
    if found.outcome.status != Recovery.FINISHED:
        _refuse(found.outcome, loops.uv, np.concatenate([loops.segments, loops.inner]), surface)
    domain = found.domain
    spare = STRETCHED_ROOM if field.is_anisotropic else ROOM
    return DomainMesh(
        _with_room(domain.t, spare), domain.node, domain.same, domain.on_kinks, loops.points
    )


def recovered_regions(
    t: Triangulation, cut: PlanarSegments, field: SizeField, surface: Surface
) -> DomainMesh:
    """Insert the segments of a planar domain into the packing ``t`` and keep what is inside.

    Raises ``DomainError`` when nothing is inside. ``t`` is used up.
    """
    nodes = field.chart.to_plane(cut.uv)
    found = core.recover_regions(
        triangulation_in_core(t), background_in_core(field.background),
        nodes, cut.pieces, cut.segment, cut.graph.loop_segments, cut.graph.loop_is_hole,
    )  # fmt: skip
    if found.outcome.status != Recovery.FINISHED:
        _refuse(found.outcome, cut.uv, cut.pieces, surface)
    domain = found.domain
    return DomainMesh(_with_room(domain.t, ROOM), domain.node, domain.same, domain.on_kinks)


def triangulation_in_core(
    t: Triangulation | core_triangulation.Triangulation,
) -> core_triangulation.Triangulation:
    """The packing as the core has it."""
    if isinstance(t, core_triangulation.Triangulation):
        return t
    n, m = t.vertices, t.triangles
    return core_triangulation.Triangulation(
        t.xy[:n], t.size[:n], t.tri[: 3 * m], t.adj[: 3 * m], t.region[:m], t.fixed[:0]
    )


def background_in_core(given: Background | core_fields.Background) -> core_fields.Background:
    """The background as the core has it."""
    if isinstance(given, core_fields.Background):
        return given
    root_3d = given.metric_root_3d if len(given.metric_root_3d) else None
    return core_fields.Background(
        given.box, given.grid, given.child, given.corner, given.metric_root, root_3d
    )


def _with_room(t: core_triangulation.Triangulation, spare: float) -> Triangulation:
    """A copy for the kernels that are not in the core yet, with ``spare`` of it for more."""
    out = empty_triangulation(t.vertices + int(spare * t.vertices) + 64)
    out = out._replace(fixed=np.zeros(len(out.tri), np.uint8))
    for name in ("xy", "size", "tri", "adj", "region", "fixed"):
        found = getattr(t, name)
        getattr(out, name)[: len(found)] = found
    out.count[:] = t.vertices, t.triangles
    return out


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
