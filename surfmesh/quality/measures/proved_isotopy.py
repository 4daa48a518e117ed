"""Is the mesh its surface but for a deformation of space? By how its points move to the surface.

Where no two points of the mesh move by more than they are apart, space can be moved with them;
where that is not seen at once, by way of meshes that are finer in places. See docs/proof.md.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.proof import bent_stars, prove_isotopy
from surfmesh.accuracy.finer_pieces import FinerFace, cut_around, linear_moves, unmoved
from surfmesh.accuracy.joined_faces import (
    AllMoves,
    FaceMoves,
    RimSides,
    gaps_between,
    joined,
    rim_sides,
    shared_middles,
)
from surfmesh.accuracy.polar_pieces import joined_at_poles
from surfmesh.accuracy.proof import FaceProof, proved_distances
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import face_in_words
from surfmesh.quality.measures.proof import Proof, moved_faces
from surfmesh.quality.measures.proved_topology import Answer
from surfmesh.result.surface_mesh import SurfaceMesh

STEEP = 0.6
"""A slope that leaves room for how triangles are tilted against each other."""

FINER = 3
"""How often triangles are cut whose pieces change too fast."""

FEW, MANY = 100, 0.05
"""Vertices, and of all, at which that is worth a try."""

STEPS = (1, 2, 4)
"""In which vertices are moved onto the surface."""

GAP = 1e-6
"""Of the mesh's extent: how far pieces of two faces may be apart over their side."""

HOLDS, BENT, NEAR = 0, 1, 2


def isotopic(
    same: Answer, meeting: int | None, crosses_itself: bool, known: KnownSurfaces | None,
    found: Proof | None,
) -> Answer:  # fmt: skip
    """Of the mesh and what it was made of. meeting: pairs of its triangles; found: their bounds."""
    if same.answer is not True:
        return Answer(same.answer, "it is not known to be homeomorphic")
    if crosses_itself:
        return Answer(None, "the surface crosses itself")
    if meeting is None:
        return Answer(None, "whether triangles meet is not known")
    if meeting:
        return Answer(False, f"{meeting} pairs of its triangles meet")
    if known is None or found is None:
        return Answer(None, "nothing is proved of its distance from the surface")
    if known.mesh.order == 2:
        return Answer(None, "its triangles are curved")
    if found.without_bounds:
        return Answer(None, _without_bounds(known.mesh, found.without_bounds[0]))
    faces = [_with_poles(face) for face in moved_faces(known, found)]
    for face, number in zip(faces, (number for number, _ in found.moves), strict=True):
        if not face.found.is_joined:
            reason = "pieces of neighbours differ along a side, at a pole or a seam"
            return Answer(None, _of_face(known.mesh, number, reason))
    return _moved(known.mesh, faces)


def _without_bounds(mesh: SurfaceMesh, number: int) -> str:
    if len(mesh.surfaces) == 1:
        return "its surface has no bounds over boxes of (u, v)"
    return _of_face(mesh, number, "its surface has no bounds over boxes of (u, v)")


def _of_face(mesh: SurfaceMesh, number: int, reason: str) -> str:
    where = face_in_words(number, mesh.face_name(number))
    return f"{where}: {reason}" if len(mesh.surfaces) > 1 else reason


def _with_poles(moves: FaceMoves) -> FaceMoves:
    """With neighbours at poles joined, where they can be."""
    if moves.found.is_joined:
        return moves
    return moves._replace(found=joined_at_poles(moves.surface, moves.face, moves.found))


class _Way(NamedTuple):
    """From the mesh to the surface: the last mesh on it so far, and how that moves."""

    points: NDArray[np.float64]
    faces: list[FaceMoves]
    sides: RimSides
    moves: AllMoves


def _moved(mesh: SurfaceMesh, faces: list[FaceMoves]) -> Answer:
    """Can the mesh be moved to its surface?"""
    points = np.ascontiguousarray(mesh.points)
    faces, sides, gap = _with_one_curve(faces, _most(points))
    if gap > _most(points):
        return Answer(None, f"pieces of two faces are {gap:.2g} apart along an edge of both")
    way = _Way(points, faces, sides, joined(faces, sides, len(points)))
    fault = _fault(way)
    if fault[0] == BENT:
        still = np.zeros(len(way.moves.slope))
        folded = bent_stars(points, way.moves.triangles, still)
        if len(folded):
            place = _place(points[folded[0]])
            return Answer(None, f"seen along no direction triangles at {place} form a graph")
        way = _looked_at_closely(way)
        fault = _fault(way)
    for _ in range(FINER):
        finer = _finer(way) if fault[0] == BENT else None
        if finer is None:
            break
        way = finer
        fault = _fault(way)
    if fault[0] == HOLDS:
        reason = "no two points move to the surface by more than they are apart"
        if len(faces) > 1:
            reason += "; that faces have one curve where they meet was tested in places, to "
            reason += f"{GAP:g} of the extent"
        return Answer(True, reason)
    return Answer(None, _in_words(way, *fault))


def _most(points: NDArray[np.float64]) -> float:
    """How far pieces of two faces may be apart."""
    return GAP * float(np.linalg.norm(np.ptp(points, axis=0)))


