"""How far the true surface lies from the mesh: the other half of the Hausdorff distance.

    rim of the surface        .--x--.            x: points of the surface that are looked at,
                            o---------o          on free rims and over every triangle; there
    mesh                   / \\   x   / \\         ``deviation`` looks from o, mesh to surface

Points are r(u, v) within the triangles' own (u, v), so on the surface whatever its shape, and
points of the curves of CAD edges. The distance to the own triangle bounds that to the mesh from
above; where it might decide, the nearest triangle is searched for
(``src/quality/surface_search.hpp``). Between the points nothing is bounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.edges import CurvePieces
from surfmesh._core.quality import SurfaceSearch
from surfmesh._core.surfaces import Curve
from surfmesh.accuracy.samples import DENSE
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.quality.measures.deviation import Deviation, looked_at_closely
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point
from surfmesh.quality.measures.tolerances import CHORD_SLACK, Tolerances
from surfmesh.result.surface_mesh import SurfaceMesh

ALONG_RIM = np.arange(1, 8) / 8.0  # along each free edge
# of an arc of an ellipse: what is farthest from its chord at the others of these, over the middle.
# With c(t) = cos(t) U + sin(t) V about the middle they are (cos t - cos a) |U| from it at most
BESIDE_MIDDLE = float(1.0 - np.min(np.abs(1.0 - 2.0 * ALONG_RIM[ALONG_RIM != 0.5])) ** 2)
WITHIN = np.array([(4, 1, 1), (1, 4, 1), (1, 1, 4)]) / 6.0  # barycentric, over every triangle
ON_CURVE = 1e-3  # of a segment: so far off the curve of its edge may its nodes be
_ENDS = attrgetter("t0", "t1")
ALONG, PROJECTIONS = 17, 8  # points of an edge's curve that are put on a face, and steps to it


class SurfaceDeviation(NamedTuple):
    """Distances in model units."""

    by_triangle: NDArray[np.float64]  # (m,) over each triangle, an upper bound of what was seen:
    # exact where it is beyond the chord; 0 where the triangle itself is too far from the surface
    largest: float
    point: Point  # of the surface, where it is largest
    uv: tuple[float, float]
    triangle: int  # that the point is over
    at_rim: bool


def surface_deviation(
    known: KnownSurfaces, fit: Deviation, tolerances: Tolerances
) -> SurfaceDeviation | None:
    """Distance of the surfaces from the mesh; None where ``fit``, the way back, is not finite."""
    if not np.isfinite(fit.largest):
        return None
    faces = FacesWithCurves(known, SegmentCurves.of(known.mesh))
    search = SurfaceSearch(
        *known.prepared_arrays, fit.by_triangle, fit.largest,
        tolerances.chord * (1.0 + CHORD_SLACK), faces.are_left,
    )  # fmt: skip
    search.look_over(known.in_plane, WITHIN)  # in a plane corners say all
    # after these, which tell what is not worth a search along flat faces
    look_along_edges(search, known.mesh, faces.curves)
    search.look_closely(known.in_plane, DENSE, looked_at_closely(len(known.mesh.triangles)))
    largest, (x, y, z), (u, v), triangle, at_rim = search.farthest()
    by_triangle = search.largest_over_each()
    return SurfaceDeviation(by_triangle, largest, (x, y, z), (u, v), triangle, at_rim)


def both_ways(fit: Deviation, back: SurfaceDeviation | None) -> Deviation:
    """``fit`` with the larger of both distances over each triangle."""
    if back is None:
        return fit
    return fit._replace(by_triangle=np.maximum(fit.by_triangle, back.by_triangle))


def look_along_edges(search: SurfaceSearch, mesh: SurfaceMesh, curves: SegmentCurves | None) -> int:
    """At points of the CAD edges between the nodes of their segments, or of all rims.

    Those of CAD edges count for that one of two faces which is farther from the mesh itself: the
    round one. Returns how many segments the middle alone does not settle.
    """
    half_edges = mesh.connectivity.half_edges
    if curves is None:
        search.look_along_rims(half_edges, ALONG_RIM)
        return 0
    return search.look_along_curves(
        curves.core_curves, curves.limits, curves.ids, curves.ends, curves.segments,
        mesh.edge_segment_rows, half_edges, ALONG_RIM, BESIDE_MIDDLE, ON_CURVE,
    )  # fmt: skip


@dataclass(frozen=True)
class SegmentCurves:
    """The segments of CAD edges, and where their ends lie on the curves of these."""

    segments: NDArray[np.int32]  # (k, 2) vertices
    ids: NDArray[np.int32]  # (k,) edges
    ends: NDArray[np.float64]  # (k, 2) t of the edge
    edges: tuple[CadEdge, ...]

    @classmethod
    def of(cls, mesh: SurfaceMesh) -> SegmentCurves | None:
        """None where no curve is known."""
        links = mesh.edge_links
        if links is None or not links.edge_curves or links.edge_parameters is None:
            return None
        return cls(links.edge_segments, links.edge_ids, links.edge_parameters, links.edge_curves)

    @property
    def core_curves(self) -> list[Curve | None]:
        """Of the edges, as the core has them; None for an edge without a curve."""
        return [None if edge.curve is None else edge.curve.core for edge in self.edges]

    @property
    def limits(self) -> NDArray[np.float64]:
        """(e, 2) the ends of the edges, in t of their curves."""
        ends = chain.from_iterable(map(_ENDS, self.edges))
        return np.fromiter(ends, float, 2 * len(self.edges)).reshape(-1, 2)

    def along(self, segment: int, t: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """(j, 3) at ``t`` (j,) of one segment; None where its edge has no curve."""
        edge = self.edges[self.ids[segment]] if self.ids[segment] < len(self.edges) else None
        if edge is None or edge.curve is None:
            return None
        start, end = self.ends[segment]
        pieces = CurvePieces([edge.curve.core], np.array([edge.t0]), np.array([edge.t1]))
        whole = np.array([0, len(t)])
        return pieces.points(np.zeros(1, np.int64), whole, start + t * (end - start))

    @cached_property
    def rows(self) -> dict[frozenset[int], int]:
        """Rows of ``segments`` by their nodes."""
        return {frozenset(pair): k for k, pair in enumerate(self.segments.tolist())}


@dataclass(frozen=True)
class FacesWithCurves:
    """Faces, and the curves of the edges that bound them."""

    known: KnownSurfaces
    curves: SegmentCurves | None

    def are_left(self, uv: tuple[float, float], triangle: int) -> bool:
        """Does uv over a triangle lie beyond an edge of its face? The sides of triangles are
        straight in (u, v), the curves that bound the face are not."""
        mesh, curves = self.known.mesh, self.curves
        if curves is None:
            return False
        place = np.array(uv)
        corners = mesh.triangles[triangle].tolist()
        (places,) = self.known.uv(np.array([triangle]))
        t = np.linspace(0.0, 1.0, ALONG)
        for k in range(3):
            segment = curves.rows.get(frozenset((corners[k], corners[(k + 1) % 3])))
            points = None if segment is None else curves.along(segment, t)
            if segment is None or points is None:
                continue
            ends = places[[k, (k + 1) % 3]]
            if curves.segments[segment][0] != corners[k]:
                ends = ends[::-1]
            guess = ends[0] + t[:, None] * (ends[1] - ends[0])
            surface = mesh.surfaces[mesh.face_ids[triangle]]
            line = closest_point(surface, points, guess, PROJECTIONS)[0]
            line[0], line[-1] = ends
            if _crossings(places[(k + 2) % 3], place, line) % 2:
                return True
        return False


def _crossings(start: NDArray, end: NDArray, line: NDArray) -> int:
    """How often the way from start to end (2,) crosses a line (k, 2)."""
    way, step = end - start, np.diff(line, axis=0)
    side = way[0] * (line[:, 1] - start[1]) - way[1] * (line[:, 0] - start[0])
    ahead, behind = (
        step[:, 0] * (place[1] - line[:-1, 1]) - step[:, 1] * (place[0] - line[:-1, 0])
        for place in (start, end)
    )
    return int(np.count_nonzero((side[1:] * side[:-1] < 0.0) & (ahead * behind < 0.0)))
