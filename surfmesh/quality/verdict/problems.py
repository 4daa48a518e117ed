"""What is wrong with a mesh, one sentence for each thing: how many, and where the first is."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.quality.measures.against_model import Unexpected
from surfmesh.quality.measures.bodies import BodyPair
from surfmesh.quality.measures.by_solid import SolidRow
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.dihedral import DihedralAngles
from surfmesh.quality.measures.folds import Folds
from surfmesh.quality.measures.narrow import without_area
from surfmesh.quality.measures.self_intersection import MeetingPair
from surfmesh.quality.measures.shape import Shapes
from surfmesh.quality.measures.solids import shares_faces, solid_mesh
from surfmesh.quality.measures.tolerances import Tolerances, Violation
from surfmesh.quality.measures.topology import Topology, topology
from surfmesh.result.surface_mesh import NOT_MESHED, SurfaceMesh


def problems(
    mesh: SurfaceMesh,
    broken: str | None,
    odd: Unexpected,
    topo: Topology,
    shape: Shapes,
    fit: Deviation | None,
    violation: Violation | None,
    tolerances: Tolerances,
    turned: Folds | None,
    solids: tuple[SolidRow, ...],
) -> list[str]:
    """Sentences about all but self-intersection.

    broken: the first broken invariant of the mesh; odd: what is not as in the model; violation:
    triangles that lie farther away than was promised; turned: which are folded.
    """
    said = []
    if not len(mesh.triangles):
        said.append("the mesh has no triangles")
    if broken:
        said.append(broken)
    said += [warning for warning in mesh.warnings if warning.startswith(NOT_MESHED)]
    said += _solids(mesh, odd, solids)
    if shares_faces(mesh) and not odd.known:  # three triangles and more may meet where solids do
        odd = odd._replace(
            crowded_edges=odd.crowded_edges[:0],
            pinched_vertices=odd.pinched_vertices[:0],
            clashing_edges=odd.clashing_edges[:0],
        )
    said += _euler_numbers(mesh, topo, solids)
    said += _edges_and_vertices(mesh, odd)
    said += _triangles(mesh, without_area(mesh, shape.alpha), "without area")
    if fit is not None:
        for bad, what in (
            (turned.inverted, "inverted against the surface"),
            (turned.ours & ~turned.inverted, "folded: turned more than 60° from the surface"),
        ):
            said += [sentence + _why(turned, bad) for sentence in _triangles(mesh, bad, what)]
        if not math.isfinite(fit.largest):
            said.append("the distance from the surface is not finite")
        elif violation is not None:
            worst = violation.worst
            place = fit.point
            if worst != fit.triangle:
                place = mesh.points[mesh.triangles[worst]].mean(axis=0)
            there = f" on {called(mesh, worst)}" * (not tolerances.uniform)
            said.append(
                f"the mesh lies up to {violation.reached:.4g} from the surface, "
                f"{violation.asked:.4g} was asked for{there} ({100 * violation.fraction:.3g} % of "
                f"the triangles are farther); worst in triangle {worst} at {_place(place)}"
            )
    return said


def _why(turned: Folds, bad: NDArray[np.bool_]) -> str:
    """What has turned triangles: edges off the surface, or images that are not theirs."""
    said = ""
    for found, least, what in (
        (turned.off, 0.0, "beside edges that lie up to {:.3g} off the surface"),
        (
            turned.moved, turned.off,
            f"beside nodes that lie on the surface to {turned.nearest:.2g} and their (u, v) up to "
            "{:.3g} from there, moved apart where the boundary crosses itself, or so in the file",
        ),
    ):  # fmt: skip
        here = bad & (found > least)
        if here.any():
            many = "" if (here == bad).all() else f"{np.count_nonzero(here):,} of them "
            said += f"; {many}{what.format(float(found[here].max()))}"
    return said


def _solids(mesh: SurfaceMesh, odd: Unexpected, solids: tuple[SolidRow, ...]) -> list[str]:
    """Solids that are not what the model's are; faces that are missing say so already."""
    if odd.known:
        if _is_incomplete(mesh):
            return []
        closed = [row.closed for row in mesh.facts.solids]
        return [
            f"solid {row.solid}{f' ({row.name})' * bool(row.name)} is not closed"
            for row in solids
            if row.solid < len(closed) and closed[row.solid] and not row.closed
        ]
    said = []
    for row in solids if shares_faces(mesh) else ():
        around = topology(solid_mesh(mesh, row.solid))
        bad = [name for name in ("closed", "manifold", "oriented") if not getattr(around, name)]
        if bad:
            said.append(f"solid {row.solid} is not {' and not '.join(bad)}")
    return said


