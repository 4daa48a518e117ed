"""One (u, v) domain and one size field become triangles: the spine of surfmesh, once.

packing -> boundary -> optimisation -> space, joined sides identified
                            |                   |
                            +-> size requests <-+   for another round, where this did not do

Whole surfaces, faces of CAD models, planar domains and the patches of an estimate all go this
way. What they differ in is their boundary, and what they do with the requests. All of it is one
call of the core (src/patch/patch_mesh.hpp); what its status says is put into words here.
"""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np

from surfmesh._core import patch as core
from surfmesh._core.insertion import DomainMesh
from surfmesh._core.patch import PatchEnd, PatchStage
from surfmesh.errors import SurfmeshError
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.boundary_recovery import boundary_error
from surfmesh.meshing.boundary.planar_segments import PlanarSegments
from surfmesh.meshing.patch.packing import packing_error, room_for_packing
from surfmesh.meshing.patch.size_requests import SizeRequests
from surfmesh.meshing.progress import Stopwatch
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.rules.size_limits import SizeLimits

STAGES = {
    PatchStage.PACKING: "packing",
    PatchStage.BOUNDARY: "boundary",
    PatchStage.OPTIMISATION: "optimisation",
    PatchStage.MAPPING: "mapping",
}


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
    boundary: BoundaryLoops | PlanarSegments,
    *,
    optimise: bool = True,
    first: bool = True,
    evenly: bool = True,
    box: np.ndarray | None = None,
    watch: Stopwatch | None = None,
) -> PatchMesh:
    """Mesh the inside of a boundary, with sizes of one field in the plane of ``chart``.

    first: the sizes come from no earlier round. evenly: the chord is used so where ``field.sizing``
    asks for it. box: (4,) in the plane, what is packed where it is not the whole domain. watch: is
    told of the stages.

    Raises ``SurfaceError``, ``DomainError`` or ``MeshingError`` with the reason.
    """
    with nullcontext() if watch is None else watch.stages() as begin:
        found = _meshed(surface, chart, field, boundary, optimise, first, evenly, box, watch, begin)
    mapped = found.mapped
    space = SurfaceTriangles(
        mapped.points, mapped.triangles, mapped.uv_triangles, mapped.vertex, mapped.non_manifold
    )
    roots = found.metric_root_3d if field.sizing.is_anisotropic else None
    requests = SizeRequests.of(found.requests, field.sizing.gradient)
    return PatchMesh(
        found.domain, mapped.uv, space, mapped.sizes, roots, requests, field.sizing.gradient
    )


def _meshed(
    surface: Surface, chart: Chart, field: SizeField, boundary: BoundaryLoops | PlanarSegments,
    optimise: bool, first: bool, evenly: bool, box: np.ndarray | None, watch: Stopwatch | None,
    begin: Callable[[str], None] | None,
) -> core.PatchMesh:  # fmt: skip
    """What the core makes of a patch; what failed is raised."""
    sizing, room = field.sizing, room_for_packing(field, chart, box)
    settings = core.PatchSettings(
        as_core_surface(surface), chart.core, field.background,
        sizing.straight_chord, sizing.angle, sizing.min_size or 0.0,
        box=room.box, expected=room.expected, optimise=optimise, first=first,
        with_roots=sizing.is_anisotropic, slope=sizing.gradient, is_width=sizing.is_balanced,
        on_lattice=field.law.is_on_lattice, largest=sizing.largest_stated,
        fewest=evenly and sizing.uses_evenly,
        before_stage=None if begin is None else lambda stage: begin(STAGES[stage]),
        while_packing=None if watch is None else room.told(watch),
        before_pass=None if watch is None else watch.pulse,
    )  # fmt: skip
    uv, nodes = boundary.uv, chart.to_plane(boundary.uv)
    if isinstance(boundary, PlanarSegments):
        segments = boundary.subsegments
        graph = boundary.graph
        found = core.mesh_regions(
            settings, uv, nodes, segments, boundary.segment,
            graph.loop_segments, graph.loop_is_hole,
        )  # fmt: skip
    else:
        segments = np.concatenate([boundary.segments, boundary.inner])
        found = core.mesh_loops(
            settings, uv, nodes, boundary.segments, boundary.inner, boundary.identity,
            boundary.points,
        )  # fmt: skip
    if found.end != PatchEnd.DONE:
        raise patch_error(found, uv, segments, surface)
    return found


def patch_error(
    found: core.PatchMesh, uv: np.ndarray, segments: np.ndarray, surface: Surface
) -> SurfmeshError:
    """What it means that a patch is not done. uv (k, 2), segments (s, 2): of its boundary."""
    if found.end == PatchEnd.PACKING_FAILED:
        return packing_error(found.packing, found.circles, found.place)
    return boundary_error(found.boundary, uv, segments, surface)