def _with_one_curve(faces: list[FaceMoves], most: float) -> tuple[list[FaceMoves], RimSides, float]:
    """With pieces over (u, v) where those by nearest points do not end in other faces.

    Their sides, and the largest gap left; where it is too large, nothing is proved of these.
    """
    sides = rim_sides(faces)
    is_far = gaps_between(faces, sides) > most
    if not is_far.any():
        return faces, sides, 0.0
    tried = [
        face._replace(found=face.found._replace(bends=np.empty((0, 3, 2)))) if far else face
        for face, far in zip(faces, is_far, strict=True)
    ]
    gap = float(gaps_between(tried, rim_sides(tried)).max())
    if gap > most:
        return faces, sides, gap
    faces = [_over_uv(face) if far else face for face, far in zip(faces, is_far, strict=True)]
    sides = rim_sides(faces)
    return faces, sides, float(gaps_between(faces, sides).max())


def _bent(way: _Way) -> NDArray[np.bool_]:
    """(n,) vertices at which pieces change too fast."""
    is_bent = np.zeros(len(way.points), bool)
    is_bent[bent_stars(way.points, way.moves.triangles, way.moves.slope)] = True
    return is_bent


def _finer(way: _Way) -> _Way | None:
    """The way by a mesh that is finer where pieces change too fast; None where there is none."""
    is_bent = _bent(way)
    if is_bent.sum() > max(FEW, MANY * len(is_bent)):
        return None
    amid, on_both, shared = shared_middles(way.faces, way.sides, way.points, is_bent)
    flat, moved, cuts, faces = [way.points, amid], [way.points, on_both], [], []
    known = np.concatenate(moved)
    for face, own in zip(way.faces, shared, strict=True):
        cut = cut_around(face, known, is_bent, own, sum(map(len, flat)))
        found = None if cut is None else _moves_of(cut, face.found.bends is None)
        if cut is None or found is None:
            if len(own.numbers):
                return None  # both faces are cut there, or none
            faces.append(face)
            cuts.append(unmoved(face))
            continue
        flat.append(cut.flat)
        moved.append(cut.moved)
        faces.append(found)
        cuts.append(cut)
    triangles = np.concatenate([cut.numbers[cut.face.vertices] for cut in cuts])
    start, end = np.concatenate(flat), np.concatenate(moved)
    is_same = len(end) == len(way.points)
    if is_same or not _is_moved(start, end, np.ascontiguousarray(triangles, np.int32)):
        return None
    sides = rim_sides(faces)
    if gaps_between(faces, sides).max() > _most(end):
        return None
    return _Way(end, faces, sides, joined(faces, sides, len(end)))


def _is_moved(
    start: NDArray[np.float64], end: NDArray[np.float64], triangles: NDArray[np.int32]
) -> bool:
    """Can a mesh be moved from one place of its vertices to another, in one step or some?"""
    for steps in STEPS:
        way = [start + (k / steps) * (end - start) for k in range(steps)] + [end]
        if all(
            prove_isotopy(a, triangles, *linear_moves(a[triangles], (b - a)[triangles]))[0] == HOLDS
            for a, b in pairwise(way)
        ):
            return True
    return False


def _over_uv(moves: FaceMoves) -> FaceMoves:
    """With pieces over the triangles of (u, v), of a face that had other ones."""
    return _proved(moves, by_normals=False) or moves


def _moves_of(cut: FinerFace, by_normals: bool) -> FaceMoves | None:
    """From the finer mesh on; None where that is not known."""
    nothing = np.full(len(cut.face.corners), np.inf)
    unknown = FaceProof(nothing, nothing, nothing, False, None)
    return _proved(FaceMoves(cut.surface, cut.face, cut.numbers, unknown), by_normals)


def _looked_at_closely(way: _Way) -> _Way:
    """With slopes that are bounded as well as they can be, of faces where they are too much."""
    is_bent, faces = _bent(way), []
    for face in way.faces:
        found = None
        if is_bent[face.numbers].any():
            found = _proved(face, face.found.bends is None)
        faces.append(found or face)
    sides = rim_sides(faces)
    return _Way(way.points, faces, sides, joined(faces, sides, len(way.points)))


def _proved(moves: FaceMoves, by_normals: bool) -> FaceMoves | None:
    """Once more; None where neighbours are not joined, or nothing is known."""
    far = np.full(len(moves.face.corners), np.inf)
    found = proved_distances(moves.surface, moves.face, far, STEEP, by_normals)
    if found is None:
        return None
    moves = _with_poles(moves._replace(found=found))
    return moves if moves.found.is_joined else None


def _fault(way: _Way) -> tuple[int, int, int]:
    moves = way.moves
    return prove_isotopy(way.points, moves.triangles, moves.away, moves.slope)


def _in_words(way: _Way, fault: int, first: int, second: int) -> str:
    if fault == BENT:
        place = _place(way.points[first])
        return f"triangles at {place} are large for how the surface bends, or runs, there"
    place = _place(way.points[way.moves.triangles[[first, second]]].mean(axis=(0, 1)))
    return f"two parts at {place} are nearer to each other than they are known from the surface"


def _place(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"