def _edges_and_vertices(mesh: SurfaceMesh, odd: Unexpected) -> list[str]:
    """Sentences on edges and vertices that are not as in the model, or as on a surface."""
    said = []
    more, fewer = "more than two triangles", "fewer triangles than the model has faces there"
    if odd.known:
        more = "more triangles than the model has faces there"
    missing = _is_incomplete(mesh)
    for found, what in (
        (odd.crowded_edges, f"with {more}" if odd.known else f"shared by {more}"),
        (odd.bare_edges[:0] if missing else odd.bare_edges, f"with {fewer}"),
    ):
        if len(found):
            first = _edge(mesh, mesh.edges[found[0]])
            said.append(f"{_number(found, 'edge')} {what}, first {first}")
    for found, what in (
        (odd.pinched_vertices, "where parts only touch"),
        (odd.joined_vertices[:0] if missing else odd.joined_vertices, "where parts are joined"),
    ):
        if len(found):
            first, many = int(found[0]), _number(found, "vertex", "vertices")
            model = " unlike in the model" if odd.known else ""
            said.append(f"{many} {what}{model}, first {first} at {_place(mesh.points[first])}")
    if len(odd.clashing_edges) and not mesh.one_sided:
        first = mesh.edges[odd.clashing_edges[0]]
        many = _number(odd.clashing_edges, "edge")
        said.append(f"{many} between triangles of opposite orientation, first {_edge(mesh, first)}")
    return said


def overlaps(found: tuple[BodyPair, ...]) -> list[str]:
    """A sentence on solids that share volume."""
    if not found:
        return []
    first = max(found, key=lambda pair: pair.depth or 0.0)
    names = " and ".join(first.names)
    many = f"{len(found):,} pair{'s' * (len(found) > 1)} of solids overlap"
    lie = f" by up to {first.depth:.3g}" if first.depth else ", one within the other"
    return [
        f"{many}: {names}{lie}, at {_place(first.point)}; join them or cut one by the other in "
        "the model"
    ]


def turned_too_far(
    mesh: SurfaceMesh, dihedrals: DihedralAngles, violation: Violation, tolerances: Tolerances
) -> str:
    """A sentence about edges across which triangles turn by more than was promised."""
    edge = dihedrals.edges[violation.worst]
    first, second = (mesh.connectivity.half_edges[edge] // 3).tolist()
    there = f" on {called(mesh, first)}" * (not tolerances.uniform)
    return (
        f"neighbouring triangles turn by up to {violation.reached:.4g}°, {violation.asked:.4g}° "
        f"was asked for{there} ({100 * violation.fraction:.3g} % of the edges turn more); worst "
        f"between triangles {first} and {second} at "
        f"{_place(mesh.points[mesh.edges[edge]].mean(axis=0))}"
    )


def called(mesh: SurfaceMesh, triangle: int) -> str:
    """The face of a triangle by number and name."""
    face = int(mesh.face_ids[triangle])
    name = mesh.face_name(face)
    return name if name == f"face {face}" else f"face {face} ({name})"


def _is_incomplete(mesh: SurfaceMesh) -> bool:
    """Are faces of the model missing?"""
    return any(warning.startswith(NOT_MESHED) for warning in mesh.warnings)


def _euler_numbers(mesh: SurfaceMesh, topo: Topology, solids: tuple[SolidRow, ...]) -> list[str]:
    """Where the mesh has not the topology of the model; faces that are missing say so already."""
    if _is_incomplete(mesh):
        return []
    said = [
        f"the Euler number of solid {row.solid} is {row.euler}, that of the model {row.euler_exact}"
        for row in solids
        if row.euler_exact is not None and row.euler != row.euler_exact
    ]
    exact = mesh.facts.euler if mesh.facts is not None else None
    if not said and exact is not None and exact != topo.euler:
        said.append(f"the Euler number of the mesh is {topo.euler}, that of the model {exact}")
    return said


def intersections(mesh: SurfaceMesh, meeting: tuple[MeetingPair, ...], count: int) -> list[str]:
    """A sentence about ``count`` pairs of triangles that meet, of which the first are given."""
    if not count:
        return []
    first = meeting[0]
    names = dict.fromkeys(mesh.face_name(face) for face in first.faces)
    many = f"{count:,} pair{'s' * (count > 1)}"
    advice = ""
    if any(isinstance(surface, ParametricSurface) for surface in mesh.surfaces):
        advice = "; lower the sizes there, or say embedded = false in the facts of the surface"
    elif mesh.surfaces:
        advice = "; lower the sizes there, or repair the model if its own faces cross"
    return [
        f"the mesh intersects itself: {many} of triangles, first {first.triangles[0]} and "
        f"{first.triangles[1]} ({' and '.join(names)}) at {_place(first.point)}" + advice
    ]


def _triangles(mesh: SurfaceMesh, bad: NDArray[np.bool_], what: str) -> list[str]:
    found = np.flatnonzero(bad)
    if not len(found):
        return []
    first = int(found[0])
    place = _place(mesh.points[mesh.triangles[first]].mean(axis=0))
    return [f"{_number(found, 'triangle')} {what}, first {first} at {place}"]


def _number(found: NDArray, one: str, many: str | None = None) -> str:
    return f"{len(found):,} {one if len(found) == 1 else many or one + 's'}"


def _edge(mesh: SurfaceMesh, edge: NDArray[np.int32]) -> str:
    middle = mesh.points[edge].mean(axis=0)
    return f"{int(edge[0])}-{int(edge[1])} at {_place(middle)}"


def _place(point: Any) -> str:
    return "(" + ", ".join(f"{float(value):.5g}" for value in point) + ")"
