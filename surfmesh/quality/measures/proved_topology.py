"""Is the mesh homeomorphic to its surface or model? Answered by counting and exact predicates.

Each face of the mesh, cut open along its seams as in (u, v), has to consist of discs with holes
whose triangles all run the same way round there, or in the plane that was meshed: then it is the
face it stands for, and faces and seams are joined by number as those of the model are. Where a
narrow face touches itself between two of its edges, all together may still be the closed surface
that its Euler number says. See docs/proof.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.triangulation import first_not_ccw
from surfmesh.geometry.components import components
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface
from surfmesh.quality.measures.against_model import Unexpected
from surfmesh.quality.measures.known_surfaces import KnownSurfaces, Rows
from surfmesh.quality.measures.places import face_in_words
from surfmesh.quality.measures.topology import Topology, topology
from surfmesh.result.connectivity import connect
from surfmesh.result.surface_mesh import SurfaceMesh

TOUCHES = "its triangles only touch in (u, v)"


@dataclass(frozen=True)
class Answer:
    """Yes, no, or not known; with the reason."""

    answer: bool | None
    because: str

    def __str__(self) -> str:
        word = "unknown" if self.answer is None else "yes" if self.answer else "no"
        return f"{word}: {self.because}" if self.because else word


def homeomorphic(known: KnownSurfaces, whole: Topology, unexpected: Unexpected) -> Answer:
    """Of the mesh and what it was made of."""
    mesh = known.mesh
    order = np.argsort(mesh.face_ids, kind="stable")
    starts = np.flatnonzero(np.diff(mesh.face_ids[order], prepend=-1))
    touching = ""
    for rows in np.split(order, starts[1:]):
        reason = _not_a_disc(known, rows)
        if not reason:
            continue
        number = int(mesh.face_ids[rows[0]])
        where = face_in_words(number, mesh.face_name(number))
        in_words = f"{where}: {reason}" if len(mesh.surfaces) > 1 else reason
        if reason != TOUCHES:
            return Answer(None, in_words)
        touching = touching or in_words
    missing = len(mesh.surfaces) - len(np.unique(mesh.face_ids))
    if missing:
        return Answer(False, f"{missing} of {len(mesh.surfaces)} faces have no triangles")
    odd = unexpected.crowded_edges, unexpected.bare_edges, unexpected.pinched_vertices
    if any(map(len, (*odd, unexpected.joined_vertices))):
        return Answer(False, "edges or vertices are not shared as in the model")
    exact = None if mesh.facts is None else mesh.facts.euler
    if exact is not None and exact != whole.euler:
        return Answer(False, f"the Euler number is {whole.euler}, of the model {exact}")
    if touching and not _is_classified(mesh, whole):
        return Answer(None, touching)
    if touching:
        closed = "both are closed, in one piece, and have the same Euler number"
        return Answer(True, f"{closed} ({touching})")
    discs = "every face is a disc with its holes in (u, v)"
    return Answer(True, f"{discs}, and they are joined by number as in the model")


def _is_classified(mesh: SurfaceMesh, whole: Topology) -> bool:
    """Are mesh and model closed oriented surfaces in one piece, of one Euler number?"""
    facts = mesh.facts
    links = mesh.edge_links
    if facts is None or links is None or len(facts.solids) != 1 or facts.euler != whole.euler:
        return False
    uses = np.array(facts.edge_uses)[np.unique(links.edge_ids)]  # others are points
    of_model = facts.solids[0].closed and bool((uses == 2).all())
    of_model = of_model and max(facts.vertex_fans, default=0) <= 1
    is_closed = whole.closed and whole.manifold and whole.balanced
    return of_model and is_closed and whole.components == 1


def _not_a_disc(known: KnownSurfaces, rows: Rows) -> str:
    """Why the triangles of a face are no disc with holes in (u, v); empty where they are."""
    corners = known.corners.uv_triangles[rows]
    used, triangles = np.unique(corners, return_inverse=True)
    uv, triangles = known.corners.uv_points[used], triangles.reshape(-1, 3)
    if not np.isfinite(uv).all():
        return "its parameters are not finite"
    surface = known.mesh.surfaces[int(known.mesh.face_ids[rows[0]])]
    if not _run_one_way(uv, triangles) and not _run_one_way(_in_plane(surface, uv), triangles):
        return "triangles do not all run the same way round in (u, v)"
    flat = topology(_plane_mesh(uv, triangles))
    places = triangles == flat.pinched_vertices[:, None, None]
    if len(flat.pinched_vertices) and _are_of_model(known.mesh, rows, places):
        opened = topology(_plane_mesh(*_without_pinches(uv, triangles)))
        if opened.components == flat.components:
            flat = opened
    if not flat.manifold:
        return TOUCHES
    if flat.euler != 2 * flat.components - flat.boundary_loops:  # each has at most 2 less its loops
        return f"it has {flat.boundary_loops} boundary loops, and the Euler number {flat.euler}"
    loops = len(surface.loops)
    if loops and loops != flat.boundary_loops:
        return f"it has {flat.boundary_loops} boundary loops instead of {loops}"
    return ""


def _are_of_model(mesh: SurfaceMesh, rows: Rows, places: NDArray[np.bool_]) -> bool:
    """Are corners of a face (p, m, 3) at vertices of the model, where its loops may touch?"""
    if mesh.vertex_ids is None:
        return False
    corners = mesh.triangles[rows][places.any(axis=0)]
    return bool(np.isin(corners, mesh.vertex_ids[mesh.vertex_ids >= 0]).all())


def _without_pinches(
    uv: NDArray[np.float64], triangles: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """With a place for each fan of triangles: what its boundary touches is joined by number."""
    table = connect(np.ascontiguousarray(triangles, np.int32))
    h, g = table.half_edges[table.uses == 2].T
    after = [3 * (x // 3) + (x % 3 + 1) % 3 for x in (h, g)]
    pairs = np.concatenate([np.stack([h, after[1]], axis=1), np.stack([after[0], g], axis=1)])
    fans, corners = np.unique(components(triangles.size, pairs), return_inverse=True)
    return uv[triangles.ravel()[fans]], corners.reshape(-1, 3)


def _run_one_way(uv: NDArray[np.float64], triangles: NDArray[np.int64]) -> bool:
    """Exactly; the faces of a solid may run either way."""
    xy = np.ascontiguousarray(uv)
    ccw = np.ascontiguousarray(triangles, np.int64)
    if first_not_ccw(xy, ccw) < 0:
        return True
    return first_not_ccw(xy, np.ascontiguousarray(ccw[:, ::-1])) < 0


def _in_plane(surface: Surface, uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where sides are straight: in the plane that was meshed, (u, v) with its axes bent."""
    return Chart.of(surface).to_plane(uv)


def _plane_mesh(uv: NDArray[np.float64], triangles: NDArray[np.int64]) -> SurfaceMesh:
    flat = np.concatenate([uv, np.zeros((len(uv), 1))], axis=1)
    return SurfaceMesh(points=flat, triangles=triangles.astype(np.int32))
