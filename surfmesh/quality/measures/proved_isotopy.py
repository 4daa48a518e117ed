"""Is the mesh its surface but for a deformation of space? By how its points move to the surface.

Where no two points of the mesh move by more than they are apart, space can be moved with them. See
docs/proof.md; a mesh of several faces is left open, as these meet within tolerances only.
"""

from __future__ import annotations

import numpy as np

from surfmesh._core.proof import prove_isotopy
from surfmesh.accuracy.proof import FaceProof
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.proof import Proof, moves_of, with_poles
from surfmesh.quality.measures.proved_topology import Answer

STEEP = 0.6
"""A slope that leaves room for how triangles are tilted against each other."""

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
    if found.moves is None and known.mesh.order == 2:
        return Answer(None, "its triangles are curved")
    if len(known.mesh.surfaces) > 1:
        return Answer(None, "its faces are joined within tolerances only")
    reason = _not_moved(known, found.moves)
    if reason:
        return Answer(None, reason)
    return Answer(True, "no two points move to the surface by more than they are apart")


def _not_moved(known: KnownSurfaces, moves: FaceProof | None) -> str:
    """Why it is not known that the mesh can be moved to its surface; empty where it is."""
    if moves is None:
        return "its surface has no bounds over boxes of (u, v)"
    moves = with_poles(known, moves)
    if not moves.is_joined:
        return "pieces of neighbours differ along a side that ends in a pole"
    fault, first, second = _fault(known, moves)
    if fault == BENT:
        finer = moves_of(known, STEEP)
        if finer is not None:
            fault, first, second = _fault(known, finer)
    if fault == HOLDS:
        return ""
    if fault == BENT:
        place = _in_words(known.mesh.points[first])
        return f"triangles at {place} are large for how the surface bends, or runs, there"
    triangles = known.mesh.triangles[[first, second]]
    place = _in_words(known.mesh.points[triangles].mean(axis=(0, 1)))
    return f"two parts at {place} are nearer to each other than they are known from the surface"


def _fault(known: KnownSurfaces, moves: FaceProof) -> tuple[int, int, int]:
    mesh = known.mesh
    points = np.ascontiguousarray(mesh.points)
    triangles = np.ascontiguousarray(mesh.triangles, np.int32)
    return prove_isotopy(points, triangles, moves.away, moves.slope)


def _in_words(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"
