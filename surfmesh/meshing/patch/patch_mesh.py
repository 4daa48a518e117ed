"""One (u, v) domain and one size field become triangles: the spine of surfmesh, once.

packing -> boundary -> optimisation -> space, joined sides identified
                            |                   |
                            +-> size requests <-+   for another round, where this did not do

Whole surfaces, faces of CAD models, planar domains and the patches of an estimate all go this
way. What they differ in is their boundary, and what they do with the requests.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh, recovered, recovered_regions
from surfmesh.meshing.boundary.planar_segments import PlanarSegments
from surfmesh.meshing.patch.packing import packed_over
from surfmesh.meshing.patch.size_requests import SizeRequests
from surfmesh.meshing.patch.state import patch_state
from surfmesh.meshing.progress import Stopwatch
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.rules.size_limits import SizeLimits

OFF_SURFACE = 0.3
"""Fraction of ``chord`` by which a node may lie off the surface of a face that uses it."""


@dataclass(frozen=True)
class SurfaceTriangles:
    """Points in space and triangles on them, with their corners in the parameter plane."""

    points: np.ndarray
    """(n, 3)"""
    triangles: np.ndarray
    """(m, 3) int32, rows of ``points``."""
    uv_triangles: np.ndarray
    """(m, 3) int32, vertices of the domain."""
    vertex: np.ndarray
    """(n,) int64: vertex of the domain that each point was computed from."""
    non_manifold: np.ndarray
    """(k,) int64: points where identification has not made a surface, sizes are too coarse."""


@dataclass(frozen=True)
class PatchMesh:
    """The triangles of one patch."""

    domain: DomainMesh
    """Where they lie in the scaled plane."""
    uv: np.ndarray
    """(k, 2) parameters of the vertices of the domain."""
    space: SurfaceTriangles
    sizes: np.ndarray
    """(n,) of the points: what the field asks for, with what the optimiser has made smaller."""
    metric_root_3d: np.ndarray | None
    """(k, 6) of the vertices, where sizes depend on the direction: see ``SurfaceMesh``."""
    requests: SizeRequests
    """What the optimiser could not mend."""
    gradient: float

    def limits_for_seams(self, factor: float, essential: bool = False) -> SizeLimits | None:
        """Limits under which sides may be joined: ``factor`` of the sizes where they are not."""
        bad = self.space.non_manifold
        if not len(bad):
            return None
        return SizeLimits(
            self.space.points[bad], factor * self.sizes[bad], self.gradient, essential=essential
        )


def mesh_patch(
    surface: Surface,
    chart: Chart,
    field: SizeField,
    cut_boundary: Callable[[], BoundaryLoops | PlanarSegments],
    *,
    optimise: bool = True,
    first: bool = True,
    box: np.ndarray | None = None,
    watch: Stopwatch | None = None,
) -> PatchMesh:
    """Mesh the inside of a boundary, with sizes of one field in the plane of ``chart``.

    cut_boundary: gives its nodes and segments. first: the sizes come from no earlier round.
    box: (4,) in the plane, what is packed where it is not the whole domain. watch: is told of
    the stages. Raises ``SurfaceError``, ``DomainError`` or ``MeshingError`` with the reason.
    """

    def stage(name: str) -> AbstractContextManager[None]:
        return watch.stage(name) if watch is not None else nullcontext()

    with stage("packing"):
        packing = packed_over(field, chart, box, watch)
    with stage("boundary"):
        boundary = cut_boundary()
        if isinstance(boundary, PlanarSegments):
            domain = recovered_regions(packing.t, boundary, field, surface)
        else:
            domain = recovered(packing.t, boundary, field, surface)
        del packing
        if not optimise:
            state = patch_state(domain, surface, chart, field)
            state.choose_diagonals()
            requests = SizeRequests()
    if optimise:
        with stage("optimisation"):
            state = patch_state(
                domain, surface, chart, field, None if watch is None else watch.pulse
            )
            left = state.optimise(first)
            off = _off_surface(domain, surface, field, boundary.uv)
            requests = SizeRequests.of(state.size_requests(left, off), field.sizing.gradient)
    with stage("mapping"):
        found = state.mapped(boundary.uv[domain.is_used], *_identified(domain, boundary))
        roots = field.roots_of_mesh(domain.t.xy, state.frames.scale)
    space = SurfaceTriangles(
        found.points, found.triangles, found.uv_triangles, found.vertex, found.non_manifold
    )
    return PatchMesh(domain, found.uv, space, found.sizes, roots, requests, field.sizing.gradient)


def _identified(
    domain: DomainMesh, boundary: BoundaryLoops | PlanarSegments
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices of nodes, segments, identity: of what may be identified."""
    if isinstance(boundary, BoundaryLoops):
        return domain.node, boundary.segments, boundary.identity
    return np.empty(0, np.int32), np.empty((0, 2), np.int32), np.empty(0, np.int64)


def _off_surface(
    domain: DomainMesh, surface: Surface, field: SizeField, uv: np.ndarray
) -> np.ndarray | None:
    """Marks of the nodes in use that lie so far off the surface that smaller sizes are no help."""
    chord = field.sizing.chord
    if chord is None or domain.points is None:
        return None
    used = domain.is_used
    (images,) = surface.evaluate(uv[used], 0)
    deviation = np.linalg.norm(domain.points[used] - images, axis=1)
    return (deviation > OFF_SURFACE * chord).view(np.uint8)
